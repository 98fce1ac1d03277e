#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <set>
#include <string_view>

#include "gravure/formats/grv.hpp"
#include "gravure/formats/image_files.hpp"
#include "gravure/formats/job_file.hpp"
#include "gravure/formats/plan_json.hpp"
#include "gravure/pipeline/window_reader.hpp"
#include "gravure/sync/make_plan.hpp"
#include "gravure/twin/unroll.hpp"
#include "gravure/twin/verify.hpp"
#include "job/job_loader.hpp"
#include "program/error_budget_text.hpp"
#include "program/path_program.hpp"
#include "program/program_files.hpp"
#include "program/program_verification.hpp"
#include "report/report_writer.hpp"
#include "texture/freeform_job.hpp"
#include "texture/freeform_program.hpp"
#include "verb.hpp"
#include "zones/zones_program.hpp"

namespace gravure::cli {
namespace {

namespace fs = std::filesystem;

struct VerifyArguments {
  std::string input;
  std::string images;
  std::string html;
  bool every_revolution = false;
};

/// Revolutions shown in the seam table: the first ones, then each about twice the one before, and the last; or all.
std::set<std::int64_t> shown_revolutions(std::int64_t revolutions, bool every) {
  std::set<std::int64_t> shown;
  for (std::int64_t r = 0; every && r < revolutions; ++r) {
    shown.insert(shown.end(), r);
  }
  for (const std::int64_t step : {1, 2, 5}) {
    for (std::int64_t at = step; at <= revolutions; at *= 10) {
      shown.insert(at - 1);
    }
  }
  shown.insert(revolutions - 1);
  return shown;
}

Json json_of(const CarriageReport& carriage) {
  return {{"ab_step_um", carriage.ab_step_um},
          {"max_error_um", carriage.error_max_um},
          {"worst", {{"revolution", carriage.worst_revolution}, {"line", carriage.worst_line}}},
          {"drift_um_per_revolution", carriage.drift_um_per_revolution},
          {"accumulated_um", carriage.seam_end_um},
          {"measured_end_um", carriage.seam_end_measured_um ? Json(*carriage.seam_end_measured_um) : Json(nullptr)}};
}

Json json_of(const VerifyReport& report, const ProgramHeader& header, bool every) {
  Json seam = Json::array();
  for (const std::int64_t r : shown_revolutions(report.revolutions, every)) {
    const SeamRow& row = report.seam[static_cast<std::size_t>(r)];
    seam.push_back({{"after_revolution", row.revolution},
                    {"drift_lines", json_ratio(row.drift_lines)},
                    {"drift_um", row.drift_um}});
  }
  Json wrong = nullptr;
  if (report.first_wrong_pixel) {
    wrong = {{"revolution", report.first_wrong_pixel->revolution},
             {"line", report.first_wrong_pixel->line},
             {"column", report.first_wrong_pixel->column}};
  }
  Json json = {{"within_limits", report.violations.empty()},
               {"violations", report.violations},
               {"notes", report.notes},
               {"revolutions", report.revolutions},
               {"lines", report.lines},
               {"ticks", json_integer(Integer(report.ticks))},
               {"fires", polarity_name(header.fires)},
               {"fired_pixels", json_integer(Integer(report.fired_pixels))},
               {"pixels", json_integer(Integer(report.pixels))},
               {"images_compared", report.images_compared},
               {"uncompared_lines", report.uncompared_lines},
               {"wrong_pixels", report.wrong_pixels},
               {"first_wrong_pixel", wrong},
               {"seam",
                {{"limit_um", report.seam_limit_um},
                 {"max_um", report.seam_max_um},
                 {"worst", {{"revolution", report.seam_worst_revolution}, {"line", report.seam_worst_line}}},
                 {"accumulated_um", report.seam_end_um},
                 {"measured_end_um", report.seam_end_measured_um ? Json(*report.seam_end_measured_um) : Json(nullptr)},
                 {"drift_um_per_revolution", to_double(header.plan.ab.drift_um_per_revolution)},
                 {"revolutions", seam}}},
               {"axis",
                {{"ab_step_um", report.ab_step_um},
                 {"max_error_um", report.axis_error_max_um},
                 {"worst", {{"revolution", report.axis_worst_revolution}, {"line", report.axis_worst_line}}}}}};
  if (report.carriage) {
    json["carriage"] = json_of(*report.carriage);
  }
  if (report.error) {
    json["error_um"] = error_budget_json(*report.error);
  }
  return json;
}

std::string text_of(const VerifyReport& report, const ProgramHeader& header, bool every) {
  std::string text =
      fmt::format("{} {}, {} lines, {} ticks emulated; {} fires: {} of {} pixels ({:.2f} %)\n", report.revolutions,
                  turns_name(header.plan), report.lines, report.ticks, polarity_name(header.fires), report.fired_pixels,
                  report.pixels, 100.0 * static_cast<double>(report.fired_pixels) / static_cast<double>(report.pixels));
  if (report.images_compared) {
    text += fmt::format("landed pixels that differ from the images: {}\n", report.wrong_pixels);
  }
  text += fmt::format("\n{:>16}  {:>12}  {:>10}\n", header.plan.mode == Mode::flat ? "after pass" : "after revolution",
                      "seam um", "limit um");
  for (const std::int64_t r : shown_revolutions(report.revolutions, every)) {
    text += fmt::format("{:>16}  {:>12.6g}  {:>10g}\n", r, report.seam[static_cast<std::size_t>(r)].drift_um,
                        report.seam_limit_um);
  }
  text += fmt::format("\nseam: worst {:.6g} um at revolution {}, line {}; accumulated {:+.6g} um\n", report.seam_max_um,
                      report.seam_worst_revolution, report.seam_worst_line, report.seam_end_um);
  text += fmt::format(
      "axis: one A-B edge is {:.6g} um; edges and ideal turning at most {:.6g} um apart (revolution {}, line {})\n",
      report.ab_step_um, report.axis_error_max_um, report.axis_worst_revolution, report.axis_worst_line);
  if (report.seam_end_measured_um) {
    text += fmt::format("axis after the last line, as the device counts its edges: {:+.6g} um\n",
                        *report.seam_end_measured_um);
  }
  if (report.carriage) {
    text += fmt::format(
        "carriage: one A-B edge is {:.6g} um; at most {:.6g} um off (revolution {}, line {}); accumulated {:+.6g} um\n",
        report.carriage->ab_step_um, report.carriage->error_max_um, report.carriage->worst_revolution,
        report.carriage->worst_line, report.carriage->seam_end_um);
  }
  if (report.error) {
    text += error_budget_text(*report.error);
  }
  for (const std::string& note : report.notes) {
    text += "note: " + note + "\n";
  }
  for (const std::string& violation : report.violations) {
    text += "violation: " + violation + "\n";
  }
  text += report.violations.empty() ? "within limits\n" : "NOT within limits\n";
  return text;
}

ReportRequest page_request(const std::string& path, const VerifyArguments& options) {
  ReportRequest request;
  request.program = path;
  request.name = fs::path(options.input).filename().string();
  request.output = options.html;
  return request;
}

/// The program may be one that was just made of the job that is verified: its sources are the job's.
Result<void> refuse_html(const std::string& path, const ProgramHeader& header, const VerifyArguments& options) {
  GRAVURE_CHECK(refuse_overwrite(options.html, {options.input}));
  return refuse_overwrite(options.html, inputs_of_program(path, header));
}

/// `--html`: written whatever the verdict.
Result<void> write_page(const std::string& path, VerifiedProgram verified, const VerifyArguments& options,
                        const Command& command) {
  GRAVURE_CHECK(write_report(page_request(path, options), std::move(verified), command));
  return {};
}

Result<int> verify_path(const GrvProgram& program, const std::string& path, const VerifyArguments& options,
                        const Command& command) {
  const std::unique_ptr<LineSource> lines = program.reader();
  if (options.html.empty()) {
    GRAVURE_TRY(const PathReport report, judge_path_file(*lines, path, options.images));
    return print_path_report(report, command);
  }
  GRAVURE_TRY(const WrittenPathReport written, write_path_report(page_request(path, options), *lines, options.images));
  return print_path_report(written.verified, command);
}

Result<int> verify_program(const std::string& path, const VerifyArguments& options, const Command& command) {
  GRAVURE_TRY(GrvProgram program, GrvProgram::open(path, command.memory_bytes()));
  if (!options.html.empty()) {
    GRAVURE_CHECK(refuse_html(path, program.header(), options));  // before minutes of emulation
  }
  if (program.header().plan.path) {
    return verify_path(program, path, options, command);
  }
  GRAVURE_TRY(VerifiedProgram verified, verify_program_file(std::move(program), path, options.images, command));
  const VerifyReport report = verified.report;
  const ProgramHeader& header = verified.program.header();
  const bool every = options.every_revolution;
  const std::string text = command.json ? "" : text_of(report, header, every);
  const Json json = command.json ? json_of(report, header, every) : Json();
  if (!options.html.empty()) {
    GRAVURE_CHECK(write_page(path, std::move(verified), options, command));
  }
  if (command.json) {
    print_json(json);
  } else {
    print(text);
  }
  return report.violations.empty() ? kDone : kLimitViolated;
}

/// By its name or, whatever its name, by its first bytes.
bool is_program(const std::string& path) {
  constexpr std::string_view kSignature = "gravure program\n";
  std::array<char, kSignature.size()> begin = {};
  std::error_code ignored;
  if (fs::is_regular_file(path, ignored)) {  // a pipe would wait for its writer
    std::ifstream(path, std::ios::binary).read(begin.data(), begin.size());
  }
  return fs::path(path).extension() == ".grv" || std::string_view(begin.data(), begin.size()) == kSignature;
}

/// Removes the program that a job was compiled to for verification.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::error_code failed;
    std::string name = (fs::temp_directory_path(failed) / "gravure-XXXXXX").string();
    if (!failed && ::mkdtemp(name.data()) != nullptr) {
      path_ = name;
    }
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder() {
    std::error_code ignored;
    if (!path_.empty()) {
      fs::remove_all(path_, ignored);
    }
  }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

Result<int> verify_job(const VerifyArguments& options, const Command& command) {
  cancel_token();  // before there is a folder: from here on Ctrl-C takes it away again
  const TemporaryFolder folder;
  if (folder.path().empty()) {
    return Error{ErrorCode::io, "cannot make a temporary folder: set TMPDIR to a folder with room for the program"};
  }
  const std::string path = folder.path() + "/job.grv";
  if (is_freeform_job(options.input)) {
    GRAVURE_TRY(const FreeformJob job, read_freeform_job(options.input));
    GRAVURE_TRY(const PlannedTexture planned, plan_texture(job, Depth::motion, with_texture_memory(command)));
    GRAVURE_CHECK(compile_texture(job, planned, path, {}));
    return verify_program(path, options, command);
  }
  if (mode_of_job(options.input) == Mode::zones) {
    GRAVURE_TRY(const LoadedZonesJob loaded, load_zones_job(options.input));
    GRAVURE_TRY(const ZonesProgram laid, lay_out_zones(loaded));
    GRAVURE_CHECK(compile_zones_program(loaded, laid, path));
    return verify_program(path, options, command);
  }
  const ImageFiles files;
  GRAVURE_TRY(const LoadedJob loaded, load_job(options.input, files, true));
  GRAVURE_CHECK(compile_job(loaded, files, {path, {}, {}, false}, command));
  warn_of(loaded);
  return verify_program(path, options, command);
}

}  // namespace

void add_verify(CLI::App& app, Command& command) {
  CLI::App* verb =
      add_verb(app, command, "verify", "Emulate a job or program, compare with its images, judge seam and landing");
  const auto options = std::make_shared<VerifyArguments>();
  verb->add_option("JOB|PROGRAM", options->input, "Job file (TOML) or program file (.grv)")->required();
  verb->add_option("--images", options->images, "Folder with the images, where they are not at the job's paths");
  verb->add_flag("--every-revolution", options->every_revolution, "List the seam after each revolution, not only some");
  verb->add_option("--html", options->html, "Also write the report page to this file");
  add_work_options(*verb, command);
  verb->callback([&command, options] {
    command.run = [&command, options] {
      return is_program(options->input) ? verify_program(options->input, *options, command)
                                        : verify_job(*options, command);
    };
  });
}

}  // namespace gravure::cli
