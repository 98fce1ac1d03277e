#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>

#include "gravure/emulator/fired_lines.hpp"
#include "gravure/formats/grv.hpp"
#include "gravure/formats/image_files.hpp"
#include "gravure/session/run.hpp"
#include "log.hpp"
#include "machine/open_device.hpp"
#include "program/program_files.hpp"
#include "verb.hpp"

namespace gravure::cli {
namespace {

using session::RunCounts;
using session::RunEnd;
using session::RunReport;

constexpr int kInterrupted = 4;

struct RunArguments {
  std::string program;
  std::string device;
  std::string journal;
  std::string record;
  std::string uncertain = "skip";
  session::RunOptions run;
};

/// Sent, accepted and executed on standard error: a bar on a terminal, else a line every ten seconds.
class RunProgress final : public session::RunObserver {
 public:
  RunProgress() : terminal_(::isatty(STDERR_FILENO) == 1) {}
  ~RunProgress() override { clear(); }
  RunProgress(const RunProgress&) = delete;
  RunProgress& operator=(const RunProgress&) = delete;

  void on_counts(const RunCounts& counts) override {
    const auto now = std::chrono::steady_clock::now();
    const auto least = terminal_ ? std::chrono::milliseconds(100) : std::chrono::milliseconds(10'000);
    if (counts.total <= 0 || now - shown_ < least || !is_logged(LogLevel::info)) {
      return;
    }
    shown_ = now;
    const double share = static_cast<double>(counts.executed) / static_cast<double>(counts.total);
    const std::string text = fmt::format("{:5.1f} %: {} sent, {} accepted, {} executed of {} lines", 100 * share,
                                         counts.sent, counts.accepted, counts.executed, counts.total);
    if (!terminal_) {
      log(LogLevel::info, text);
      return;
    }
    constexpr std::size_t kWidth = 24;
    const auto filled = static_cast<std::size_t>(share * static_cast<double>(kWidth));
    std::fprintf(stderr, "\r\033[Krun [%s%s] %s", std::string(filled, '#').c_str(),
                 std::string(kWidth - filled, '.').c_str(), text.c_str());
    drawn_ = true;
  }
  void on_note(const std::string& text) override {
    clear();
    log(LogLevel::info, text);
  }

 private:
  void clear() {
    if (drawn_) {
      std::fputs("\r\033[K", stderr);
      drawn_ = false;
    }
  }
  bool terminal_;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point shown_ = std::chrono::steady_clock::now();
};

/// That of the first 512 bytes, which hold checksums of all the others (docs/formats/grv.md).
Result<std::string> hash_of(const std::string& path) {
  std::string seal(512, '\0');
  std::ifstream file(path, std::ios::binary);
  if (!file.read(seal.data(), static_cast<std::streamsize>(seal.size()))) {
    return Error{ErrorCode::io, path + ": cannot be read"};
  }
  return sha256_text(seal);
}

const char* end_name(RunEnd end) {
  switch (end) {
    case RunEnd::finished:
      return "finished";
    case RunEnd::part_end:
      return "part_end";
    case RunEnd::stopped:
      return "stopped";
    case RunEnd::failed:
      return "failed";
  }
  return "";
}

Json place_json(const Plan& plan, const session::Place& place) {
  const std::int64_t lines = plan.rotary.lines_per_revolution;
  return {
      {"lines", place.line}, {"revolution", place.line / lines}, {"line", place.line % lines}, {"slots", place.slots}};
}

Json report_json(const RunArguments& options, const Plan& plan, const DeviceIdentity& device,
                 const session::Journal& journal, const RunReport& report) {
  Json json = {{"program", options.program},
               {"device", options.device},
               {"serial", device.serial},
               {"journal", journal.path()},
               {"exposure", journal.exposure()},
               {"state", end_name(report.end)},
               {"begun", place_json(plan, report.begun.place)},
               {"begun_why", report.begun.why}};
  if (report.begun.uncertain) {
    const session::Uncertain& lines = *report.begun.uncertain;
    json["uncertain"] = {{"from", place_json(plan, lines.from)},
                         {"to", place_json(plan, {lines.end_line, 0})},
                         {"policy", options.uncertain}};
  }
  json["lines"] = {{"total", report.counts.total},
                   {"sent", report.counts.sent},
                   {"accepted", report.counts.accepted},
                   {"executed", report.counts.executed},
                   {"skipped", count_lines(report.skipped)}};
  json["executed"] = place_json(plan, report.executed);
  json["exact"] = report.exact && report.skipped.empty();
  for (const session::Uncertain& lines : report.skipped) {
    json["skipped"].push_back({{"from", place_json(plan, lines.from)}, {"to", place_json(plan, {lines.end_line, 0})}});
  }
  if (!report.exact) {
    json["may_be_executed"] = place_json(plan, {report.sent_limit, 0});
  }
  json["fault"] = to_string(report.fault);
  json["fault_register"] = static_cast<int>(report.fault);
  json["drift_um"] = to_double(report.offset.axis_um);
  if (plan.carriage) {
    json["carriage"] = {{"start_mm", to_double(report.offset.carriage_start_mm)},
                        {"drift_um", to_double(report.offset.carriage_um)}};
  }
  json["frame_bytes"] = report.demand.frame_bytes;
  json["bits_per_s"] = to_double(report.demand.bits_per_s);
  json["link_bits_per_s"] = device.link_bits_per_s;
  json["reserve_bytes"] = report.reserve_bytes;
  if (!report.to_do.empty()) {
    json["to_do"] = report.to_do;
  }
  if (report.error) {
    json["error"] = {{"code", error_code_name(report.error->code)}, {"message", report.error->message}};
  }
  return json;
}

void print_report(const RunArguments& options, const Plan& plan, const DeviceIdentity& device,
                  const session::Journal& journal, const RunReport& report) {
  const RunCounts& counts = report.counts;
  print(fmt::format("{} on {} (serial {}): {}\n{} of {} lines executed, {} accepted, {} sent\n", options.program,
                    options.device, device.serial, end_name(report.end), counts.executed, counts.total, counts.accepted,
                    counts.sent));
  if (!report.skipped.empty()) {
    print(fmt::format("{} lines skipped, not known to be fired:", count_lines(report.skipped)));
    for (const session::Uncertain& lines : report.skipped) {
      print(fmt::format(" {} to {};", session::line_text(plan, lines.from.line),
                        session::line_text(plan, lines.end_line - 1)));
    }
    print(" look at the workpiece\n");
  }
  print(fmt::format("link: frames of {} bytes, {:.3f} Mbit/s used up, {} bytes ahead before the first line\n",
                    report.demand.frame_bytes, to_double(report.demand.bits_per_s) / 1e6, report.reserve_bytes));
  print(fmt::format("journal: {}\n", journal.path()));
  if (!report.to_do.empty()) {
    print(fmt::format("next: {}; then go on with --resume\n", report.to_do));
  }
}

Result<int> run_program(const RunArguments& options, const Command& command) {
  const CancelToken& cancel = cancel_token();
  const std::string journal_path = options.journal.empty() ? options.program + ".journal" : options.journal;
  GRAVURE_CHECK(refuse_overwrite({{"--journal", journal_path, Writes::journal}, {"--record", options.record}},
                                 inputs_of_program(options.program)));
  if (std::error_code ignored; options.run.resume.resume && !std::filesystem::exists(journal_path, ignored)) {
    return Error{ErrorCode::bad_argument,
                 fmt::format("--resume: there is no journal {}, so nothing was begun: leave out --resume, or give the "
                             "journal of the run with --journal",
                             journal_path)};
  }
  GRAVURE_TRY(const std::unique_ptr<LineSource> program, open_grv(options.program));
  GRAVURE_TRY(const std::string hash, hash_of(options.program));
  const Plan& plan = program->header().plan;
  const std::int64_t per_revolution = plan.rotary.lines_per_revolution;
  // First of all the device: a name that is wrong leaves no journal behind.
  GRAVURE_TRY(const OpenDevice device, open_device(options.device, options.record));
  GRAVURE_TRY(session::Journal journal, session::Journal::open(journal_path,
                                                               {.program = options.program,
                                                                .hash = hash,
                                                                .lines = plan.job.revolutions * per_revolution,
                                                                .lines_per_revolution = per_revolution,
                                                                .slots_per_line = plan.line.slots},
                                                               options.run.resume.resume));
  GRAVURE_CHECK(session::check_options(journal, options.run.resume));
  if (options.device.rfind("emulated:", 0) == 0) {  // for `gravure exposure`
    GRAVURE_CHECK(emulator::note_program(device.link->identity().place, std::filesystem::absolute(options.program)));
  }
  std::optional<RunReport> report;
  {
    RunProgress progress;
    GRAVURE_TRY(report, session::run_program(*program, *device.link, journal, options.run, progress, cancel));
  }
  if (device.recording != nullptr) {
    if (const auto written = device.recording->written(); !written) {
      warn(written.error().message);
    }
  }
  const DeviceIdentity& identity = device.link->identity();
  if (report->error) {
    log(LogLevel::error, report->error->message);
  }
  if (command.json) {
    print_json(report_json(options, plan, identity, journal, *report));
  } else {
    print_report(options, plan, identity, journal, *report);
  }
  if (report->error) {
    return exit_status(report->error->code);
  }
  if (report->end == RunEnd::part_end) {
    return kInterrupted;
  }
  return report->skipped.empty() ? kDone : kLimitViolated;  // not every line is known to be fired
}

}  // namespace

void add_run(CLI::App& app, Command& command) {
  CLI::App* verb = add_verb(app, command, "run", "Run a program on a board, or go on with it");
  const auto options = std::make_shared<RunArguments>();
  verb->add_option("PROGRAM", options->program, "Program file (.grv)")->required();
  verb->add_option("--record", options->record, "File to write what goes over the link into, for --device replay:FILE");
  verb->add_option("--device", options->device, std::string("The board: ") + kDeviceNames)->required();
  session::ResumeOptions& resume = options->run.resume;
  CLI::Option* going_on =
      verb->add_flag("--resume", resume.resume, "Go on at the first line and slot that was not executed");
  verb->add_flag("--again", resume.again, "Expose the workpiece once more, from the first line")->excludes(going_on);
  verb->add_flag("--other-device", resume.other_device, "Go on with another board than the job was begun with")
      ->needs(going_on);
  verb->add_option("--uncertain", options->uncertain,
                   "Lines of which nobody knows whether they were fired: skip (some may stay dark) or repeat (some may "
                   "be fired twice)")
      ->check(CLI::IsMember({"skip", "repeat"}))
      ->capture_default_str();
  verb->add_flag("--through", options->run.through, "Go on behind a band without waiting: the stage moves by itself");
  verb->add_option("--reserve-bytes", options->run.reserve_bytes,
                   "Bytes the board holds before lines run; without it half of its buffer, or the whole job")
      ->check(integer_from(1, std::uint64_t{1} << 40));
  verb->add_option("--journal", options->journal, "The journal; without it PROGRAM.journal");
  add_integer(*verb, "--memory", command.memory_mib, "Budget for what is read ahead in MiB", 1, std::uint64_t{1} << 20);
  verb->callback([&command, options] {
    options->run.resume.uncertain =
        options->uncertain == "skip" ? session::UncertainPolicy::skip : session::UncertainPolicy::repeat;
    options->run.memory_bytes = command.memory_bytes();
    if (options->device == "emulated") {
      options->device = "emulated:" + options->program + ".board";
    }
    command.run = [&command, options] { return run_program(*options, command); };
  });
}

}  // namespace gravure::cli
