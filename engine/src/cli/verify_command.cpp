#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <set>
#include <string_view>

#include "error_budget_text.hpp"
#include "gravure/formats/grv.hpp"
#include "gravure/formats/image_files.hpp"
#include "gravure/formats/job_file.hpp"
#include "gravure/formats/plan_json.hpp"
#include "gravure/pipeline/window_reader.hpp"
#include "gravure/sync/make_plan.hpp"
#include "gravure/twin/unroll.hpp"
#include "gravure/twin/verify.hpp"
#include "job_loader.hpp"
#include "path_program.hpp"
#include "program_files.hpp"
#include "verb.hpp"

namespace gravure::cli {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::string input;
  std::string images;
  bool every_revolution = false;
};

/// The first revolution that does not expose the layer its job asks for.
std::optional<std::int64_t> wrong_layer(const ProgramHeader& header, LayerOrder order) {
  StoredLayers stored(header.plan, order, image_layers(header));
  for (std::int64_t r = 0; r < header.plan.job.revolutions; ++r) {
    if (stored.number(r) != header.layer_of_revolution[static_cast<std::size_t>(r)]) {
      return r;
    }
  }
  return std::nullopt;
}

/// What a job names other files for stands in the program as it was compiled: the head of a machine file, a field grid.
Job with_files_of(const Plan& plan, Job job) {
  if (!plan.scanner) {
    return job;
  }
  const ScannerPlan& compiled = *plan.scanner;
  if (job.machine.file) {
    job.scanner.field_mm = compiled.field_mm;
    job.scanner.resolution_bits = compiled.resolution_bits;
    job.scanner.lag_us = compiled.lag_us;
    job.scanner.max_speed_mm_s = compiled.max_speed_mm_s;
    job.scanner.max_acceleration_mm_s2 = compiled.max_acceleration_mm_s2;
    job.scanner.max_jerk_mm_s3 = compiled.max_jerk_mm_s3;
    job.scanner.tilt_deg_per_mm = compiled.tilt_deg_per_mm;
  }
  if (job.scanner.field_grid) {
    job.scanner.field_grid_text = compiled.field_grid;
  }
  return job;
}

/// Ramps that a job asks for by its machine file.
void keep_ramps(const Plan& plan, Plan& again) {
  if (!again.spin) {
    again.spin = plan.spin;
  }
  if (again.carriage && plan.carriage && !again.carriage->spin) {
    again.carriage->spin = plan.carriage->spin;
  }
}

/// The job text in a program must lead to the very plan, and the order of layers, that stand in it.
Result<std::optional<std::string>> plan_contradiction(const ProgramHeader& header, const Job& job) {
  const std::int64_t exposures =
      header.plan.carriage ? header.plan.carriage->layers : revolutions_per_band(header.plan);
  GRAVURE_TRY(Plan again, make_plan(with_files_of(header.plan, job), image_columns(header.plan), exposures));
  again.warnings = header.plan.warnings;  // those about images are not made here
  if (job.machine.file) {                 // the limits of the axes stand there, and the program keeps the ramps alone
    keep_ramps(header.plan, again);
  }
  if (plan_to_json(again) == plan_to_json(header.plan)) {
    const std::optional<std::int64_t> wrong = wrong_layer(header, job.image.order);
    return wrong ? std::optional(
                       fmt::format("revolution {} exposes another layer than its job asks for: compile again", *wrong))
                 : std::nullopt;
  }
  return std::optional<std::string>(
      fmt::format("the program's plan is not the one its job leads to: increment {} every {} ticks in the program, {} "
                  "every {} by the job: compile again",
                  header.plan.ab.increment, header.plan.ab.prescaler, again.ab.increment, again.ab.prescaler));
}

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

/// Says of differing images whether the files are the ones that were compiled.
void note_changed_sources(const ProgramHeader& header, const std::vector<std::string>& paths, VerifyReport& report) {
  std::set<std::string> seen;
  for (std::size_t source = 0; source < header.sources.size(); ++source) {
    if (!seen.insert(paths[source]).second) {
      continue;
    }
    const Result<std::string> now = sha256_file(paths[source]);
    if (now && now.value() != header.sources[source].sha256) {  // one that is not there is a violation of its own
      report.notes.push_back(paths[source] + " is not the file that was compiled (other SHA-256)");
    }
  }
}

Result<int> verify_program(const std::string& path, const Options& options, const Command& command) {
  GRAVURE_TRY(const std::unique_ptr<LineSource> program, open_grv(path));
  const ProgramHeader& header = program->header();
  if (header.plan.path) {
    return verify_path_program(*program, {}, command);
  }
  const ImageFiles files;
  GRAVURE_TRY(const FoundImages found, find_images(header, path, options.images, files));
  GRAVURE_TRY(const Job job, parse_job(header.job_text, header.job_path));
  GRAVURE_TRY(const std::optional<std::string> contradiction, plan_contradiction(header, job));
  LayerLinesFactory readers;
  const std::int64_t panel = command.memory_bytes() / 4;
  if (found.stack) {
    readers = [&]() -> Result<std::unique_ptr<LayerLines>> {
      return make_layer_lines(header, *found.stack, files, panel);
    };
  }
  Result<VerifyReport> verified = [&] {
    ProgressBar bar("verify");
    VerifyOptions verify_options;
    verify_options.memory_bytes = command.memory_bytes();
    verify_options.threads = command.threads;
    verify_options.cancel = &cancel_token();
    verify_options.progress = &bar;
    verify_options.budget = BudgetOptions{job.twin, job.limits.landing_um, job.limits.defocus_um};
    return verify([&path] { return open_grv(path); }, emulated_devices(), readers, verify_options);
  }();
  GRAVURE_TRY(VerifyReport report, std::move(verified));
  if (contradiction) {
    report.violations.push_back(*contradiction);
  }
  for (const std::string& missing : found.stack ? std::vector<std::string>() : found.missing) {
    report.notes.push_back("image not found: " + missing);
  }
  if (found.stack && (report.wrong_pixels > 0 || report.uncompared_lines > 0)) {
    note_changed_sources(header, found.paths, report);
  }
  if (report.ab_step_um > report.seam_limit_um) {
    report.notes.push_back(
        fmt::format("one A-B edge ({:.3f} um) is coarser than limits.seam_um: within an edge the "
                    "drive's own interpolation decides",
                    report.ab_step_um));
  }
  if (command.json) {
    print_json(json_of(report, header, options.every_revolution));
  } else {
    print(text_of(report, header, options.every_revolution));
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

Result<int> verify_job(const Options& options, const Command& command) {
  cancel_token();  // before there is a folder: from here on Ctrl-C takes it away again
  const TemporaryFolder folder;
  if (folder.path().empty()) {
    return Error{ErrorCode::io, "cannot make a temporary folder: set TMPDIR to a folder with room for the program"};
  }
  const std::string path = folder.path() + "/job.grv";
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
  const auto options = std::make_shared<Options>();
  verb->add_option("JOB|PROGRAM", options->input, "Job file (TOML) or program file (.grv)")->required();
  verb->add_option("--images", options->images, "Folder with the images, where they are not at the job's paths");
  verb->add_flag("--every-revolution", options->every_revolution, "List the seam after each revolution, not only some");
  add_work_options(*verb, command);
  verb->callback([&command, options] {
    command.run = [&command, options] {
      return is_program(options->input) ? verify_program(options->input, *options, command)
                                        : verify_job(*options, command);
    };
  });
}

}  // namespace gravure::cli
