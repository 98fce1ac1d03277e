#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "gravure/core/file_output.hpp"
#include "gravure/formats/grv.hpp"
#include "gravure/formats/job_file.hpp"
#include "gravure/formats/png_writer.hpp"
#include "gravure/report/report_data.hpp"
#include "gravure/twin/unroll.hpp"
#include "program_files.hpp"
#include "report_command.hpp"
#include "report_writer.hpp"

namespace gravure::cli {
namespace {

struct PreviewArguments {
  std::string program;
  std::string output;
  std::optional<std::int64_t> layer;  // none: all, as depth
  std::int64_t width = 1600;
};

using Colour = std::array<std::uint8_t, 3>;
constexpr Colour kPaper = {255, 255, 255};
constexpr Colour kSeam = {212, 53, 43};
constexpr std::int64_t kGap = 16;

/// Between stops, evenly spaced from 0 to 1.
template <std::size_t N>
Colour between(const std::array<Colour, N>& stops, double share) {
  const double at = std::clamp(share, 0.0, 1.0) * static_cast<double>(N - 1);
  const std::size_t i = std::min(N - 2, static_cast<std::size_t>(at));
  Colour colour = {};
  for (std::size_t k = 0; k < 3; ++k) {
    const double low = stops[i][k];
    colour[k] = static_cast<std::uint8_t>(std::lround(low + (stops[i + 1][k] - low) * (at - static_cast<double>(i))));
  }
  return colour;
}

/// The colours of the report page: paper to a deep blue, darker is deeper; or paper to ink for fired pixels.
Colour colour_of(double share, bool depth) {
  constexpr std::array<Colour, 7> kDepth = {
      {{244, 240, 228}, {214, 216, 190}, {150, 190, 172}, {78, 149, 152}, {36, 101, 126}, {20, 56, 92}, {12, 24, 52}}};
  constexpr std::array<Colour, 2> kFired = {{{246, 245, 240}, {26, 32, 38}}};
  return depth ? between(kDepth, share) : between(kFired, share);
}

/// Values of one part of the picture, and where it goes.
struct Part {
  report::Extent values;
  report::Extent size;  ///< on the picture
  std::int64_t top = 0;
  std::vector<double> shares;
};

/// The size of a part in a frame of `width` by `most_rows`; a value is `aspect` times as high as wide on the workpiece.
report::Extent size_of(const report::Extent& values, double aspect, std::int64_t width, std::int64_t most_rows) {
  const double height = static_cast<double>(values.height) / static_cast<double>(values.width) * aspect;
  const double rows = height * static_cast<double>(width);
  const auto pixels = [](double wanted) { return std::max<std::int64_t>(1, std::llround(wanted)); };
  if (rows <= static_cast<double>(most_rows)) {
    return {width, pixels(rows)};
  }
  return {pixels(static_cast<double>(most_rows) / height), most_rows};  // long strips keep their shape and lose width
}

class Canvas {
 public:
  explicit Canvas(const report::Extent& size) : size_(size) {
    pixels_.reserve(static_cast<std::size_t>(3 * size.area()));
    for (std::int64_t i = 0; i < size.area(); ++i) {
      for (const std::uint8_t sample : kPaper) {
        pixels_.push_back(static_cast<std::byte>(sample));
      }
    }
  }
  void put(std::int64_t x, std::int64_t y, const Colour& colour) {
    for (std::size_t k = 0; k < 3; ++k) {
      pixels_[static_cast<std::size_t>(3 * (y * size_.width + x)) + k] = static_cast<std::byte>(colour[k]);
    }
  }
  void draw(const Part& part, bool depth) {
    for (std::int64_t y = 0; y < part.size.height; ++y) {
      for (std::int64_t x = 0; x < part.size.width; ++x) {
        const std::int64_t value =
            y * part.values.height / part.size.height * part.values.width + x * part.values.width / part.size.width;
        put(x, part.top + y, colour_of(part.shares[static_cast<std::size_t>(value)], depth));
      }
    }
  }
  /// The seam through the middle of a part, dashed.
  void draw_seam(const Part& part, bool across) {
    const std::int64_t length = across ? part.size.width : part.size.height;
    for (std::int64_t i = 0; i < length; ++i) {
      if (i / 8 % 2 == 0) {
        across ? put(i, part.top + part.size.height / 2, kSeam) : put(part.size.width / 2, part.top + i, kSeam);
      }
    }
  }
  Result<std::string> png() const { return encode_png({size_.width, size_.height, 3, pixels_}); }

 private:
  report::Extent size_;
  std::vector<std::byte> pixels_;
};

std::vector<double> shares_of(std::vector<double> values, double most) {
  for (double& value : values) {
    value = most > 0 ? value / most : 0;
  }
  return values;
}

Json json_of(const Part& part) {
  return {{"left", 0}, {"top", part.top}, {"width", part.size.width}, {"height", part.size.height}};
}

Result<report::LayerPictures> pictures_of(const PreviewArguments& options, const ProgramHeader& header,
                                          const Command& command) {
  ProgressBar bar("preview");
  report::LayerPicturesOptions pictures;
  pictures.memory_bytes = command.memory_bytes();
  pictures.threads = command.threads;
  pictures.cancel = &cancel_token();
  pictures.progress = &bar;
  pictures.only_layer = options.layer;
  const UnrolledSize size = unrolled_size(header);
  const double aspect = to_double(header.plan.rotary.line_pitch_um) / to_double(header.plan.line.pixel_pitch_um);
  const bool rows = header.lines_along == LinesAlong::rows;
  const report::Extent wanted =
      size_of({size.width, size.height}, rows ? aspect : 1 / aspect, options.width, 2 * options.width);
  constexpr std::int64_t kMostCells = 4'000'000;  // of every worker, 8 bytes each
  pictures.most_cells = std::min(wanted.area(), kMostCells);
  pictures.most_shown_cells = pictures.most_cells;
  return report::layer_pictures([&options] { return open_grv(options.program); }, emulated_devices(), pictures);
}

Result<int> run_preview(const PreviewArguments& options, const Command& command) {
  GRAVURE_CHECK(refuse_overwrite(options.output, {options.program}));
  GRAVURE_TRY(const std::unique_ptr<LineSource> program, open_grv(options.program));
  const ProgramHeader& header = program->header();
  GRAVURE_CHECK(check_drawable(header, options.program));
  GRAVURE_TRY(const Job job, parse_job(header.job_text, header.job_path));
  GRAVURE_TRY(const report::LayerPictures pictures, pictures_of(options, header, command));
  const bool depth = !options.layer;
  // One layer is shown as what fired, all of them as what is left of the surface.
  const std::optional<report::PulseRemoval> removal = depth ? report::pulse_removal(job.laser) : std::nullopt;
  const report::Relief relief = report::relief_of(pictures, header.plan, removal);
  const bool rows = pictures.lines_are_rows;
  const double line_um = to_double(header.plan.rotary.line_pitch_um);
  const double pixel_um = to_double(header.plan.line.pixel_pitch_um);
  const double aspect = rows ? line_um / pixel_um : pixel_um / line_um;
  const auto cells_per = [](std::int64_t pixels, std::int64_t cells) {
    return static_cast<double>(pixels) / static_cast<double>(cells);
  };
  const double cell_aspect = aspect * cells_per(pictures.picture.height, pictures.cells.height) /
                             cells_per(pictures.picture.width, pictures.cells.width);
  const double most = depth ? relief.deepest : 1;
  const double seam_most = depth ? relief.seam_deepest : 1;
  Part whole{pictures.cells, size_of(pictures.cells, cell_aspect, options.width, 2 * options.width), 0,
             shares_of(relief.cells, most)};
  const report::Extent seam_extent = pictures.seam_extent();
  Part seam{seam_extent, size_of(seam_extent, aspect, options.width, options.width), whole.size.height + kGap,
            shares_of(relief.seam, seam_most)};
  const report::Extent all{std::max(whole.size.width, seam.size.width), seam.top + seam.size.height};
  Canvas canvas(all);
  canvas.draw(whole, depth);
  canvas.draw(seam, depth);
  canvas.draw_seam(seam, rows);
  GRAVURE_TRY(const std::string png, canvas.png());
  GRAVURE_CHECK(write_file(options.output, png));
  const char* unit = relief.in_um ? "um" : "pulses";
  if (command.json) {
    Json json = {{"picture", options.output},
                 {"width", all.width},
                 {"height", all.height},
                 {"layer", options.layer ? Json(*options.layer) : Json(nullptr)},
                 {"fires", polarity_name(header.fires)},
                 {"unrolled", json_of(whole)},
                 {"seam", json_of(seam)}};
    json["seam"]["lines_each"] = pictures.seam_place.lines_each;
    json["seam"]["first_column"] = pictures.seam_place.first_column;
    json["seam"]["columns"] = pictures.seam_place.columns;
    json["unit"] = unit;
    json["deepest"] = relief.deepest;
    json["mean"] = relief.mean;
    print_json(json);
  } else {
    const std::string what = options.layer
                                 ? fmt::format("layer {}, dark fires", *options.layer)
                                 : fmt::format("all layers as depth, at most {:.4g} {}", relief.deepest, unit);
    print(fmt::format("{}: {} x {}: {}; below, the seam: {} lines on either side, columns {} to {}\n", options.output,
                      all.width, all.height, what, pictures.seam_place.lines_each, pictures.seam_place.first_column,
                      pictures.seam_place.first_column + pictures.seam_place.columns - 1));
  }
  return kDone;
}

}  // namespace

void add_preview(CLI::App& app, Command& command) {
  CLI::App* verb = add_verb(app, command, "preview",
                            "A picture of what a program exposes: unrolled, all layers as depth or one, and the seam "
                            "enlarged below");
  const auto options = std::make_shared<PreviewArguments>();
  verb->add_option("PROGRAM", options->program, "Program file (.grv)")->required();
  verb->add_option("-o,--output", options->output, "PNG to write")->required();
  verb->add_option("--layer", options->layer, "Layer of the image stack, from 0; else all of them as depth")
      ->check(integer_from(0, kMostIndex));
  verb->add_option("--width", options->width, "Of the picture in pixels")
      ->check(integer_from(64, 8'192))
      ->capture_default_str();
  add_work_options(*verb, command);
  verb->callback([&command, options] { command.run = [&command, options] { return run_preview(*options, command); }; });
}

}  // namespace gravure::cli
