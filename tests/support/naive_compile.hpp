#pragma once

#include <cstdint>
#include <vector>

#include "gravure/pipeline/compile.hpp"
#include "memory_images.hpp"
#include "memory_program.hpp"

/// The compiler once more, a pixel at a time and in exact ratios: what its bytes are held against.
namespace gravure::test {

/// Does a raw sample ask for a pulse in this layer?
inline bool fires(const LayerStack& stack, const ImageInfo& info, std::int64_t level, double raw) {
  const bool white_fires = stack.fires == Fires::white;
  if (stack.samples == SampleType::bit) {
    const bool white = (raw != 0) != info.zero_is_white;
    return white == white_fires;
  }
  const Rational sample(raw);
  if (stack.levels == 0) {
    return (sample >= Rational(stack.threshold.value_or(0))) == white_fires;
  }
  const int most = stack.samples == SampleType::u8 ? 255 : stack.samples == SampleType::u16 ? 65535 : 1;
  const Rational shallow = white_fires ? stack.depth_min.value_or(0) : stack.depth_max.value_or(most);
  const Rational deep = white_fires ? stack.depth_max.value_or(most) : stack.depth_min.value_or(0);
  const Rational depth = (sample - shallow) / (deep - shallow);
  const Integer pulses = depth <= 0   ? Integer(0)
                         : depth >= 1 ? Integer(stack.levels)
                                      : floor_of(Rational(depth * stack.levels + Rational(1, 2)));
  return pulses > level;
}

/// Where a row or column of a picture of tiles lies in its tile.
inline std::int64_t in_tile(std::int64_t at, std::int64_t length, bool mirror) {
  return mirror && at / length % 2 != 0 ? length - 1 - at % length : at % length;
}

/// Pixel `column` of line `line` of a layer, as the image has it.
inline bool image_pixel(const LayerStack& stack, MemoryImages& images, std::int64_t layer, std::int64_t line,
                        std::int64_t column) {
  const LayerInput& input = stack.layers[static_cast<std::size_t>(layer)];
  const MemoryImages::Image& image = images.at(input.path, input.page);
  const bool rows = stack.lines_along == LinesAlong::rows;
  const std::int64_t y = in_tile(rows ? line : column, image.info.height, stack.tiles.mirror_down);
  const std::int64_t x = in_tile(rows ? column : line, image.info.width, stack.tiles.mirror_across);
  return fires(stack, image.info, input.level, image.samples(y, x));
}

inline void set_bit(std::vector<std::byte>& bytes, std::int64_t bit) {
  bytes[static_cast<std::size_t>(bit / 8)] |= static_cast<std::byte>(0x80U >> (bit % 8));
}

/// A line in time order, as the program is to hold it.
inline std::vector<std::byte> naive_line(const ProgramHeader& header, const LayerStack& stack, MemoryImages& images,
                                         std::int64_t layer, std::int64_t line) {
  const bool starts_reverse = header.layers[static_cast<std::size_t>(layer)].starts_reverse;
  const bool reverse = header.plan.line.bidirectional && (starts_reverse != (line % 2 != 0));
  std::vector<std::byte> bytes(static_cast<std::size_t>(header.line_bytes()));
  for (std::int64_t column = 0; column < stack.pixels; ++column) {
    if (image_pixel(stack, images, layer, line, column)) {
      set_bit(bytes, reverse ? stack.pixels - 1 - column : column);
    }
  }
  return bytes;
}

/// The header compile() needs for a stack, its layers starting in turn to the right and to the left.
inline ProgramHeader header_for(const LayerStack& stack, bool bidirectional, bool first_starts_reverse = false) {
  ProgramHeader header;
  header.plan.line.pixels = stack.pixels;
  header.plan.line.bidirectional = bidirectional;
  header.plan.rotary.lines_per_revolution = stack.lines;
  header.plan.job.revolutions = static_cast<std::int64_t>(stack.layers.size());
  header.fires = stack.fires;
  header.lines_along = stack.lines_along;
  for (std::size_t layer = 0; layer < stack.layers.size(); ++layer) {
    StoredLayer stored;
    stored.level = stack.layers[layer].level;
    stored.starts_reverse = bidirectional && first_starts_reverse != ((layer % 2 != 0) && stack.lines % 2 != 0);
    header.layers.push_back(stored);
    header.layer_of_revolution.push_back(static_cast<std::uint32_t>(layer));
  }
  return header;
}

/// A number from three, the same on every machine: images made of it need no memory.
inline std::uint64_t mixed(std::uint64_t seed, std::int64_t row, std::int64_t column) {
  std::uint64_t x = seed * 0x9E3779B97F4A7C15U + static_cast<std::uint64_t>(row) * 0xBF58476D1CE4E5B9U +
                    static_cast<std::uint64_t>(column) * 0x94D049BB133111EBU;
  x ^= x >> 31U;
  x *= 0xD6E8FEB86659FD93U;
  return x ^ (x >> 32U);
}

/// Random samples of a type. Depths of float maps also fall outside 0..1 and onto the borders between levels.
inline Samples random_samples(SampleType type, std::uint64_t seed, std::int64_t levels = 0) {
  return [=](std::int64_t row, std::int64_t column) -> double {
    const std::uint64_t word = mixed(seed, row, column);
    switch (type) {
      case SampleType::bit:
        return static_cast<double>(word & 1U);
      case SampleType::u8:
        return static_cast<double>(word & 0xFFU);
      case SampleType::u16:
        return static_cast<double>(word & 0xFFFFU);
      case SampleType::f32:
        break;
    }
    if (levels > 0 && word % 3 == 0) {
      const auto border = static_cast<double>(2 * (word % static_cast<std::uint64_t>(levels)) + 1) /
                          (2.0 * static_cast<double>(levels));
      return static_cast<double>(static_cast<float>(border));
    }
    return static_cast<double>(static_cast<float>((word >> 8U) & 0xFFFFFFU)) / 8388608.0 - 0.5;  // -0.5 .. 1.5
  };
}

/// A stack of `layers` images of one type.
inline LayerStack random_stack(MemoryImages& images, SampleType type, LinesAlong along, std::int64_t lines,
                               std::int64_t pixels, std::int64_t layers, std::uint64_t seed) {
  LayerStack stack;
  stack.lines = lines;
  stack.pixels = pixels;
  stack.samples = type;
  stack.lines_along = along;
  for (std::int64_t layer = 0; layer < layers; ++layer) {
    ImageInfo info;
    info.path = "layer" + std::to_string(layer);
    info.width = along == LinesAlong::rows ? pixels : lines;
    info.height = along == LinesAlong::rows ? lines : pixels;
    info.samples = type;
    images.add({info, random_samples(type, seed + static_cast<std::uint64_t>(layer)), {}, {}});
    stack.layers.push_back({info.path, 0, 0});
  }
  return stack;
}

/// One depth map, cut into `levels` layers.
inline LayerStack depth_stack(MemoryImages& images, SampleType type, LinesAlong along, std::int64_t lines,
                              std::int64_t pixels, std::int64_t levels, std::uint64_t seed) {
  LayerStack stack = random_stack(images, type, along, lines, pixels, 1, seed);
  images.at("layer0").samples = random_samples(type, seed, levels);
  stack.levels = levels;
  stack.layers.clear();
  for (std::int64_t level = 0; level < levels; ++level) {
    stack.layers.push_back({"layer0", 0, level});
  }
  return stack;
}

}  // namespace gravure::test
