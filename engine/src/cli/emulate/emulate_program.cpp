#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>

#include "emulate/emulate.hpp"
#include "emulate/emulate_rtl.hpp"
#include "emulate/emulate_runs.hpp"
#include "gravure/core/spin_phase.hpp"
#include "gravure/emulator/board_host.hpp"
#include "gravure/emulator/emulated_device.hpp"
#include "gravure/emulator/faults.hpp"
#include "gravure/emulator/machine_waves.hpp"
#include "gravure/formats/grv.hpp"
#include "gravure/raster/count.hpp"
#include "program/program_files.hpp"
#include "text_output.hpp"

namespace gravure::cli {
namespace {

using emulator::DarkLines;
using emulator::FaultyHost;
using emulator::MachineWaves;
using emulator::PlannedFault;

fpga::AbRegisters registers_of(const AbPlan& ab) {
  return {ab.counter_bits, ab.prescaler, ab.increment, ab.fraction_num, ab.fraction_den};
}

/// The signals of the machine into a file.
class WaveFile final : public emulator::WaveSink {
 public:
  static Result<std::unique_ptr<WaveFile>> create(const std::string& path, const formats::VcdTime& time) {
    GRAVURE_TRY(formats::WaveDump dump, formats::WaveDump::make(time, "machine",
                                                                {{.name = "a"},
                                                                 {.name = "b"},
                                                                 {.name = "gate"},
                                                                 {.name = "line_start"},
                                                                 {.name = "scanner_clock"},
                                                                 {.name = "revolution", .bits = 32},
                                                                 {.name = "line", .bits = 32}}));
    GRAVURE_TRY(TextOutput output, TextOutput::create(path));
    return std::make_unique<WaveFile>(std::move(dump), std::move(output));
  }
  WaveFile(formats::WaveDump dump, TextOutput output) : dump_(std::move(dump)), output_(std::move(output)) {}

  bool begin(std::uint64_t first, const emulator::SignalValues& values) override {
    return keep(dump_.begin(output_.text(), first, values));
  }
  bool change(std::uint64_t tick, emulator::Signal signal, std::uint64_t value) override {
    return keep(dump_.change(output_.text(), tick, static_cast<std::size_t>(signal), value));
  }
  const Result<void>& written() const { return written_; }
  /// The file, written but not in its place.
  Result<TextOutput> end(std::uint64_t last) {
    GRAVURE_CHECK(written_);
    GRAVURE_CHECK(dump_.end(output_.text(), last));
    return std::move(output_);
  }

 private:
  bool keep(Result<void> result) {
    if (written_) {
      written_ = std::move(result);
    }
    return written_ && output_.flush(false) && !cancel_token().cancelled();
  }
  formats::WaveDump dump_;
  TextOutput output_;
  Result<void> written_;
};

/// Counts what the pins show, and passes it on.
class PinCounter final : public PinObserver {
 public:
  explicit PinCounter(MachineWaves* waves) : waves_(waves) {}
  void on_line(const ExecutedLine& line) override {
    fired_ += raster::popcount(line.fired);
    if (waves_ != nullptr) {
      waves_->on_line(line);
    }
  }
  std::int64_t fired() const { return fired_; }

 private:
  MachineWaves* waves_;
  std::int64_t fired_ = 0;
};

/// Lines counted over the whole job, both included.
struct Lines {
  std::int64_t first = 0;
  std::int64_t last = 0;
};

/// Lets through the frames of some lines alone.
class SomeLines final : public LineDevice {
 public:
  SomeLines(LineDevice& link, Lines lines, std::int64_t lines_per_revolution)
      : link_(link), lines_(lines), lines_per_revolution_(lines_per_revolution) {}
  Result<void> configure(const DeviceSetup& setup) override { return link_.configure(setup); }
  Result<void> send(const LineFrame& frame) override {
    const std::int64_t ordinal = frame.revolution * lines_per_revolution_ + frame.line;
    return ordinal < lines_.first || ordinal > lines_.last ? Result<void>() : link_.send(frame);
  }
  DeviceStatus status() const override { return link_.status(); }

 private:
  LineDevice& link_;
  Lines lines_;
  std::int64_t lines_per_revolution_;
};

struct Mistakes {
  std::vector<PlannedFault> faults;
  std::vector<std::int64_t> acknowledgements;
};

Result<Mistakes> mistakes_of(const EmulateOptions& options, const DeviceSetup& setup) {
  const auto named = [](const char* option, Error error) {
    error.message = std::string(option) + " " + error.message;
    return error;
  };
  Mistakes mistakes;
  for (const std::string& text : options.faults) {
    const Result<PlannedFault> fault = emulator::parse_fault(text, setup);
    if (!fault) {
      return named("--fault", fault.error());
    }
    mistakes.faults.push_back(fault.value());
  }
  for (const std::string& text : options.acknowledgements) {
    const Result<std::int64_t> place = emulator::parse_line_place(text, setup);
    if (!place) {
      return named("--acknowledge", place.error());
    }
    mistakes.acknowledgements.push_back(place.value());
  }
  return mistakes;
}

/// Refuses what was planned for lines after the last one that is run.
Result<void> check_run(const Mistakes& mistakes, std::int64_t last_line) {
  const auto check = [last_line](const char* option, std::int64_t ordinal) {
    return ordinal <= last_line
               ? Result<void>()
               : Error{ErrorCode::out_of_range,
                       fmt::format("{} line {} (over the whole job): the window ends with line {}, so it is never run; "
                                   "give a line up to it, or a later --to",
                                   option, ordinal, last_line)};
  };
  for (const PlannedFault& fault : mistakes.faults) {
    GRAVURE_CHECK(check("--fault", fault.ordinal));
  }
  for (const std::int64_t ordinal : mistakes.acknowledgements) {
    GRAVURE_CHECK(check("--acknowledge", ordinal));
  }
  return {};
}

/// Before the first line of a run; false: the board takes no more.
using RunStart = std::function<Result<bool>(const DeviceSetup& setup)>;

/// The lines a window touches, and those from the first fault on, which may reach into it.
Lines lines_of(const Plan& plan, TickWindow window, const Mistakes& mistakes) {
  const std::int64_t most = plan.job.revolutions * plan.rotary.lines_per_revolution - 1;
  const auto line_at = [&](std::uint64_t tick) {
    return std::min(static_cast<std::int64_t>(tick) / plan.line.ticks, most);
  };
  Lines lines{line_at(window.first), line_at(window.last)};
  for (const PlannedFault& fault : mistakes.faults) {
    lines.first = std::min(lines.first, fault.ordinal);
  }
  return lines;
}

/// Runs the lines, with `start` before the first of each run of the board. A fault that stands at the end of a run
/// keeps the next from starting.
Result<void> send_lines(LineSource& program, Lines lines, LineDevice& device, const RunStart& start) {
  const ProgramHeader& header = program.header();
  const std::int64_t per_revolution = header.plan.rotary.lines_per_revolution;
  SomeLines some(device, lines, per_revolution);
  ProgramChunk chunk;
  ProgressBar bar("emulate");
  const std::int64_t first_revolution = lines.first / per_revolution;
  const std::int64_t last_revolution = lines.last / per_revolution;
  for (std::int64_t r = first_revolution; r <= last_revolution; ++r) {
    const std::int64_t layer = header.layer_of_revolution[static_cast<std::size_t>(r)];
    const std::int64_t first = r == first_revolution ? lines.first % per_revolution : 0;
    const std::int64_t last = r == last_revolution ? lines.last % per_revolution : per_revolution - 1;
    if (r == first_revolution || run_with(header.plan, r).first_revolution == r) {
      GRAVURE_TRY(const bool started, start(device_setup(header.plan, r, first)));
      if (!started) {
        break;
      }
    }
    for (std::int64_t k = first / program.lines_per_chunk(); k <= last / program.lines_per_chunk(); ++k) {
      if (cancel_token().cancelled()) {
        return Error{ErrorCode::cancelled, "stopped before the end of the program"};
      }
      GRAVURE_CHECK(chunk.load(program, {layer, k}));
      GRAVURE_CHECK(chunk.send(header, r, some));
    }
    bar.update(r + 1 - first_revolution, last_revolution + 1 - first_revolution);
  }
  return {};
}

std::string place_text(std::int64_t ordinal, const Plan& plan) {
  const std::int64_t per_revolution = plan.rotary.lines_per_revolution;
  return fmt::format("revolution {}, line {}", ordinal / per_revolution, ordinal % per_revolution);
}

Json dark_json(const std::vector<DarkLines>& dark, const Plan& plan) {
  const std::int64_t per_revolution = plan.rotary.lines_per_revolution;
  Json list = Json::array();
  for (const DarkLines& lines : dark) {
    list.push_back({{"fault", to_string(lines.fault)},
                    {"fault_register", static_cast<int>(lines.fault)},
                    {"tick", json_integer(Integer(lines.tick))},
                    {"first_line", lines.first},
                    {"last_line", lines.last},
                    {"lines", lines.last - lines.first + 1},
                    {"from", {{"revolution", lines.first / per_revolution}, {"line", lines.first % per_revolution}}},
                    {"to", {{"revolution", lines.last / per_revolution}, {"line", lines.last % per_revolution}}},
                    {"detail", lines.detail}});
  }
  return list;
}

/// A-B edges of the axis per workpiece revolution divide its exact way in the runs up to a tick, without ramps: whole
/// turns and what is left.
Rational turns_after(const Plan& plan, std::int64_t tick) {
  const auto turns = [&plan](std::int64_t ticks) {
    const SpinPhase at = phase_after(plan.ab, plan.ab.increment, ticks, {});
    const Rational exact =
        Rational(at.counts) + Rational(Integer(at.accumulator)) / Rational(Integer(plan.ab.fraction_den));
    return Rational(exact / Rational(Integer(1) << static_cast<unsigned>(plan.ab.counter_bits - 2)) /
                    plan.rotary.edges_per_revolution);
  };
  const std::int64_t run_ticks = run_with(plan, 0).ticks;
  return turns(run_ticks) * (tick / run_ticks) + turns(tick % run_ticks);
}

/// The frames of some lines through the wires of a board.
class WireLink final : public LineDevice {
 public:
  explicit WireLink(emulator::BoardHost& host) : host_(host) {}
  Result<void> configure(const DeviceSetup&) override { return {}; }
  Result<void> send(const LineFrame& frame) override { return host_.send(frame); }
  DeviceStatus status() const override { return {}; }

 private:
  emulator::BoardHost& host_;
};

/// The same lines on the Verilog board and on its model; `fired` slots must come through the gate.
Result<Json> lines_on_rtl(LineSource& program, Lines lines, const DeviceSetup& setup, std::int64_t fired) {
  GRAVURE_TRY(TwoBoards boards, TwoBoards::load());
  emulator::BoardHost host(
      emulator::kRtlFifoBits,
      [&boards](const fpga::Synchro::Inputs& inputs, std::uint64_t clocks) { return boards.hold(inputs, clocks); });
  const LinePlan& line = program.header().plan.line;
  GRAVURE_CHECK(host.start_lines(setup, {.slots_per_microvector = line.slots_per_microvector,
                                         .backward_later_ticks = line.offset_remainder_ticks}));
  WireLink link(host);
  GRAVURE_CHECK(send_lines(program, lines, link, [](const DeviceSetup&) -> Result<bool> { return true; }));
  GRAVURE_CHECK(host.finish());
  GRAVURE_CHECK(boards.check());
  if (boards.fault() != 0) {
    return Error{ErrorCode::device, fmt::format("Verilog and model stopped with fault {} ({})", boards.fault(),
                                                to_string(static_cast<DeviceFault>(boards.fault())))};
  }
  GRAVURE_CHECK(host.close());
  GRAVURE_CHECK(boards.check());
  const auto expected = static_cast<std::uint64_t>(fired * setup.ticks_per_slot);
  if (boards.gate_clocks() != expected) {
    return Error{ErrorCode::device,
                 fmt::format("the gate of the Verilog was open for {} clocks, that of the lines is {}",
                             boards.gate_clocks(), expected)};
  }
  return boards.counts();
}

struct Run {
  TickWindow window;
  Lines lines;
  DeviceStatus status;  ///< of the last run
  std::int64_t executed = 0;
  std::vector<EmulatedRun> runs;
  std::int64_t fired = 0;
  std::vector<DarkLines> dark;
  std::optional<Json> rtl;
};

/// What the schedule of a channel put out before tick 0.
Json spin_up_json(const SpinPlan& up, const AxisState& state) {
  Json segments = Json::array();
  for (const SpinSegment& segment : up.segments) {
    segments.push_back({{"increment", json_integer(Integer(segment.increment))}, {"seeds", segment.seeds}});
  }
  return {{"segments", segments},
          {"ticks", json_integer(Integer(up.ticks))},
          {"edges", json_integer(Integer(state.edges))},
          {"planned_counts", json_integer(up.counts)},
          {"counts", json_integer(counts_of(state))}};
}

std::string spin_up_text(const char* name, const SpinPlan& up, const AxisState& state) {
  std::string text = fmt::format("{}: spun up by {} segments in {} ticks, {} A-B edges before line 0\n", name,
                                 up.segments.size(), up.ticks, state.edges);
  for (const SpinSegment& segment : up.segments) {
    text += fmt::format("  increment {:>10} for {:>10} seed clocks\n", segment.increment, segment.seeds);
  }
  return text;
}

void print_run(const EmulateOptions& options, const Command& command, const Plan& plan, const Run& run) {
  const DeviceStatus& status = run.status;
  const Rational turns = turns_after(plan, status.tick);
  const Integer edges = edges_to_tick(plan, status.tick);
  std::int64_t dark_lines = 0;
  for (const DarkLines& lines : run.dark) {
    dark_lines += lines.last - lines.first + 1;
  }
  if (command.json) {
    Json axis = run_axis_json(plan, run.runs.back());
    axis[plan.mode == Mode::flat ? "passes" : "workpiece_turns"] = json_ratio(turns);
    Json result = {{"program", options.program},
                   {"lines", run.executed},
                   {"ticks", json_integer(Integer(status.tick))},
                   {"planned_ticks", json_integer(Integer(plan.job.ticks))},
                   {"fired_slots", json_integer(Integer(run.fired))},
                   {"edges", json_integer(edges)},
                   {"axis", axis},
                   {"runs", runs_json(plan, run.runs)}};
    if (plan.carriage) {
      result["carriage"] = axis_json(registers_of(plan.carriage->ab), static_cast<std::uint64_t>(status.tick));
    }
    if (plan.spin) {
      result["spin_up"] = spin_up_json(plan.spin->up, run.runs.front().status.axis_spun_up);
    }
    if (plan.carriage && plan.carriage->spin) {
      result["carriage_spin_up"] = spin_up_json(plan.carriage->spin->up, run.runs.front().status.carriage_spun_up);
    }
    result.update({{"fault", to_string(status.fault)},
                   {"fault_register", static_cast<int>(status.fault)},
                   {"dark_lines", dark_lines},
                   {"dark", dark_json(run.dark, plan)}});
    if (options.from || options.to) {
      result["window"] = {{"from", json_integer(Integer(run.window.first))},
                          {"to", json_integer(Integer(run.window.last))},
                          {"first_line", run.lines.first},
                          {"last_line", run.lines.last}};
    }
    if (run.rtl) {
      result["rtl"] = *run.rtl;
    }
    print_json(result);
    return;
  }
  std::string text =
      fmt::format("{} lines in {} ticks (planned {}), {} slots fired, {} A-B edges, fault: {}\n", run.executed,
                  status.tick, plan.job.ticks, run.fired, to_string(edges), to_string(status.fault));
  if (options.from || options.to) {
    text += fmt::format("window: ticks {} to {}; only lines {} to {} were run, counted over the job\n",
                        run.window.first, run.window.last, run.lines.first, run.lines.last);
  }
  text +=
      fmt::format("axis: {:.9f} {} at tick {}, exactly {}\n", to_double(turns),
                  plan.mode == Mode::flat ? "passes of the stage" : "turns of the workpiece", status.tick, turns.str());
  if (plan.carriage) {
    text += fmt::format("carriage: {} A-B edges of the second channel\n", status.carriage.edges);
  }
  if (plan.spin) {
    text += spin_up_text("axis", plan.spin->up, run.runs.front().status.axis_spun_up);
  }
  if (plan.carriage && plan.carriage->spin) {
    text += spin_up_text("carriage", plan.carriage->spin->up, run.runs.front().status.carriage_spun_up);
  }
  text += runs_text(plan, run.runs);
  for (const DarkLines& lines : run.dark) {
    text += fmt::format("dark from tick {} ({}) to {}: {} lines, fault register {} ({}): {}\n", lines.tick,
                        place_text(lines.first, plan), place_text(lines.last, plan), lines.last - lines.first + 1,
                        static_cast<int>(lines.fault), to_string(lines.fault), lines.detail);
  }
  if (run.rtl) {
    text += rtl_text(*run.rtl);
  }
  print(text);
}

/// `--clocks` of a program is the length of its edges, as --to is.
Result<TickWindow> window_of(EmulateOptions options, const Plan& plan) {
  if (options.clocks != 0 && !options.to) {
    options.to = options.clocks;
  }
  return tick_window(options, static_cast<std::uint64_t>(plan.job.ticks));
}

/// Waves and the Verilog board begin with counters at 0 at tick 0.
Result<void> check_spin_up(const EmulateOptions& options, const Plan& plan) {
  const bool spun_up = plan.spin || (plan.carriage && plan.carriage->spin);
  if (spun_up && (options.rtl || options.writes())) {
    return Error{ErrorCode::bad_argument,
                 "--rtl, --edges and --vcd show counters that begin at 0 with line 0; this program spins its axes up "
                 "from rest: leave them out, or take the axis limits out of the job"};
  }
  return {};
}

/// The host on the wires of the Verilog board starts one run, with the pins as they are.
Result<void> check_rtl_lines(const EmulateOptions& options, const Plan& plan, Lines lines) {
  const std::int64_t per_revolution = plan.rotary.lines_per_revolution;
  const BoardRun first = run_with(plan, lines.first / per_revolution);
  if (!options.rtl || (!first.backward && lines.last / per_revolution < first.end_revolution())) {
    return {};
  }
  return Error{ErrorCode::bad_argument,
               fmt::format("--rtl of lines {} to {}: the Verilog board takes the lines of one forward run; give --from "
                           "and --to in the ticks of one, run 0 has {} to {}",
                           lines.first, lines.last, 0, run_with(plan, 0).ticks - 1)};
}

}  // namespace

Result<int> run_program(const EmulateOptions& options, const Command& command) {
  GRAVURE_CHECK(refuse_overwrite({{"--edges", options.edges_path}, {"--vcd", options.vcd_path}},
                                 inputs_of_program(options.program)));
  GRAVURE_TRY(const std::unique_ptr<LineSource> program, open_grv(options.program));
  if (program->header().plan.path) {
    return Error{ErrorCode::bad_argument,
                 options.program +
                     ": a program that follows a path has no A-B axis to emulate; verify runs its lines and "
                     "judges where the light lands"};
  }
  const Plan& plan = program->header().plan;
  const std::int64_t per_revolution = plan.rotary.lines_per_revolution;
  Run run;
  GRAVURE_TRY(run.window, window_of(options, plan));
  GRAVURE_CHECK(
      emulator::check_backward_delay(plan.line.offset_remainder_ticks, plan.clock.fpga_hz / plan.clock.seed_hz));
  GRAVURE_CHECK(check_spin_up(options, plan));
  DeviceSetup whole = device_setup(plan, 0, 0);
  whole.end_revolution = plan.job.revolutions;
  GRAVURE_TRY(const Mistakes mistakes, mistakes_of(options, whole));
  const std::uint64_t end = static_cast<std::uint64_t>(plan.job.ticks);
  const bool windowed = options.from || options.to;
  run.lines = lines_of(plan, windowed ? run.window : TickWindow{0, end}, mistakes);
  GRAVURE_CHECK(check_run(mistakes, run.lines.last));
  GRAVURE_CHECK(check_rtl_lines(options, plan, run.lines));
  const DeviceSetup setup = device_setup(plan, run.lines.first / per_revolution, run.lines.first % per_revolution);

  std::unique_ptr<WaveFile> file;
  std::optional<MachineWaves> waves;
  if (!options.vcd_path.empty()) {
    GRAVURE_TRY(const formats::VcdTime time, vcd_time(plan.clock.fpga_hz));
    GRAVURE_TRY(file, WaveFile::create(options.vcd_path, time));
    waves.emplace(MachineWaves::Setup{.device = setup,
                                      .slots_per_microvector = plan.line.slots_per_microvector,
                                      .ticks_per_seed_clock = plan.clock.fpga_hz / plan.clock.seed_hz,
                                      .first_tick = run.window.first,
                                      .last_tick = run.window.last},
                  *file);
  }
  PinCounter pins(waves ? &*waves : nullptr);
  emulator::EmulatedDevice device(&pins);
  GRAVURE_TRY(FaultyHost host, FaultyHost::make(device, mistakes.faults, mistakes.acknowledgements));
  const auto end_run = [&] {
    if (!run.runs.empty()) {
      run.runs.back().status = host.status();
      run.executed += run.runs.back().status.lines_executed;
    }
  };
  const RunStart start = [&](const DeviceSetup& next) -> Result<bool> {
    end_run();
    const Result<void> configured = host.configure(next);
    if (host.status().fault != DeviceFault::none) {
      return false;
    }
    GRAVURE_CHECK(configured);
    if (waves && !run.runs.empty()) {
      waves->start_run(next);
    }
    run.runs.push_back({run_with(plan, next.first_revolution), {}});
    return true;
  };
  GRAVURE_CHECK(send_lines(*program, run.lines, host, start));
  std::vector<TextOutput> files;
  if (file) {
    waves->finish();
    if (cancel_token().cancelled()) {
      return Error{ErrorCode::cancelled, "stopped; nothing was written"};
    }
    GRAVURE_TRY(TextOutput vcd, file->end(run.window.last));
    files.push_back(std::move(vcd));
  }
  if (!options.edges_path.empty()) {
    GRAVURE_TRY(TextOutput edges, write_run_edges(options.edges_path, plan, run.window));
    files.push_back(std::move(edges));
  }
  run.status = host.status();
  end_run();
  run.fired = pins.fired();
  run.dark = host.dark();
  if (options.rtl) {
    GRAVURE_TRY(run.rtl, lines_on_rtl(*program, run.lines, setup, run.fired));
  }
  GRAVURE_CHECK(commit_together(std::move(files)));
  print_run(options, command, plan, run);
  return run.dark.empty() && run.status.tick == (run.lines.last + 1) * plan.line.ticks ? kDone : kLimitViolated;
}

}  // namespace gravure::cli
