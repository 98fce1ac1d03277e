#include "sample_sets.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "format_set.hpp"
#include "honeycomb.hpp"
#include "image_writer.hpp"
#include "lattice.hpp"

namespace gravure::samples {
namespace {

constexpr std::int64_t kRollerColumns = 15'000;
constexpr std::int64_t kRollerLines = 7840;
constexpr std::int64_t kPanelPixels = 5000;

constexpr std::int64_t kSmallPixels = 200;
constexpr std::int64_t kSmallLines = 240;

/// One 16-bit depth map of 96 million pixels: samples/roller/job.toml slices it into 100 layers.
Result<void> make_roller(const std::string& folder) {
  const Honeycomb honeycomb;
  FileOptions options;
  options.samples = Samples::u16;
  options.compression = "zip";
  options.x_dots_per_mm = options.y_dots_per_mm = 125;  // 8 um
  return write_image(folder + "/honeycomb.tif", Honeycomb::kWidth, Honeycomb::kHeight,
                     {[&honeycomb](std::int64_t y, auto& levels) { honeycomb.row(y, levels); }}, options);
}

/// One bilevel mask for every revolution of samples/stent/job.toml.
Result<void> make_stent(const std::string& folder) {
  FileOptions options;
  options.compression = "ccittfax4";
  options.x_dots_per_mm = options.y_dots_per_mm = 1000.0 / 6;
  return write_image(folder + "/diamond.tif", DiamondLattice::kWidth, DiamondLattice::kHeight, {DiamondLattice::row},
                     options);
}

/// Row of a small layer: a wedge that widens from layer to layer under a coarse grid, unlike its mirror images.
RowSource small_layer(std::int64_t layer) {
  return [layer](std::int64_t y, std::vector<std::uint16_t>& levels) {
    for (std::int64_t x = 0; x < kSmallPixels; ++x) {
      const bool wedge = x * kSmallLines < (y + 40 * layer) * kSmallPixels / 2;
      const bool grid = x % 20 < 2 || y % 24 < 3;
      levels[static_cast<std::size_t>(x)] = wedge != grid ? 65535 : 0;
    }
  };
}

/// The same picture lying on its side: rows become columns.
RowSource turned(const RowSource& upright) {
  return [upright](std::int64_t y, std::vector<std::uint16_t>& levels) {
    std::vector<std::uint16_t> row(static_cast<std::size_t>(kSmallPixels));
    for (std::int64_t x = 0; x < kSmallLines; ++x) {
      upright(x, row);
      levels[static_cast<std::size_t>(x)] = row[static_cast<std::size_t>(y)];
    }
  };
}

/// Three of these pictures along the rows and two down, the second of each turned over: what repeat.toml exposes.
RowSource repeated(const RowSource& tile) {
  return [tile](std::int64_t y, std::vector<std::uint16_t>& levels) {
    std::vector<std::uint16_t> row(static_cast<std::size_t>(kSmallPixels));
    tile(y < kSmallLines ? y : 2 * kSmallLines - 1 - y, row);
    const auto at = levels.begin();
    std::copy(row.begin(), row.end(), at);
    std::copy(row.rbegin(), row.rend(), at + kSmallPixels);
    std::copy(row.begin(), row.end(), at + 2 * kSmallPixels);
  };
}

/// Six bilevel layers, each in another compression; once upright (job.toml), once on their side (columns.toml); one of
/// them as tiles side by side.
Result<void> make_small(const std::string& folder) {
  std::error_code ignored;  // write_image says so if the folder is missing
  std::filesystem::create_directories(folder + "/columns", ignored);
  const char* const compressions[] = {"none", "packbits", "lzw", "zip", "ccittfax4", "lzw"};
  std::int64_t layer = 0;
  for (const char* const compression : compressions) {
    FileOptions options;
    options.compression = compression;
    options.tiled = layer == 5;
    options.x_dots_per_mm = options.y_dots_per_mm = 125;
    std::string name = "/layer_";  // 8, 9, 10, ...: natural order matters
    name += std::to_string(8 + layer) + ".tif";
    std::string upright_path = folder;
    upright_path += name;
    std::string turned_path = folder;
    turned_path.append("/columns").append(name);
    const RowSource picture = small_layer(layer);
    GRAVURE_CHECK(write_image(upright_path, kSmallPixels, kSmallLines, {picture}, options));
    GRAVURE_CHECK(write_image(turned_path, kSmallLines, kSmallPixels, {turned(picture)}, options));
    if (layer == 4) {
      GRAVURE_CHECK(
          write_image(folder + "/repeated.tif", 3 * kSmallPixels, 2 * kSmallLines, {repeated(picture)}, options));
    }
    ++layer;
  }
  return {};
}

/// Row of a lattice of diamonds of 40 x 32 pixels that grow along the row and shrink from layer to layer: where a pixel
/// belongs shows in its neighbourhood, and no mirror image is alike.
RowSource diamonds(std::int64_t layer, std::int64_t width) {
  return [layer, width](std::int64_t y, std::vector<std::uint16_t>& levels) {
    constexpr std::int64_t kAlong = 40;
    constexpr std::int64_t kAround = 32;
    for (std::int64_t x = 0; x < width; ++x) {
      const std::int64_t from_middle = std::abs(x % kAlong - kAlong / 2) + std::abs(y % kAround - kAround / 2);
      const std::int64_t radius = 14 + 12 * x / width - layer;
      levels[static_cast<std::size_t>(x)] = from_middle < radius ? 65535 : 0;
    }
  };
}

Result<void> make_diamonds(const std::string& folder, std::int64_t width, std::int64_t height, std::int64_t layers) {
  FileOptions options;
  options.compression = "ccittfax4";
  options.x_dots_per_mm = options.y_dots_per_mm = 125;  // 8 um
  for (std::int64_t layer = 0; layer < layers; ++layer) {
    const std::string path = folder + "/layer_" + std::to_string(layer) + ".tif";
    GRAVURE_CHECK(write_image(path, width, height, {diamonds(layer, width)}, options));
  }
  return {};
}

/// Eight layers of a face of 120 mm, for samples/helical_roller/job.toml.
Result<void> make_helical_roller(const std::string& folder) {
  return make_diamonds(folder, kRollerColumns, kRollerLines, 8);
}

/// Four layers of a panel of 40 x 40 mm, for samples/panel/job.toml.
Result<void> make_panel(const std::string& folder) {
  return make_diamonds(folder, kPanelPixels, kPanelPixels, 4);
}

/// Height field and bitmap of samples/saddle/job.toml: z = 0.02 x y over 12 x 12 mm, -0.8 to 0.8 mm in 16 bits.
Result<void> make_saddle(const std::string& folder) {
  constexpr std::int64_t kSide = 121;
  FileOptions heights;
  heights.samples = Samples::u16;
  heights.compression = "zip";
  heights.x_dots_per_mm = heights.y_dots_per_mm = 10;
  const RowSource saddle = [](std::int64_t row, std::vector<std::uint16_t>& levels) {
    constexpr std::int64_t kMiddle = kSide / 2;
    for (std::int64_t column = 0; column < kSide; ++column) {
      // In units of 0.0002 mm: x y / 50 with both in tenths of a mm.
      const std::int64_t height = (column - kMiddle) * (kMiddle - row);
      levels[static_cast<std::size_t>(column)] = static_cast<std::uint16_t>((65535 * (height + 4000) + 4000) / 8000);
    }
  };
  GRAVURE_CHECK(write_image(folder + "/saddle.tif", kSide, kSide, {saddle}, heights));
  FileOptions bits;
  bits.compression = "ccittfax4";
  bits.x_dots_per_mm = bits.y_dots_per_mm = 25;  // 40 um
  return write_image(folder + "/diamonds.tif", 120, 72, {diamonds(0, 120)}, bits);
}

Result<void> make_formats(const std::string& folder) {
  for (const FormatFile& file : format_files()) {
    std::vector<RowSource> pages;
    pages.reserve(static_cast<std::size_t>(file.pages));
    for (int page = 0; page < file.pages; ++page) {
      pages.push_back(format_page(page));
    }
    GRAVURE_CHECK(write_image(folder + "/" + file.name, kFormatWidth, kFormatHeight, pages, file.options));
  }
  return {};
}

}  // namespace

const std::vector<SampleSet>& sample_sets() {
  static const std::vector<SampleSet> sets = {
      {"roller", "16-bit depth map of a honeycomb, 3500 x 27489 pixels", make_roller},
      {"stent", "bilevel G4 mask of a diamond lattice, 3000 x 942 pixels", make_stent},
      {"helical_roller", "eight bilevel G4 layers of a roller face, 15000 x 7840 pixels", make_helical_roller},
      {"panel", "four bilevel G4 layers of a panel, 5000 x 5000 pixels", make_panel},
      {"saddle", "16-bit height field of a saddle and a bilevel G4 bitmap of 120 x 72 pixels for it", make_saddle},
      {"small", "six bilevel layers of 200 x 240 pixels, upright and on their side, one as tiles", make_small},
      {"formats", "one small picture in every format that is read", make_formats},
  };
  return sets;
}

}  // namespace gravure::samples
