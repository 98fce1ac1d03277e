#include "gravure/pipeline/layer_reader.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <set>
#include <string_view>
#include <utility>

#include "column_spill.hpp"
#include "gravure/core/as_size.hpp"
#include "gravure/raster/threshold.hpp"
#include "gravure/raster/transpose.hpp"

namespace gravure {
namespace {

// A band of rows while a panel is collected: what is decoded between two questions whether to go on. The slowest codec,
// fax of a dithered picture, takes 60 ms for the bits.
constexpr std::int64_t kBitBandBytes = std::int64_t{1} << 20;
constexpr std::int64_t kGreyBandBytes = std::int64_t{4} << 20;

std::int64_t bytes_per_sample(SampleType samples) {
  return row_bytes(samples, 1);
}

/// Bytes a line of the stack takes while it is held.
std::int64_t held_line_bytes(const LayerStack& stack) {
  return row_bytes(stack.samples, stack.pixels);
}

/// Rows of the image decoded at a time while a panel is collected.
std::int64_t band_rows_of(const LayerStack& stack) {
  const std::int64_t bytes = stack.samples == SampleType::bit ? kBitBandBytes : kGreyBandBytes;
  return std::clamp<std::int64_t>(bytes / std::max<std::int64_t>(1, row_bytes(stack.samples, stack.lines)), 1,
                                  std::max<std::int64_t>(1, stack.pixels));
}

std::int64_t band_bytes(const LayerStack& stack) {
  return band_rows_of(stack) * row_bytes(stack.samples, stack.lines);
}

std::uint32_t integer_maximum(SampleType samples) {
  return samples == SampleType::u8 ? 255U : 65535U;
}

/// Samples of `size` bytes: rows x cols -> cols x rows, in blocks that fit the first-level cache.
void transpose_samples(std::byte* dst, std::int64_t dst_stride, const std::byte* src, std::int64_t src_stride,
                       std::int64_t rows, std::int64_t cols, std::int64_t sample) {
  constexpr std::int64_t kBlock = 32;
  for (std::int64_t r0 = 0; r0 < rows; r0 += kBlock) {
    for (std::int64_t c0 = 0; c0 < cols; c0 += kBlock) {
      for (std::int64_t c = c0; c < std::min(cols, c0 + kBlock); ++c) {
        for (std::int64_t r = r0; r < std::min(rows, r0 + kBlock); ++r) {
          std::memcpy(dst + c * dst_stride + r * sample, src + r * src_stride + c * sample, as_size(sample));
        }
      }
    }
  }
}

/// The float that cuts where the exact limit does: the first one not below it (at_least) or not above it (at_most).
float float_limit(const Rational& exact, raster::Where where) {
  const double nearest = to_double(exact);
  constexpr double kMost = std::numeric_limits<float>::max();
  const bool up = where == raster::Where::at_least;
  if (std::fabs(nearest) > kMost) {
    const float most = std::copysign(std::numeric_limits<float>::max(), static_cast<float>(nearest > 0 ? 1 : -1));
    return up == (nearest > 0) ? std::copysign(std::numeric_limits<float>::infinity(), most) : most;
  }
  const auto limit = static_cast<float>(nearest);
  const Rational given(static_cast<double>(limit));
  if (up ? given < exact : given > exact) {
    return std::nextafter(limit, std::copysign(std::numeric_limits<float>::infinity(), up ? 1.0F : -1.0F));
  }
  return limit;
}

template <class T>
std::span<const T> samples_as(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const T*>(bytes.data()), bytes.size() / sizeof(T)};
}

}  // namespace

void learn_images(LayerStack& stack, const ImageOpener& opener) {
  std::set<std::pair<std::string_view, std::int64_t>> seen;
  std::int64_t most = 0;
  bool first = true;
  bool random_access = true;
  for (const LayerInput& input : stack.layers) {
    if (!seen.emplace(input.path, input.page).second) {
      continue;
    }
    const Result<std::unique_ptr<ImageSource>> opened = open_tiled(opener, input.path, input.page, stack.tiles);
    if (!opened) {
      continue;
    }
    const ImageInfo& info = opened.value()->info();
    stack.samples = first ? info.samples : stack.samples;
    first = false;
    random_access = random_access && info.random_access;
    stack.rows_per_block = std::max(stack.rows_per_block, info.rows_per_block);
    most = std::max(most, info.decoder_bytes);
  }
  stack.random_access = random_access;
  stack.decoder_bytes = most;
  stack.spills = std::make_shared<ColumnSpills>();
}

std::int64_t LayerReader::lines_per_pass(const LayerStack& stack, std::int64_t panel_bytes) {
  if (stack.lines_along == LinesAlong::rows) {
    return stack.random_access ? 1 : stack.lines;
  }
  // A bit panel is held twice while it is turned: once as rows, once as lines.
  const std::int64_t copies = stack.samples == SampleType::bit ? 2 : 1;
  const std::int64_t lines = panel_bytes / std::max<std::int64_t>(1, copies * held_line_bytes(stack)) / 8 * 8;
  return std::min(stack.lines, std::max<std::int64_t>(8, lines));
}

std::int64_t LayerReader::fixed_bytes(const LayerStack& stack, std::int64_t lines) {
  const std::int64_t decoder = stack.decoder_bytes.value_or(0);
  if (stack.lines_along == LinesAlong::columns) {
    return decoder + band_bytes(stack);
  }
  return decoder + (stack.samples == SampleType::bit ? 0 : std::min(lines, stack.lines) * held_line_bytes(stack));
}

std::int64_t LayerReader::least_panel_bytes(const LayerStack& stack) {
  return stack.lines_along == LinesAlong::columns ? 16 * held_line_bytes(stack) : 0;
}

LayerReader::LayerReader(const LayerStack& stack, const ImageOpener& opener, std::int64_t panel_bytes)
    : stack_(stack), opener_(opener), panel_lines_(lines_per_pass(stack, panel_bytes)) {}

std::int64_t LayerReader::least_memory_bytes(std::int64_t lines) {
  std::int64_t decoder = 0;
  if (!stack_.decoder_bytes) {
    LayerStack known = stack_;
    learn_images(known, opener_);
    decoder = known.decoder_bytes.value_or(0);
  }
  return decoder + fixed_bytes(stack_, lines) + least_panel_bytes(stack_);
}

void LayerReader::grant_memory(std::int64_t lines, std::int64_t bytes) {
  const std::int64_t panel = bytes - (least_memory_bytes(lines) - least_panel_bytes(stack_));
  panel_lines_ = lines_per_pass(stack_, panel);
}

Result<void> LayerReader::check_image(const LayerInput& input, const ImageInfo& info) const {
  const bool rows = stack_.lines_along == LinesAlong::rows;
  const std::int64_t width = rows ? stack_.pixels : stack_.lines;
  const std::int64_t height = rows ? stack_.lines : stack_.pixels;
  if (info.width == width && info.height == height && info.samples == stack_.samples) {
    return {};
  }
  const auto bits = [](SampleType samples) { return samples == SampleType::bit ? 1 : 8 * row_bytes(samples, 1); };
  return Error{ErrorCode::bad_file,
               input.path + ": page " + std::to_string(input.page) + ": is " + std::to_string(info.width) + " x " +
                   std::to_string(info.height) + " pixels of " + std::to_string(bits(info.samples)) +
                   " bit, the job has " + std::to_string(width) + " x " + std::to_string(height) + " of " +
                   std::to_string(bits(stack_.samples)) + ": it is another image, or changed since the job was read"};
}

Result<void> LayerReader::select(const LayerInput& input) {
  if (source_ && input.path == path_ && input.page == page_) {
    return {};
  }
  source_.reset();
  spill_.reset();
  held_count_ = 0;
  GRAVURE_TRY(std::unique_ptr<ImageSource> opened, open_tiled(opener_, input.path, input.page, stack_.tiles));
  GRAVURE_CHECK(check_image(input, opened->info()));
  source_ = std::move(opened);
  path_ = input.path;
  page_ = input.page;
  next_row_ = 0;
  return {};
}

Result<void> LayerReader::read_rows(std::int64_t first_row, std::int64_t count, std::span<std::byte> out) {
  GRAVURE_CHECK(go_on());
  if (!source_->info().random_access && first_row < next_row_) {  // such a file only runs upwards: start it again
    source_.reset();                                              // one at a time is what its memory is counted for
    GRAVURE_TRY(source_, open_tiled(opener_, path_, page_, stack_.tiles));
  }
  next_row_ = first_row + count;
  Result<void> read = source_->read_rows(first_row, count,
                                         out.first(as_size(count * row_bytes(stack_.samples, source_->info().width))));
  if (!read) {
    source_.reset();  // whoever asks on is served by a fresh one, which says the same of the same rows
  }
  return read;
}

Result<void> LayerReader::load_panel(std::int64_t first_line) {
  const std::int64_t first = first_line / 8 * 8;  // whole bytes; from where the caller reads on, so that it fits a pass
  const std::int64_t count = std::min(panel_lines_, stack_.lines - first);
  held_count_ = 0;
  GRAVURE_CHECK(find_spill());
  if (spill_) {
    held_.resize(as_size(count * held_line_bytes(stack_)));
    GRAVURE_CHECK(spill_->read(first, count, held_, [this] { return go_on(); }));
  } else {
    GRAVURE_CHECK(decode_panel(first, count));
  }
  held_first_ = first;
  held_count_ = count;
  return {};
}

Result<void> LayerReader::find_spill() {
  // One file costs no more CPU than a second decoding does, of plain or Deflate data, and far less with the other
  // codecs.
  if (spill_ || !spills_wanted_ || !stack_.spills || stack_.samples != SampleType::bit ||
      stack_.lines <= panel_lines_) {
    return {};
  }
  const std::int64_t panel_bytes = 2 * panel_lines_ * held_line_bytes(stack_);
  const std::int64_t slab_rows = ColumnSpill::slab_rows_for(stack_.lines, panel_bytes);
  if (slab_rows == 0) {
    return {};
  }
  GRAVURE_CHECK(go_on());  // nor wait for whoever makes it
  held_ = {};              // what it takes to make one is in the place of the panel
  GRAVURE_TRY(spill_, stack_.spills->get(path_, page_, [&] {
    return ColumnSpill::make(
        {stack_.pixels, stack_.lines, slab_rows},
        [this](std::int64_t row, std::int64_t count, std::span<std::byte> out) { return read_rows(row, count, out); },
        [this] { return go_on(); });
  }));
  return {};
}

Result<void> LayerReader::decode_panel(std::int64_t first, std::int64_t count) {
  const std::int64_t rows = stack_.pixels;
  const std::int64_t image_row = row_bytes(stack_.samples, stack_.lines);
  const std::int64_t band_rows = band_rows_of(stack_);
  const std::int64_t sample = bytes_per_sample(stack_.samples);
  const bool bits = stack_.samples == SampleType::bit;
  const std::int64_t slab = row_bytes(stack_.samples, count);
  std::vector<std::byte> band(as_size(band_rows * image_row));
  std::vector<std::byte> columns(bits ? as_size(rows * slab) : 0);
  held_.resize(as_size(count * held_line_bytes(stack_)));
  for (std::int64_t row = 0; row < rows; row += band_rows) {
    const std::int64_t now = std::min(band_rows, rows - row);
    GRAVURE_CHECK(read_rows(row, now, band));
    if (bits) {  // panels start at whole bytes
      for (std::int64_t r = 0; r < now; ++r) {
        std::memcpy(columns.data() + (row + r) * slab, band.data() + r * image_row + first / 8, as_size(slab));
      }
    } else {
      transpose_samples(held_.data() + row * sample, held_line_bytes(stack_), band.data() + first * sample, image_row,
                        now, count, sample);
    }
  }
  if (bits) {
    raster::transpose(held_, columns, rows, count);
  }
  return {};
}

Result<void> LayerReader::read_bits(std::int64_t first_line, std::int64_t count, std::span<std::byte> out) {
  if (stack_.lines_along == LinesAlong::rows) {
    return read_rows(first_line, count, out);
  }
  const std::int64_t bytes = held_line_bytes(stack_);
  while (count > 0) {
    if (first_line < held_first_ || first_line >= held_first_ + held_count_) {
      GRAVURE_CHECK(load_panel(first_line));
    }
    const std::int64_t now = std::min(count, held_first_ + held_count_ - first_line);
    std::memcpy(out.data(), held_.data() + (first_line - held_first_) * bytes, as_size(now * bytes));
    out = out.subspan(as_size(now * bytes));
    first_line += now;
    count -= now;
  }
  return {};
}

Result<std::span<const std::byte>> LayerReader::read_samples(std::int64_t first_line, std::int64_t count) {
  const std::int64_t bytes = held_line_bytes(stack_);
  if (first_line < held_first_ || first_line >= held_first_ + held_count_) {
    if (stack_.lines_along == LinesAlong::rows) {
      held_count_ = 0;
      held_.resize(as_size(count * bytes));
      GRAVURE_CHECK(read_rows(first_line, count, held_));
      held_first_ = first_line;
      held_count_ = count;
    } else {
      GRAVURE_CHECK(load_panel(first_line));
    }
  }
  const std::int64_t now = std::min(count, held_first_ + held_count_ - first_line);
  return std::span<const std::byte>(held_).subspan(as_size((first_line - held_first_) * bytes), as_size(now * bytes));
}

Result<LayerReader::Limit> LayerReader::limit_of(const LayerInput& input) const {
  if (stack_.levels == 0) {
    const std::int64_t limit = stack_.threshold.value_or(0);
    const bool integers = stack_.samples != SampleType::f32;
    if (integers && (limit < 0 || limit > integer_maximum(stack_.samples))) {
      return Error{ErrorCode::out_of_range, stack_.threshold_name + " = " + std::to_string(limit) +
                                                ": samples go from 0 to " +
                                                std::to_string(integer_maximum(stack_.samples))};
    }
    return Limit{integers ? static_cast<double>(limit) : float_limit(Rational(limit), raster::Where::at_least),
                 raster::Where::at_least};
  }
  const bool integers = stack_.samples != SampleType::f32;
  Rational low = stack_.depth_min.value_or(0);
  Rational high = stack_.depth_max.value_or(integers ? Rational(integer_maximum(stack_.samples)) : Rational(1));
  if (stack_.fires == Fires::black) {  // dark is deep
    std::swap(low, high);
  }
  if (low == high) {
    return Error{ErrorCode::bad_argument, stack_.depth_min_name + " = " + stack_.depth_max_name + " = " +
                                              to_decimal_string(low) + ": a depth map needs two different ends"};
  }
  if (!integers) {
    const Rational at = low + (high - low) * Rational(2 * input.level + 1, 2 * stack_.levels);
    const raster::Where where = low < high ? raster::Where::at_least : raster::Where::at_most;
    return Limit{float_limit(at, where), where};
  }
  for (const Rational& end : {low, high}) {
    if (denominator_of(end) != 1 || end < 0 || end > integer_maximum(stack_.samples)) {
      return Error{ErrorCode::out_of_range, stack_.depth_min_name + ", " + stack_.depth_max_name + ": " +
                                                to_decimal_string(end) + " must be an integer from 0 to " +
                                                std::to_string(integer_maximum(stack_.samples)) + " for this map"};
    }
  }
  const auto vmin = static_cast<std::uint32_t>(numerator_of(low));
  const auto vmax = static_cast<std::uint32_t>(numerator_of(high));
  return Limit{static_cast<double>(raster::slice_threshold(input.level, stack_.levels, vmin, vmax)),
               raster::slice_where(vmin, vmax)};
}

void LayerReader::cut(std::span<const std::byte> samples, std::int64_t count, const Limit& limit,
                      std::span<std::byte> out) const {
  switch (stack_.samples) {
    case SampleType::u8:
      raster::threshold_rows(out, samples_as<std::uint8_t>(samples), stack_.pixels, count,
                             static_cast<std::uint8_t>(limit.value), limit.where);
      break;
    case SampleType::u16:
      raster::threshold_rows(out, samples_as<std::uint16_t>(samples), stack_.pixels, count,
                             static_cast<std::uint16_t>(limit.value), limit.where);
      break;
    case SampleType::f32:
      raster::threshold_rows(out, samples_as<float>(samples), stack_.pixels, count, static_cast<float>(limit.value),
                             limit.where);
      break;
    case SampleType::bit:
      break;
  }
}

Result<bool> LayerReader::read_lines(std::int64_t layer, std::int64_t first_line, std::int64_t count,
                                     std::span<std::byte> out) {
  const LayerInput& input = stack_.layers.at(as_size(layer));
  GRAVURE_CHECK(select(input));
  const std::span<std::byte> lines = out.first(as_size(count * row_bytes(SampleType::bit, stack_.pixels)));
  if (stack_.samples == SampleType::bit) {
    GRAVURE_CHECK(read_bits(first_line, count, lines));
    return source_->info().zero_is_white != (stack_.fires == Fires::black);
  }
  GRAVURE_TRY(const Limit limit, limit_of(input));
  for (std::int64_t line = 0; line < count;) {
    GRAVURE_TRY(const std::span<const std::byte> samples, read_samples(first_line + line, count - line));
    const std::int64_t now = static_cast<std::int64_t>(samples.size()) / held_line_bytes(stack_);
    cut(samples, now, limit, lines.subspan(as_size(line * row_bytes(SampleType::bit, stack_.pixels))));
    line += now;
  }
  // Slices already know which end is deep; a thresholded picture still has its polarity.
  return stack_.levels == 0 && stack_.fires == Fires::black;
}

}  // namespace gravure
