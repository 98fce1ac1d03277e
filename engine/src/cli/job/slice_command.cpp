#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "gravure/formats/image_files.hpp"
#include "gravure/formats/tiff_writer.hpp"
#include "gravure/pipeline/layer_reader.hpp"
#include "gravure/raster/count.hpp"
#include "gravure/raster/place.hpp"
#include "program/program_files.hpp"
#include "verb.hpp"

namespace gravure::cli {
namespace {

namespace fs = std::filesystem;

struct SliceArguments {
  std::string map;
  std::string folder;
  std::int64_t levels = 0;
  std::string fires = "white";
  std::string depth_min;
  std::string depth_max;
};

Result<LayerStack> stack_of(const SliceArguments& options, const ImageInfo& info) {
  if (info.samples == SampleType::bit) {
    return Error{ErrorCode::bad_file, options.map + ": is bilevel; a depth map has 8, 16 or 32 bits a sample"};
  }
  LayerStack stack;
  stack.lines = info.height;
  stack.pixels = info.width;
  stack.samples = info.samples;
  stack.random_access = info.random_access;
  stack.fires = options.fires == "white" ? Fires::white : Fires::black;
  stack.levels = options.levels;
  stack.depth_min_name = "--depth-min";
  stack.depth_max_name = "--depth-max";
  if (!options.depth_min.empty()) {
    GRAVURE_TRY(stack.depth_min, decimal_option("--depth-min", options.depth_min));
  }
  if (!options.depth_max.empty()) {
    GRAVURE_TRY(stack.depth_max, decimal_option("--depth-max", options.depth_max));
  }
  for (std::int64_t level = 0; level < options.levels; ++level) {
    stack.layers.push_back({options.map, 0, level});
  }
  return stack;
}

std::string layer_path(const SliceArguments& options, std::int64_t level) {
  const auto digits = std::max<std::size_t>(3, std::to_string(options.levels - 1).size());
  return (fs::path(options.folder) / fmt::format("layer_{:0{}}.tif", level, digits)).string();
}

/// Slices levels [first, first + count) in one pass over the map. What is written is the map's polarity: where a pulse
/// fires the layer is white, or black where black fires.
Result<void> slice_levels(const SliceArguments& options, const LayerStack& stack, const ImageInfo& info,
                          const ImageOpener& files, std::int64_t first, std::int64_t count,
                          std::vector<std::int64_t>& fired, std::vector<FileOutput>& finished) {
  std::vector<BilevelTiffWriter> writers;
  BilevelTiffPage page;
  page.width = stack.pixels;
  page.height = stack.lines;
  page.x_dots_per_mm = info.x_dots_per_mm;
  page.y_dots_per_mm = info.y_dots_per_mm;
  for (std::int64_t level = first; level < first + count; ++level) {
    GRAVURE_TRY(BilevelTiffWriter writer, BilevelTiffWriter::create(layer_path(options, level), page));
    writers.push_back(std::move(writer));
  }
  LayerReader reader(stack, files, 0);
  const std::int64_t bytes = raster::packed_bytes(stack.pixels);
  const std::int64_t band = std::clamp<std::int64_t>((std::int64_t{1} << 20) / bytes, 1, stack.lines);
  std::vector<std::byte> read(static_cast<std::size_t>(band * bytes));
  std::vector<std::byte> placed(read.size());
  for (std::int64_t line = 0; line < stack.lines; line += band) {
    const std::int64_t now = std::min(band, stack.lines - line);
    const auto size = static_cast<std::size_t>(now * bytes);
    for (std::int64_t level = first; level < first + count; ++level) {
      if (cancel_token().cancelled()) {
        return Error{ErrorCode::cancelled, "stopped; nothing was written"};
      }
      GRAVURE_TRY(const bool dark, reader.read_lines(level, line, now, std::span(read).first(size)));
      static_cast<void>(dark);  // slices always have ones where a pulse fires
      fired[static_cast<std::size_t>(level)] += raster::popcount(std::span(read).first(size));
      raster::place_rows(std::span(placed).first(size), std::span(read).first(size), stack.pixels, now,
                         {.invert = stack.fires == Fires::black});
      GRAVURE_CHECK(writers[static_cast<std::size_t>(level - first)].append_rows(std::span(placed).first(size)));
    }
  }
  for (BilevelTiffWriter& writer : writers) {
    GRAVURE_TRY(FileOutput layer, writer.finish());
    finished.push_back(std::move(layer));
  }
  return {};
}

/// All layers into the folder: a part of them would be cut as a whole stack.
Result<void> slice_all(const SliceArguments& options, const LayerStack& stack, const ImageInfo& info,
                       const ImageOpener& files, std::vector<std::int64_t>& fired) {
  constexpr std::int64_t kOpenAtOnce = 64;  // files; the map is read once for each such group
  std::vector<FileOutput> finished;
  ProgressBar bar("slice", "layers");
  for (std::int64_t first = 0; first < options.levels; first += kOpenAtOnce) {
    const std::int64_t count = std::min(kOpenAtOnce, options.levels - first);
    GRAVURE_CHECK(slice_levels(options, stack, info, files, first, count, fired, finished));
    bar.update(first + count, options.levels);
  }
  GRAVURE_CHECK(check_not_stopped());
  for (FileOutput& layer : finished) {
    GRAVURE_CHECK(layer.commit());
  }
  return {};
}

/// A layer of an earlier, deeper slicing would be cut after these.
Result<void> refuse_surplus(const SliceArguments& options) {
  const std::string surplus = layer_path(options, options.levels);
  std::error_code ignored;
  if (fs::exists(surplus, ignored)) {
    return Error{ErrorCode::bad_argument, surplus + ": is there from another slicing and would be cut after these " +
                                              std::to_string(options.levels) + " layers: give an empty folder"};
  }
  return {};
}

Result<int> run_slice(const SliceArguments& options, const Command& command) {
  const ImageFiles files;
  GRAVURE_TRY(const std::unique_ptr<ImageSource> map, files.open(options.map, 0));
  const ImageInfo info = map->info();
  GRAVURE_TRY(const LayerStack stack, stack_of(options, info));
  GRAVURE_CHECK(refuse_surplus(options));
  std::vector<std::byte> line(static_cast<std::size_t>(raster::packed_bytes(stack.pixels)));
  LayerReader reader(stack, files, 0);
  GRAVURE_CHECK(reader.read_lines(0, 0, 1, line));  // ends that do not fit the map show before there is a folder
  std::error_code failed;
  cancel_token();  // before there is a folder: Ctrl-C takes it away again
  const bool made = fs::create_directories(options.folder, failed);
  if (failed) {
    return Error{ErrorCode::io, options.folder + ": cannot make the folder: " + failed.message()};
  }
  for (std::int64_t level = 0; level < options.levels; ++level) {
    GRAVURE_CHECK(refuse_overwrite(layer_path(options, level), {options.map}, Writes::picture));
  }
  std::vector<std::int64_t> fired(static_cast<std::size_t>(options.levels));
  if (Result<void> sliced = slice_all(options, stack, info, files, fired); !sliced) {
    if (made) {
      fs::remove(options.folder, failed);  // where nothing is in it
    }
    return sliced.error();
  }
  if (command.json) {
    Json layers = Json::array();
    for (std::int64_t level = 0; level < options.levels; ++level) {
      layers.push_back(
          {{"path", layer_path(options, level)}, {"fired_pixels", fired[static_cast<std::size_t>(level)]}});
    }
    print_json({{"map", options.map},
                {"width", stack.pixels},
                {"height", stack.lines},
                {"fires", options.fires},
                {"layers", layers}});
  } else {
    print(fmt::format("{} layers of {} x {} in {}; {} fires\n", options.levels, stack.pixels, stack.lines,
                      options.folder, options.fires));
  }
  return kDone;
}

}  // namespace

void add_slice(CLI::App& app, Command& command) {
  CLI::App* verb = add_verb(app, command, "slice", "Depth map to a stack of bilevel layers");
  const auto options = std::make_shared<SliceArguments>();
  verb->add_option("MAP", options->map, "Depth map: 8 or 16 bits, or float")->required();
  verb->add_option("-o,--output", options->folder, "Folder for the layers")->required();
  verb->add_option("--levels", options->levels, "Number of layers")->required()->check(integer_from(1, 65536));
  verb->add_option("--fires", options->fires, "Which end of the map is deep, and fires in the layers")
      ->required()
      ->check(CLI::IsMember({"white", "black"}));
  verb->add_option("--depth-min", options->depth_min, "Sample at the shallow end (default 0)");
  verb->add_option("--depth-max", options->depth_max, "Sample at the other end (default 255, 65535, or 1 for float)");
  set_run(*verb, command, options, run_slice);
}

}  // namespace gravure::cli
