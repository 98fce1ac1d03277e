#include "gravure/twin/exposure_count.hpp"

#include <algorithm>
#include <limits>
#include <string>

#include "gravure/raster/place.hpp"

namespace gravure {
namespace {

constexpr unsigned kMostTimes = std::numeric_limits<std::uint8_t>::max();

std::size_t size_of(std::int64_t bytes) {
  return static_cast<std::size_t>(bytes);
}

Error bad_index(const char* option, std::int64_t value, std::int64_t count) {
  return {ErrorCode::out_of_range,
          std::string(option) + " " + std::to_string(value) + ": the program has 0 to " + std::to_string(count - 1)};
}

Error other_program(std::int64_t revolution, std::int64_t line, const std::string& what) {
  return {ErrorCode::bad_file, "the board fired line " + std::to_string(line) + " of revolution " +
                                   std::to_string(revolution) + " " + what +
                                   ": this is not the program that it ran; give that one"};
}

}  // namespace

Result<ExposureCount> ExposureCount::make(const ProgramHeader& header, std::optional<std::int64_t> revolution,
                                          std::optional<std::int64_t> layer) {
  const Plan& plan = header.plan;
  if (revolution && plan.carriage) {
    return Error{ErrorCode::bad_argument, "--revolution " + std::to_string(*revolution) +
                                              ": a revolution of a helical program shows a part of each layer; give "
                                              "--layer, 0 to " +
                                              std::to_string(plan.carriage->layers - 1)};
  }
  if (layer && !plan.carriage) {
    return Error{ErrorCode::bad_argument, "--layer " + std::to_string(*layer) +
                                              ": every revolution of this program shows a picture; give --revolution, "
                                              "0 to " +
                                              std::to_string(plan.job.revolutions - 1)};
  }
  if (revolution && (*revolution < 0 || *revolution >= plan.job.revolutions)) {
    return bad_index("--revolution", *revolution, plan.job.revolutions);
  }
  if (layer && (*layer < 0 || *layer >= plan.carriage->layers)) {
    return bad_index("--layer", *layer, plan.carriage->layers);
  }
  return ExposureCount(header, revolution, layer);
}

void ExposureCount::start(std::int64_t first_row, std::int64_t end_row) {
  first_row_ = first_row;
  end_row_ = end_row;
  counts_.assign(size_of((end_row - first_row) * size().width), std::byte{0});
  landed_.resize(size_of(header_->line_bytes()));
}

Result<void> ExposureCount::check(std::int64_t revolution, std::int64_t line, std::int64_t first_slot,
                                  std::size_t bytes) const {
  const Plan& plan = header_->plan;
  if (revolution >= plan.job.revolutions || line >= plan.rotary.lines_per_revolution) {
    return other_program(revolution, line,
                         "but the program has " + std::to_string(plan.job.revolutions) + " revolutions of " +
                             std::to_string(plan.rotary.lines_per_revolution) + " lines");
  }
  if (bytes != landed_.size()) {
    return other_program(
        revolution, line,
        "with " + std::to_string(bytes) + " bytes of bits, the program has " + std::to_string(landed_.size()));
  }
  const bool reverse = line_is_reverse(plan, revolution, line);
  const std::int64_t window = reverse ? plan.line.reverse_first_slot : plan.line.forward_first_slot;
  const bool earlier = first_slot + 1 == window;  // and later by part of a slot, which frames cannot say
  if (first_slot != window && !(reverse && earlier)) {
    return other_program(
        revolution, line,
        "from slot " + std::to_string(first_slot) + " on, the program from slot " + std::to_string(window));
  }
  return {};
}

Result<void> ExposureCount::add(std::int64_t revolution, std::int64_t line, std::int64_t first_slot,
                                std::span<const std::byte> bits) {
  GRAVURE_CHECK(check(revolution, line, first_slot, bits.size()));
  const Plan& plan = header_->plan;
  const std::int64_t each = revolutions_per_band(plan);
  if (revolution_ && revolution % each != *revolution_ % each) {
    return {};
  }
  raster::place_rows(landed_, bits, plan.line.pixels, 1, {.first_mirrored = line_is_reverse(plan, revolution, line)});
  const std::int64_t image_line = map_.image_line(revolution, line);
  for (std::int64_t index = 0; index < map_.stretches(); ++index) {
    if (!layer_ || index == map_.stretches() - 1 - *layer_) {
      GRAVURE_CHECK(count(map_.stretch(revolution, line, index), image_line));
    }
  }
  return {};
}

Result<void> ExposureCount::count(const Stretch& stretch, std::int64_t image_line) {
  const bool rows = header_->lines_along == LinesAlong::rows;
  const std::int64_t width = size().width;
  for (std::int64_t i = 0; i < stretch.columns; ++i) {
    const std::int64_t pixel = stretch.first_pixel + i;
    const std::byte byte = landed_[size_of(pixel / 8)];
    if (byte == std::byte{0}) {
      i += 7 - pixel % 8;  // to the next byte
      continue;
    }
    const std::int64_t column = stretch.first_column + i;
    const std::int64_t row = rows ? image_line : column;
    if ((byte & static_cast<std::byte>(0x80U >> static_cast<unsigned>(pixel % 8))) == std::byte{0} ||
        row < first_row_ || row >= end_row_) {
      continue;
    }
    std::byte& times = counts_[size_of((row - first_row_) * width + (rows ? column : image_line))];
    if (std::to_integer<unsigned>(times) == kMostTimes) {
      return Error{ErrorCode::out_of_range, "row " + std::to_string(row) + ", column " +
                                                std::to_string(rows ? column : image_line) + " was fired more than " +
                                                std::to_string(kMostTimes) + " times: give --revolution or --layer"};
    }
    times = static_cast<std::byte>(std::to_integer<unsigned>(times) + 1);
  }
  return {};
}

}  // namespace gravure
