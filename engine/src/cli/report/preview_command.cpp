#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>

#include "gravure/formats/grv.hpp"
#include "gravure/formats/job_file.hpp"
#include "gravure/report/report_data.hpp"
#include "gravure/twin/unroll.hpp"
#include "program/program_files.hpp"
#include "report/preview_canvas.hpp"
#include "report/preview_path.hpp"
#include "report/report_command.hpp"
#include "report/report_writer.hpp"

namespace gravure::cli {
namespace {

struct PreviewArguments {
  std::string program;
  std::string output;
  std::optional<std::int64_t> layer;  // none: all, as depth
  std::int64_t width = 1600;
};

double share_of(double value, double most) {
  return most > 0 ? value / most : 0;
}

Result<report::LayerPictures> pictures_of(const PreviewArguments& options, const GrvProgram& program,
                                          const Command& command) {
  const ProgramHeader& header = program.header();
  ProgressBar bar("preview");
  report::LayerPicturesOptions pictures;
  pictures.memory_bytes = command.memory_bytes();
  pictures.table_bytes = program.table_bytes();
  pictures.threads = command.threads;
  pictures.cancel = &cancel_token();
  pictures.progress = &bar;
  pictures.only_layer = options.layer;
  pictures.most_shown_layers = 0;  // what is drawn are pulses, of one layer or all
  pictures.remedy = fmt::format("raise --memory, or lower --width, which is {}", options.width);
  const UnrolledSize size = unrolled_size(header);
  const double aspect = to_double(header.plan.rotary.line_pitch_um) / to_double(header.plan.line.pixel_pitch_um);
  const bool rows = header.lines_along == LinesAlong::rows;
  const report::Extent wanted =
      size_in_frame({size.width, size.height}, rows ? aspect : 1 / aspect, options.width, 2 * options.width);
  constexpr std::int64_t kMostCells = 4'000'000;  // 8 bytes each
  pictures.most_cells = std::min(wanted.area(), kMostCells);
  pictures.most_shown_cells = pictures.most_cells;
  const auto programs = [&program]() -> Result<std::unique_ptr<LineSource>> { return program.reader(); };
  return report::layer_pictures(programs, emulated_devices(), pictures);
}

Result<int> run_preview(const PreviewArguments& options, const Command& command) {
  GRAVURE_TRY(const GrvProgram program, GrvProgram::open(options.program, command.memory_bytes()));
  const ProgramHeader& header = program.header();
  GRAVURE_CHECK(refuse_overwrite(options.output, inputs_of_program(options.program, header), Writes::preview));
  GRAVURE_CHECK(check_png_name(options.output));
  if (header.plan.path) {
    return options.layer ? Error{ErrorCode::bad_argument,
                                 options.program + ": follows a path and has no layers; leave --layer out"}
                         : preview_path(*program.reader(), options.output, options.width, command);
  }
  GRAVURE_CHECK(check_drawable(header, options.program));
  GRAVURE_TRY(const Job job, parse_job(header.job_text, header.job_path));
  GRAVURE_TRY(const report::LayerPictures pictures, pictures_of(options, program, command));
  const bool depth = !options.layer;
  // One layer is shown as what fired, all of them as what is left of the surface.
  const std::optional<report::PulseRemoval> removal = depth ? report::pulse_removal(job.laser) : std::nullopt;
  const report::Relief relief = report::relief_of(pictures, header.plan, removal, report::ReliefCells::left_out);
  const report::CellRelief relief_of_cell(pictures, header.plan, removal);
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
  const PicturePart whole{
      pictures.cells, size_in_frame(pictures.cells, cell_aspect, options.width, 2 * options.width), 0,
      [&](std::int64_t column, std::int64_t row) { return share_of(relief_of_cell.at(column, row), most); }};
  const report::Extent seam_extent = pictures.seam_extent();
  const PicturePart seam{seam_extent, size_in_frame(seam_extent, aspect, options.width, options.width),
                         whole.size.height + kPictureGap, [&](std::int64_t column, std::int64_t row) {
                           return share_of(relief.seam[static_cast<std::size_t>(row * seam_extent.width + column)],
                                           seam_most);
                         }};
  const report::Extent all{std::max(whole.size.width, seam.size.width), seam.top + seam.size.height};
  Canvas canvas(all);
  canvas.draw(whole, depth ? Ramp::depth : Ramp::fired);
  canvas.draw_with_seam(seam, depth ? Ramp::depth : Ramp::fired, rows);
  GRAVURE_CHECK(canvas.write(options.output));
  const char* unit = relief.in_um ? "um" : "pulses";
  if (command.json) {
    Json json = {{"picture", options.output},
                 {"width", all.width},
                 {"height", all.height},
                 {"layer", options.layer ? Json(*options.layer) : Json(nullptr)},
                 {"fires", polarity_name(header.fires)},
                 {"unrolled", place_json(whole)},
                 {"seam", place_json(seam)}};
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
                            "enlarged below; of a path, where pulses landed, and how high");
  const auto options = std::make_shared<PreviewArguments>();
  verb->add_option("PROGRAM", options->program, "Program file (.grv)")->required();
  verb->add_option("-o,--output", options->output, "PNG to write (.png)")->required();
  verb->add_option("--layer", options->layer, "Layer of the image stack, from 0; else all of them as depth")
      ->check(integer_from(0, kMostIndex));
  add_integer(*verb, "--width", options->width, "Of the picture in pixels", 64, 8'192);
  add_work_options(*verb, command);
  set_run(*verb, command, options, run_preview);
}

}  // namespace gravure::cli
