#include "gravure/twin/exposure.hpp"

#include <algorithm>
#include <cstring>

#include "gravure/core/as_size.hpp"
#include "gravure/raster/place.hpp"

namespace gravure {
namespace {}  // namespace

Result<void> ProgramChunk::load(LineSource& program, ChunkAddress address) {
  if (address.layer == address_.layer && address.chunk == address_.chunk) {
    return {};
  }
  const ProgramHeader& header = program.header();
  address_ = {-1, -1};
  turned_valid_ = false;
  first_line_ = address.chunk * program.lines_per_chunk();
  lines_ = std::min(program.lines_per_chunk(), header.plan.rotary.lines_per_revolution - first_line_);
  stored_.resize(as_size(lines_ * header.line_bytes()));
  GRAVURE_TRY(const StoredChunk chunk, program.fetch(address));
  GRAVURE_CHECK(program.decode(chunk, stored_));
  address_ = address;
  return {};
}

std::span<const std::byte> ProgramChunk::lines_for(const ProgramHeader& header, std::int64_t revolution) {
  const Plan& plan = header.plan;
  const bool starts_reverse = line_is_reverse(plan, revolution, 0);
  const bool turn = starts_reverse != header.layers[as_size(address_.layer)].starts_reverse;
  if (turn && !turned_valid_) {
    turned_.resize(stored_.size());
    raster::place_rows(turned_, stored_, plan.line.pixels, lines_, {.first_mirrored = true});
    turned_valid_ = true;
  }
  return turn ? turned_ : stored_;
}

Result<void> ProgramChunk::send(const ProgramHeader& header, std::int64_t revolution, LineDevice& device) {
  const Plan& plan = header.plan;
  const std::span<const std::byte> lines = lines_for(header, revolution);
  const std::int64_t bytes = header.line_bytes();
  for (std::int64_t i = 0; i < lines_; ++i) {
    LineFrame frame;
    frame.revolution = revolution;
    frame.line = first_line_ + i;
    frame.first_slot =
        line_is_reverse(plan, revolution, frame.line) ? plan.line.reverse_first_slot : plan.line.forward_first_slot;
    frame.bits = lines.subspan(as_size(i * bytes), as_size(bytes));
    frame.crc32c = frame_crc32c(frame);
    GRAVURE_CHECK(device.send(frame));
  }
  return {};
}

void Landing::start(std::int64_t lines) {
  taken_ = 0;
  fired_.resize(as_size(lines * raster::packed_bytes(plan_.line.pixels)));
}

bool Landing::take(const ExecutedLine& line) {
  const bool reverse = plan_.line.bidirectional && (line.ordinal & 1) != 0;
  const std::size_t bytes = as_size(raster::packed_bytes(plan_.line.pixels));
  const std::size_t at = as_size(taken_) * bytes;
  if (line.fired.size() != bytes || at + bytes > fired_.size() ||
      line.first_slot != (reverse ? plan_.line.reverse_first_slot : plan_.line.forward_first_slot)) {
    return false;
  }
  std::memcpy(fired_.data() + at, line.fired.data(), bytes);
  ++taken_;
  return true;
}

std::span<const std::byte> Landing::turn_back(std::int64_t first_line, bool starts_reverse, bool invert) {
  const std::size_t bytes = as_size(taken_ * raster::packed_bytes(plan_.line.pixels));
  landed_.resize(std::max(landed_.size(), bytes));
  const std::span<std::byte> landed = std::span(landed_).first(bytes);
  raster::place_rows(landed, std::span<const std::byte>(fired_).first(bytes), plan_.line.pixels, taken_,
                     {.invert = invert,
                      .first_mirrored = plan_.line.bidirectional && (starts_reverse != ((first_line & 1) != 0)),
                      .alternate = plan_.line.bidirectional});
  return landed;
}

}  // namespace gravure
