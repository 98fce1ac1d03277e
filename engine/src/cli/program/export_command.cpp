#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <utility>

#include "folder_output.hpp"
#include "gravure/scan/xy2_100.hpp"
#include "motion/motion_options.hpp"
#include "program/export_path.hpp"
#include "program/program_files.hpp"
#include "program/program_trajectory.hpp"
#include "text_output.hpp"
#include "verb.hpp"

namespace gravure::cli {
namespace {

namespace fs = std::filesystem;

struct ExportArguments {
  std::string program;
  std::string folder;
  int form = 0;                  ///< 0: the smallest that carries the resolution
  std::int64_t revolution = -1;  ///< helical mode: which one
  std::string nc_folder;         ///< programs that follow a path
  double block_ms = 5;
};

/// What is written, file by file.
struct StreamFile {
  std::string name;
  std::uint64_t frames = 0;
};

Result<scan::FrameForm> form_of(const ExportArguments& options, int resolution_bits) {
  return scan::frame_form_for(options.form != 0 ? options.form : resolution_bits);
}

std::string name_of(const LineSetPoints& line, bool flat) {
  const std::string direction = direction_name(line.reverse);
  return flat ? direction + (line.backwards ? "_backwards.gxy2" : "_onwards.gxy2") : direction + ".gxy2";
}

/// Rotary and flat: each way that lines run, once.
Result<std::vector<StreamFile>> write_kinds(const ProgramHeader& header, scan::FrameForm form,
                                            const FolderOutput& folder) {
  std::vector<StreamFile> files;
  const bool flat = header.plan.mode == Mode::flat;
  for (const LineSetPoints& line : header.set_points) {
    GRAVURE_CHECK(check_not_stopped());
    std::vector<scan::SetPoint> points;
    for (std::size_t k = 0; k < line.u_counts.size(); ++k) {
      points.push_back({0, 0, line.u_counts[k], line.v_counts[k]});
    }
    scan::FrameStream stream{form, {}};
    GRAVURE_TRY(stream.frames, scan::frames_of(points, header.plan.scanner->resolution_bits, form));
    files.push_back({name_of(line, flat), stream.frames.size()});
    GRAVURE_CHECK(write_file(folder.file(files.back().name).string(), scan::encode_stream(stream)));
  }
  return files;
}

/// Helical: the lines of a revolution, one after the other, for each starts at another fraction of a column.
Result<std::vector<StreamFile>> write_revolution(const scan::JobTrajectory& trajectory, std::int64_t revolution,
                                                 scan::FrameForm form, const FolderOutput& folder) {
  const Plan& plan = trajectory.plan();
  const std::int64_t lines = plan.rotary.lines_per_revolution;
  const StreamFile file{fmt::format("revolution_{}.gxy2", revolution),
                        static_cast<std::uint64_t>(lines) * trajectory.of_revolution(revolution).forward.size()};
  GRAVURE_TRY(TextOutput output, TextOutput::create(folder.file(file.name).string()));
  output.text() += scan::encode_stream_start(form, file.frames);
  ProgressBar bar("export");
  for (std::int64_t line = 0; line < lines; ++line) {
    GRAVURE_TRY(const std::vector<scan::SetPoint> points, trajectory.set_points({revolution, line}));
    const auto frames = scan::frames_of(points, plan.scanner->resolution_bits, form);
    if (!frames) {
      return Error{frames.error().code, fmt::format("line {}: {}", line, frames.error().message)};
    }
    scan::append_frames(form, frames.value(), output.text());
    output.flush(false);
    bar.update(line + 1, lines);
    GRAVURE_CHECK(check_not_stopped());
  }
  GRAVURE_CHECK(output.commit());
  return std::vector<StreamFile>{file};
}

Result<void> check_revolution(const ExportArguments& options, const Plan& plan) {
  if (!plan.carriage) {
    return options.revolution < 0
               ? Result<void>()
               : Error{ErrorCode::bad_argument,
                       "--revolution: only lines of helical jobs differ from each other; leave it out"};
  }
  if (options.revolution < 0) {
    return Error{ErrorCode::bad_argument,
                 "--revolution is missing: the lines of a helical job start at different fractions of a column, so a "
                 "revolution is exported at a time"};
  }
  return check_index("--revolution", options.revolution, plan.job.revolutions);
}

Result<int> run_export(const ExportArguments& options, const Command& command) {
  if (!options.nc_folder.empty()) {
    return export_path(options.program, options.nc_folder, options.block_ms, command);
  }
  GRAVURE_TRY(const ProgramTrajectory opened, open_trajectory(options.program));
  const ProgramHeader& header = opened.program->header();
  const Plan& plan = header.plan;
  GRAVURE_CHECK(check_revolution(options, plan));
  if (header.set_points.empty()) {
    return Error{ErrorCode::bad_argument, options.program + ": stores no set-points: compile the job again"};
  }
  GRAVURE_TRY(const scan::FrameForm form, form_of(options, plan.scanner->resolution_bits));
  const Rational rate_hz = scan::frame_rate_hz(scan::line_timing(plan));
  if (rate_hz > Rational(100'000)) {
    warn(
        fmt::format("set-points come at {:.6g} Hz: XY2-100 and XY3-100 carry 100000 frames a second; take more "
                    "scanner.slots_per_microvector",
                    to_double(rate_hz)));
  }
  cancel_token();  // before there is a folder
  GRAVURE_TRY(FolderOutput folder, FolderOutput::create(options.folder));
  std::vector<StreamFile> files;
  GRAVURE_TRY(files, plan.carriage ? write_revolution(opened.trajectory, options.revolution, form, folder)
                                   : write_kinds(header, form, folder));
  GRAVURE_CHECK(folder.commit());
  if (command.json) {
    Json list = Json::array();
    for (const StreamFile& file : files) {
      list.push_back({{"file", (fs::path(options.folder) / file.name).string()}, {"frames", file.frames}});
    }
    print_json({{"position_bits", scan::position_bits(form)},
                {"frame_bits", scan::frame_bits(form)},
                {"frame_rate_hz", to_double(rate_hz)},
                {"files", list}});
    return kDone;
  }
  for (const StreamFile& file : files) {
    print(fmt::format("{}: {} frames of {} bits with {}-bit positions, {:.8g} a second\n",
                      (fs::path(options.folder) / file.name).string(), file.frames, scan::frame_bits(form),
                      scan::position_bits(form), to_double(rate_hz)));
  }
  return kDone;
}

}  // namespace

void add_export(CLI::App& app, Command& command) {
  CLI::App* verb = add_verb(app, command, "export",
                            "Set-points for other controls: frames for digital scan heads (rotary and flat jobs, each "
                            "way that lines run once; helical jobs, the lines of one revolution in order), or NC "
                            "programs where all axes follow a path");
  const auto options = std::make_shared<ExportArguments>();
  verb->add_option("PROGRAM", options->program, "Program file (.grv)")->required();
  CLI::Option* frames = verb->add_option("--xy2-100", options->folder,
                                         "Folder, new or empty, for frame files: forward.gxy2, reverse.gxy2; "
                                         "flat: also _onwards, _backwards; helical: revolution_R.gxy2");
  CLI::Option* nc = verb->add_option("--nc", options->nc_folder,
                                     "Programs that follow a path: folder, new or empty, for stages.ngc (G-code), "
                                     "stages.pvt (PMAC), galvo.gxy2 (frames) and axes.csv (all axes)")
                        ->excludes(frames);
  verb->add_option("--block-ms", options->block_ms, "Length of a block of the NC programs")
      ->needs(nc)
      ->check(number_from(0.001, 10'000))
      ->capture_default_str();
  verb->add_option("--form", options->form,
                   "Position bits: 16 (XY2-100), 18 (XY2-100 Enhanced) or 20 (XY3-100); default: the fewest that carry "
                   "scanner.resolution_bits")
      ->check(CLI::IsMember({"16", "18", "20"}));
  verb->add_option("--revolution", options->revolution, "Helical jobs: which revolution, from 0")
      ->check(integer_from(0, kMostIndex));
  verb->callback([&command, options] {
    if (options->folder.empty() && options->nc_folder.empty()) {
      throw CLI::RequiredError("--xy2-100 or --nc");
    }
    command.run = [&command, options] { return run_export(*options, command); };
  });
}

}  // namespace gravure::cli
