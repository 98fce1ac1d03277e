#include "gravure/pipeline/window_reader.hpp"

#include <algorithm>
#include <cstring>

#include "gravure/core/as_size.hpp"
#include "gravure/raster/place.hpp"

namespace gravure {
namespace {

constexpr std::int64_t kLineBytes = std::int64_t{1} << 20;  // lines of an image at a time

std::int64_t image_row_bytes(const LayerStack& stack) {
  return row_bytes(SampleType::bit, stack.pixels);
}

/// Lines of an image read at a time. All at once where one map serves all layers of a chunk, so that it is decoded
/// once.
std::int64_t block_lines(const Plan& plan, const LayerStack& stack, std::int64_t lines) {
  if (stack.levels > 0 && !plan.carriage) {
    return lines;
  }
  return std::clamp<std::int64_t>(kLineBytes / std::max<std::int64_t>(1, image_row_bytes(stack)), 1,
                                  std::max<std::int64_t>(1, lines));
}

/// At most so many bytes of one image's line are needed by `revolutions` helical revolutions, for any lines.
std::int64_t strip_bytes(const Plan& plan, std::int64_t revolutions) {
  const Integer columns = ceil_of(plan.carriage->feed_pixels * Rational(revolutions + 1)) + 1;
  const auto shown = static_cast<std::int64_t>(std::min<Integer>(columns, plan.carriage->columns));
  return shown / 8 + 2;  // it starts and ends anywhere in a byte
}

std::int64_t helical_panel_bytes(const Plan& plan, std::int64_t lines, std::int64_t revolutions) {
  return lines * plan.carriage->layers * strip_bytes(plan, revolutions);
}

/// The share of a panel that collects columns of images whose lines run along them.
std::int64_t inner_panel_bytes(const Plan& plan, const LayerStack& stack, std::int64_t panel_bytes) {
  if (stack.lines_along == LinesAlong::rows) {
    return 0;
  }
  return plan.carriage ? panel_bytes / 2 : panel_bytes;
}

/// As many revolutions as a panel holds.
std::int64_t fitting_revolutions(const Plan& plan, std::int64_t lines, std::int64_t panel_bytes) {
  std::int64_t good = 1;
  for (std::int64_t most = plan.job.revolutions; good < most;) {
    const std::int64_t middle = good + (most - good + 1) / 2;
    if (helical_panel_bytes(plan, lines, middle) <= panel_bytes) {
      good = middle;
    } else {
      most = middle - 1;
    }
  }
  return good;
}

}  // namespace

ReaderNeeds reader_needs(const Plan& plan, const LayerStack& stack, std::int64_t lines) {
  if (ExposureMap(plan).whole_images()) {
    return {image_row_bytes(stack), LayerReader::fixed_bytes(stack, lines), LayerReader::least_panel_bytes(stack)};
  }
  const std::int64_t block = block_lines(plan, stack, lines);
  ReaderNeeds needs{row_bytes(SampleType::bit, plan.line.pixels),
                    LayerReader::fixed_bytes(stack, block) + block * image_row_bytes(stack),
                    LayerReader::least_panel_bytes(stack)};
  if (plan.carriage) {
    const bool shared = stack.lines_along == LinesAlong::columns;
    needs.least_panel_bytes = std::max(needs.least_panel_bytes, helical_panel_bytes(plan, lines, 1)) * (shared ? 2 : 1);
  }
  return needs;
}

std::unique_ptr<LayerLines> make_layer_lines(const ProgramHeader& header, const LayerStack& stack,
                                             const ImageOpener& opener, std::int64_t panel_bytes) {
  if (ExposureMap(header.plan).whole_images()) {
    return std::make_unique<LayerReader>(stack, opener, panel_bytes);
  }
  return std::make_unique<WindowReader>(header, stack, opener, panel_bytes);
}

WindowReader::WindowReader(const ProgramHeader& header, const LayerStack& stack, const ImageOpener& opener,
                           std::int64_t panel_bytes)
    : header_(header),
      stack_(stack),
      opener_(opener),
      map_(header.plan),
      revolution_of_(header.layers.size(), 0),
      panel_bytes_(panel_bytes - inner_panel_bytes(header.plan, stack, panel_bytes)),
      inner_(stack, opener, inner_panel_bytes(header.plan, stack, panel_bytes)) {
  if (header.plan.carriage && stack.layers.size() > 1) {
    inner_.decode_always();  // the images take turns in every panel
  }
  for (std::size_t r = header.layer_of_revolution.size(); r-- > 0;) {
    revolution_of_[header.layer_of_revolution[r]] = header.first_revolution() + static_cast<std::int64_t>(r);
  }
}

std::int64_t WindowReader::least_memory_bytes(std::int64_t lines) {
  std::int64_t decoder = 0;
  if (!stack_.decoder_bytes) {
    LayerStack known = stack_;
    learn_images(known, opener_);
    decoder = known.decoder_bytes.value_or(0);
  }
  const ReaderNeeds needs = reader_needs(header_.plan, stack_, lines);
  return decoder + needs.fixed_bytes + needs.least_panel_bytes;
}

void WindowReader::grant_memory(std::int64_t lines, std::int64_t bytes) {
  const ReaderNeeds needs = reader_needs(header_.plan, stack_, lines);
  const std::int64_t panel = bytes - (least_memory_bytes(lines) - needs.least_panel_bytes);
  const std::int64_t inner = inner_panel_bytes(header_.plan, stack_, panel);
  const std::int64_t block = block_lines(header_.plan, stack_, lines);
  inner_.grant_memory(block, inner + inner_.least_memory_bytes(block) - LayerReader::least_panel_bytes(stack_));
  panel_bytes_ = panel - inner;
}

Result<bool> WindowReader::read_lines(std::int64_t layer, std::int64_t first_line, std::int64_t count,
                                      std::span<std::byte> out) {
  const std::span<std::byte> lines = out.first(as_size(count * header_.line_bytes()));
  std::memset(lines.data(), 0, lines.size());
  if (!header_.plan.carriage) {
    GRAVURE_CHECK(cut_lines(layer, first_line, count, lines));
    return false;
  }
  const std::int64_t revolution = revolution_of_.at(as_size(layer));
  const bool held = first_line == held_line_ && count == held_lines_ && revolution >= held_revolution_ &&
                    revolution < held_revolution_ + held_revolutions_;
  if (!held) {
    panel_read_ = load_panel(revolution, first_line, count);
  }
  GRAVURE_CHECK(panel_read_);  // a damaged image is not read again for every revolution of its panel
  expose(revolution, first_line, count, lines);
  return false;
}

/// Bands and passes: a line shows one stretch of one line of its image.
Result<void> WindowReader::cut_lines(std::int64_t layer, std::int64_t first_line, std::int64_t count,
                                     std::span<std::byte> out) {
  const std::int64_t revolution = revolution_of_.at(as_size(layer));
  const bool backwards = map_.runs_backwards(revolution);
  const std::int64_t first_row = backwards ? map_.image_line(revolution, first_line + count - 1) : first_line;
  const Stretch stretch = map_.stretch(revolution, first_line, 0);  // the same for all lines of a revolution
  const std::int64_t row = image_row_bytes(stack_);
  const std::int64_t block = block_lines(header_.plan, stack_, count);
  rows_.resize(as_size(block * row));
  for (std::int64_t done = 0; done < count; done += block) {
    const std::int64_t now = std::min(block, count - done);
    GRAVURE_TRY(const bool invert, inner_.read_lines(layer, first_row + done, now, rows_));
    for (std::int64_t i = 0; i < now; ++i) {
      const std::int64_t line = backwards ? count - 1 - (done + i) : done + i;
      raster::place_line(out.subspan(as_size(line * header_.line_bytes()), as_size(header_.line_bytes())),
                         stretch.first_pixel, std::span<const std::byte>(rows_).subspan(as_size(i * row), as_size(row)),
                         stretch.first_column, stretch.columns, {.invert = invert});
    }
  }
  return {};
}

/// Which bytes of each image's lines the revolutions of the panel show, and where they are kept.
void WindowReader::place_strips(std::int64_t revolution, std::int64_t first_line, std::int64_t count) {
  const std::int64_t lines = map_.lines();
  const std::int64_t layers = map_.stretches();
  strips_.assign(as_size(layers), {});
  std::int64_t offset = 0;
  for (std::int64_t layer = 0; layer < layers; ++layer) {
    const std::int64_t segment = (revolution - 1 - layer) * lines;  // steps of its first line 0: see ExposureMap
    const std::int64_t first = map_.column_after(segment + first_line);
    const std::int64_t end = map_.column_after(segment + held_revolutions_ * lines + first_line + count - 1);
    Strip& strip = strips_[as_size(layer)];
    strip.first_byte = std::clamp<std::int64_t>(first, 0, map_.columns()) / 8;
    strip.bytes = (std::clamp<std::int64_t>(end, 0, map_.columns()) + 7) / 8 - strip.first_byte;
    strip.offset = offset;
    offset += count * strip.bytes;
  }
  if (held_.capacity() < as_size(offset)) {
    held_ = {};  // not the old panel beside the new one
  }
  held_.resize(as_size(offset));
}

/// Lines [first, first + count) of one image, counted in the panel, into its strip.
Result<void> WindowReader::fill_strip(std::size_t image, std::int64_t first, std::int64_t count) {
  const Strip& strip = strips_[image];
  if (strip.bytes == 0) {
    return {};
  }
  const std::int64_t row = image_row_bytes(stack_);
  GRAVURE_TRY(const bool invert, inner_.read_lines(static_cast<std::int64_t>(image), held_line_ + first, count, rows_));
  for (std::int64_t i = 0; i < count; ++i) {
    raster::place_line(
        std::span(held_).subspan(as_size(strip.offset + (first + i) * strip.bytes), as_size(strip.bytes)), 0,
        std::span<const std::byte>(rows_).subspan(as_size(i * row), as_size(row)), 8 * strip.first_byte,
        8 * strip.bytes, {.invert = invert});
  }
  return {};
}

Result<void> WindowReader::load_panel(std::int64_t revolution, std::int64_t first_line, std::int64_t count) {
  held_line_ = first_line;
  held_lines_ = count;
  held_revolution_ = revolution;
  const std::int64_t end =
      header_.first_revolution() + static_cast<std::int64_t>(header_.layer_of_revolution.size());  // of a shard, too
  held_revolutions_ = std::min(fitting_revolutions(header_.plan, count, panel_bytes_), end - revolution);
  place_strips(revolution, first_line, count);
  const std::int64_t block = block_lines(header_.plan, stack_, count);
  rows_.resize(as_size(block * image_row_bytes(stack_)));
  const auto blocks = (count + block - 1) / block;
  const auto images = static_cast<std::int64_t>(strips_.size());
  // A map is decoded once for all its levels; of several files each is read to its end before the next is opened.
  const bool one_map = stack_.levels > 0;
  for (std::int64_t i = 0; i < images * blocks; ++i) {
    const std::int64_t at = (one_map ? i / images : i % blocks) * block;
    const std::int64_t image = one_map ? i % images : i / blocks;
    GRAVURE_CHECK(fill_strip(as_size(image), at, std::min(block, count - at)));
  }
  return {};
}

void WindowReader::expose(std::int64_t revolution, std::int64_t first_line, std::int64_t count,
                          std::span<std::byte> out) const {
  const std::span<const std::byte> held(held_);
  for (std::int64_t i = 0; i < count; ++i) {
    const std::span<std::byte> line = out.subspan(as_size(i * header_.line_bytes()), as_size(header_.line_bytes()));
    for (std::int64_t s = 0; s < map_.stretches(); ++s) {
      const Stretch stretch = map_.stretch(revolution, first_line + i, s);
      if (stretch.columns == 0) {
        continue;
      }
      const Strip& strip = strips_[as_size(stretch.layer)];
      raster::place_line(line, stretch.first_pixel,
                         held.subspan(as_size(strip.offset + i * strip.bytes), as_size(strip.bytes)),
                         stretch.first_column - strip.first_byte * 8, stretch.columns);
    }
  }
}

}  // namespace gravure
