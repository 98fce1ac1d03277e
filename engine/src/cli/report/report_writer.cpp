#include "report/report_writer.hpp"

#include <algorithm>
#include <utility>

#include "gravure/core/units.hpp"
#include "gravure/formats/grv.hpp"
#include "gravure/formats/report_page.hpp"
#include "gravure/twin/unroll.hpp"
#include "program/program_files.hpp"
#include "text_output.hpp"
#include "texture/freeform_job.hpp"

namespace gravure::cli {

namespace {

/// What a page takes beside its pictures at the most: the depth of cells, its data as JSON, as text that grew, and in
/// the page. PNG does not shorten noise; of the seam a pixel is a bit.
std::int64_t page_bytes(const report::Extent& cells, const report::Extent& seam, std::int64_t shown_layers,
                        std::int64_t layers) {
  constexpr std::int64_t kCopies = 3;
  constexpr std::int64_t kLayer = 1536;  // an object of JSON
  const std::int64_t bytes = shown_layers * (cells.area() + seam.area() / 4) + 2 * (cells.area() + seam.area());
  return 8 * cells.area() + kLayer * layers + kCopies * (bytes * 4 / 3 + kMiB);  // in base64, and what every page has
}

}  // namespace

Result<void> check_drawable(const ProgramHeader& header, const std::string& path) {
  if (header.plan.path) {
    return Error{ErrorCode::bad_argument,
                 path + ": follows a path; revolutions and passes are drawn here: see gravure report"};
  }
  if (header.shard) {
    return Error{ErrorCode::bad_argument, path + ": is a part of a job: merge the parts first (gravure merge)"};
  }
  return {};
}

Result<WrittenReport> write_report(const ReportRequest& request, VerifiedProgram verified, const Command& command) {
  const ProgramHeader& header = verified.program.header();
  const std::unique_ptr<LineSource> program = verified.program.reader();
  GRAVURE_CHECK(check_drawable(header, request.name));
  report::ReportData data;
  data.generator = std::string("gravure ") + GRAVURE_VERSION;
  data.program = request.name;
  data.header = &header;
  WrittenReport written;
  written.line = request.line.value_or(0);
  if (!request.line) {
    GRAVURE_TRY(written.line, report::first_firing_line(*program, request.revolution, 0));
  }
  GRAVURE_TRY(data.line, report::line_view(*program, request.revolution, written.line));
  Result<report::LayerPictures> pictures = [&] {
    ProgressBar bar("layers");
    report::LayerPicturesOptions options;
    options.memory_bytes = command.memory_bytes();
    options.table_bytes = verified.program.table_bytes();
    options.later_bytes = [layers = image_layers(header)](const report::Extent& cells, const report::Extent& seam,
                                                          std::int64_t shown) {
      return page_bytes(cells, seam, shown, layers);
    };
    options.threads = command.threads;
    options.cancel = &cancel_token();
    options.progress = &bar;
    const auto programs = [&verified]() -> Result<std::unique_ptr<LineSource>> { return verified.program.reader(); };
    return report::layer_pictures(programs, emulated_devices(), options);
  }();
  GRAVURE_TRY(data.pictures, std::move(pictures));
  data.seam = report::seam_series(verified.report, header.plan);
  data.removal = report::pulse_removal(verified.job.laser);
  data.relief = report::relief_of(data.pictures, header.plan, data.removal);
  data.job = std::move(verified.job);
  data.verified = std::move(verified.report);
  GRAVURE_TRY(const std::string page, report_page(data));
  GRAVURE_CHECK(write_texts({{request.output, page}}));
  written.bytes = static_cast<std::int64_t>(page.size());
  written.shown_layers = std::count_if(data.pictures.layers.begin(), data.pictures.layers.end(),
                                       [](const report::LayerPicture& layer) { return !layer.shares.empty(); });
  written.view_3d = report_has_3d();
  return written;
}

Result<WrittenPathReport> write_path_report(const ReportRequest& request, LineSource& program,
                                            const std::string& folder) {
  constexpr std::size_t kStretches = 600;
  report::PathReportData data;
  data.generator = std::string("gravure ") + GRAVURE_VERSION;
  data.program = request.name;
  data.header = &program.header();
  const auto landed = [&data](const LandedPulse& pulse) -> Result<void> {
    const kinematics::Vector3& at = pulse.spot.position_mm;
    data.map.take(at.x(), at.y(), at.z());
    data.sample.take({at.x(), at.y(), at.z()});
    return {};
  };
  GRAVURE_TRY(data.verified, judge_path_file(program, request.program, folder, landed));
  GRAVURE_TRY(data.traces, report::path_traces(program, kStretches, &cancel_token()));
  GRAVURE_TRY(const std::int64_t period, report::first_firing_line(program, 0, 0));
  GRAVURE_TRY(data.period, report::line_view(program, 0, period));
  GRAVURE_TRY(const std::string page, path_report_page(data));
  GRAVURE_CHECK(write_texts({{request.output, page}}));
  return WrittenPathReport{std::move(data.verified), static_cast<std::int64_t>(page.size())};
}

}  // namespace gravure::cli
