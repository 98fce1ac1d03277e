#include <fmt/format.h>

#include <cstdio>
#include <limits>
#include <memory>
#include <optional>

#include "gravure/core/file_output.hpp"
#include "gravure/formats/grv.hpp"
#include "gravure/formats/waves.hpp"
#include "gravure/fpga/edge_stream.hpp"
#include "gravure/raster/count.hpp"
#include "program_files.hpp"
#include "verb.hpp"

namespace gravure::cli {
namespace {

struct Options {
  std::string program;
  fpga::AbRegisters registers;
  std::uint64_t clocks = 0;
  std::int64_t fpga_hz = 0;
  std::string edges_path;
  std::string vcd_path;
};

/// A text file written piece by piece, whole or not at all.
class TextOutput {
 public:
  static Result<TextOutput> create(const std::string& path) {
    GRAVURE_TRY(FileOutput output, FileOutput::create(path));
    std::FILE* file = std::fopen(output.temporary_path().c_str(), "w");
    if (file == nullptr) {
      return Error{ErrorCode::io, path + ": cannot open the output"};
    }
    return TextOutput(std::move(output), file);
  }
  std::string& text() { return text_; }
  /// Writes away what has gathered, when it is worth it.
  bool flush(bool all) {
    constexpr std::size_t kPiece = std::size_t{1} << 18;
    if (text_.size() >= kPiece || all) {
      good_ = std::fwrite(text_.data(), 1, text_.size(), file_.get()) == text_.size() && good_;
      text_.clear();
    }
    return good_;
  }
  Result<void> commit() {
    flush(true);
    good_ = std::fclose(file_.release()) == 0 && good_;
    if (!good_) {
      return Error{ErrorCode::io, output_.path() + ": cannot write: is the disk full?"};
    }
    return output_.commit();
  }

 private:
  struct Close {
    void operator()(std::FILE* file) const { static_cast<void>(std::fclose(file)); }
  };
  TextOutput(FileOutput output, std::FILE* file) : output_(std::move(output)), file_(file) {}
  FileOutput output_;
  std::unique_ptr<std::FILE, Close> file_;
  std::string text_;
  bool good_ = true;
};

/// What is wrong with the registers given on the command line.
Result<void> check_registers(const fpga::AbRegisters& registers) {
  const auto refuse = [](const std::string& option, const std::string& value, const std::string& allowed) {
    return Error{ErrorCode::out_of_range, option + " " + value + ": allowed is " + allowed};
  };
  switch (fpga::check(registers)) {
    case fpga::AbRefusal::none:
      return {};
    case fpga::AbRefusal::bits:
      return refuse("--bits", std::to_string(registers.bits),
                    fmt::format("{} to {}", fpga::kMinCounterBits, fpga::kMaxCounterBits));
    case fpga::AbRefusal::prescaler:
      return refuse("--m", std::to_string(registers.prescaler), "1 or more");
    case fpga::AbRefusal::fraction_den:
      return refuse("--den", std::to_string(registers.fraction_den), "1 or more");
    case fpga::AbRefusal::fraction_num:
      return refuse("--num", std::to_string(registers.fraction_num), "less than --den");
    case fpga::AbRefusal::increment:
      return refuse("--increment", std::to_string(registers.increment),
                    fmt::format("at most {} (2^(bits-2), less the carry), so that A and B never change together",
                                fpga::max_increment(registers)));
  }
  return {};
}

/// Nanoseconds where the clock is known, else one unit a tick.
Result<formats::VcdTime> vcd_time(std::int64_t fpga_hz) {
  if (fpga_hz <= 0) {
    return formats::VcdTime{};
  }
  const Rational femtoseconds = Rational(Integer("1000000000000000")) / fpga_hz;
  GRAVURE_TRY(const std::uint64_t num, to_uint64(numerator_of(femtoseconds), "clock period"));
  GRAVURE_TRY(const std::uint64_t den, to_uint64(denominator_of(femtoseconds), "clock period"));
  return formats::VcdTime{"1 fs", num, den};
}

Result<std::uint64_t> write_edges(const Options& options) {
  if (!options.edges_path.empty() && options.edges_path == options.vcd_path) {
    return Error{ErrorCode::bad_argument, "--edges and --vcd both name " + options.vcd_path + ": give two files"};
  }
  std::optional<TextOutput> csv;
  std::optional<TextOutput> vcd;
  GRAVURE_TRY(const formats::VcdTime time, vcd_time(options.fpga_hz));
  GRAVURE_TRY(formats::VcdWriter waves, formats::VcdWriter::make(time));
  if (!options.edges_path.empty()) {
    GRAVURE_TRY(csv, TextOutput::create(options.edges_path));
    formats::append_csv_header(csv->text());
  }
  if (!options.vcd_path.empty()) {
    GRAVURE_TRY(vcd, TextOutput::create(options.vcd_path));
    GRAVURE_CHECK(waves.begin(vcd->text(), 0, fpga::AbPins{}));
  }
  Result<void> wave_error;
  std::uint64_t edges = 0;
  const auto take = [&](const fpga::AbEdge& edge) {
    bool good = !cancel_token().cancelled();
    ++edges;
    if (csv) {
      formats::append_csv_edge(csv->text(), edge);
      good = csv->flush(false) && good;
    }
    if (vcd) {
      wave_error = waves.edge(vcd->text(), edge);
      good = wave_error && vcd->flush(false) && good;
    }
    return good;
  };
  static_cast<void>(fpga::stream_edges(options.registers, 0, options.clocks, take));
  GRAVURE_CHECK(wave_error);
  if (cancel_token().cancelled()) {
    return Error{ErrorCode::cancelled, "stopped; nothing was written"};
  }
  if (vcd) {
    GRAVURE_CHECK(waves.end(vcd->text(), options.clocks));
    GRAVURE_CHECK(vcd->commit());
  }
  if (csv) {
    GRAVURE_CHECK(csv->commit());
  }
  return edges;
}

Result<int> run_counter(const Options& options, const Command& command) {
  GRAVURE_CHECK(check_registers(options.registers));
  const fpga::AbPosition end = fpga::position_after(options.registers, options.clocks);
  if (!options.edges_path.empty() || !options.vcd_path.empty()) {
    GRAVURE_TRY(const std::uint64_t written, write_edges(options));
    if (written != end.edges) {  // two ways to the same number
      return Error{ErrorCode::device,
                   fmt::format("the event model gave {} edges, the closed form {}", written, end.edges)};
    }
  }
  if (command.json) {
    print_json({{"clocks", json_integer(Integer(options.clocks))},
                {"edges", json_integer(Integer(end.edges))},
                {"a", end.pins.a ? 1 : 0},
                {"b", end.pins.b ? 1 : 0}});
  } else {
    print(fmt::format("{} clocks, {} edges, ends at A = {}, B = {}\n", options.clocks, end.edges, end.pins.a ? 1 : 0,
                      end.pins.b ? 1 : 0));
  }
  return kDone;
}

/// Counts what the pins of a whole program show.
class PinCounter final : public PinObserver {
 public:
  void on_line(const ExecutedLine& line) override { fired_ += raster::popcount(line.fired); }
  std::int64_t fired() const { return fired_; }

 private:
  std::int64_t fired_ = 0;
};

Result<void> run_revolution(LineSource& program, std::int64_t revolution, ProgramChunk& chunk, DeviceLink& device) {
  const ProgramHeader& header = program.header();
  const std::int64_t layer = header.layer_of_revolution[static_cast<std::size_t>(revolution)];
  for (std::int64_t k = 0; k * program.lines_per_chunk() < header.plan.rotary.lines_per_revolution; ++k) {
    if (cancel_token().cancelled()) {
      return Error{ErrorCode::cancelled, "stopped before the end of the program"};
    }
    GRAVURE_CHECK(chunk.load(program, {layer, k}));
    GRAVURE_CHECK(chunk.send(header, revolution, device));
  }
  return {};
}

Result<int> run_program(Options options, const Command& command) {
  for (const std::string& output : {options.edges_path, options.vcd_path}) {
    GRAVURE_CHECK(refuse_overwrite(output, {options.program}));
  }
  GRAVURE_TRY(const std::unique_ptr<LineSource> program, open_grv(options.program));
  const Plan& plan = program->header().plan;
  PinCounter pins;
  const std::unique_ptr<DeviceLink> device = emulated_devices()(pins);
  GRAVURE_CHECK(device->configure(device_setup(plan, 0, 0)));
  ProgramChunk chunk;
  {
    ProgressBar bar("emulate");
    for (std::int64_t r = 0; r < plan.job.revolutions; ++r) {
      GRAVURE_CHECK(run_revolution(*program, r, chunk, *device));
      bar.update(r + 1, plan.job.revolutions);
    }
  }
  const DeviceStatus status = device->status();
  if (!options.edges_path.empty() || !options.vcd_path.empty()) {
    options.registers = {plan.ab.counter_bits, plan.ab.prescaler, plan.ab.increment, plan.ab.fraction_num,
                         plan.ab.fraction_den};
    options.fpga_hz = plan.clock.fpga_hz;
    if (options.clocks == 0) {
      options.clocks = static_cast<std::uint64_t>(status.tick);
    }
    GRAVURE_CHECK(write_edges(options));
  }
  const Json result = {{"program", options.program},
                       {"lines", status.lines_executed},
                       {"ticks", json_integer(Integer(status.tick))},
                       {"planned_ticks", json_integer(Integer(plan.job.ticks))},
                       {"fired_slots", json_integer(Integer(pins.fired()))},
                       {"edges", json_integer(Integer(status.axis.edges))},
                       {"fault", to_string(status.fault)}};
  if (command.json) {
    print_json(result);
  } else {
    print(fmt::format("{} lines in {} ticks (planned {}), {} slots fired, {} A-B edges, fault: {}\n",
                      status.lines_executed, status.tick, plan.job.ticks, pins.fired(), status.axis.edges,
                      to_string(status.fault)));
  }
  return status.tick == plan.job.ticks ? kDone : kLimitViolated;
}

}  // namespace

void add_emulate(CLI::App& app, Command& command) {
  CLI::App* verb =
      add_verb(app, command, "emulate", "The FPGA alone: a program, or the A-B counter from its registers");
  const auto options = std::make_shared<Options>();
  CLI::Option* program = verb->add_option("PROGRAM", options->program, "Program file (.grv)");
  CLI::Option* bits = verb->add_option("--bits", options->registers.bits, "Counter bits n")
                          ->excludes(program)
                          ->check(integer_from(fpga::kMinCounterBits, fpga::kMaxCounterBits));
  const CLI::Validator natural = integer_from(0, std::numeric_limits<std::uint64_t>::max());
  CLI::Option* m = verb->add_option("--m", options->registers.prescaler, "Prescaler m")->excludes(program);
  CLI::Option* increment =
      verb->add_option("--increment", options->registers.increment, "Added every m-th clock")->excludes(program);
  CLI::Option* num =
      verb->add_option("--num", options->registers.fraction_num, "Fraction: numerator")->excludes(program);
  CLI::Option* den =
      verb->add_option("--den", options->registers.fraction_den, "Fraction: denominator")->excludes(program);
  num->needs(den);
  den->needs(num);
  CLI::Option* hz =
      verb->add_option("--fpga-hz", options->fpga_hz, "Clock, for the times in the VCD file; without it a tick is 1 ns")
          ->check(integer_from(1, std::uint64_t{1} << 40));
  CLI::Option* clocks =
      verb->add_option("--clocks", options->clocks, "FPGA clocks to run; for a program's edges: its length");
  for (CLI::Option* option : {m, increment, num, den, clocks}) {
    option->check(natural);
  }
  verb->add_option("--edges", options->edges_path, "Write every A-B edge as CSV: tick,a,b");
  verb->add_option("--vcd", options->vcd_path, "Write A and B as a waveform (VCD)");
  verb->callback([=, &command] {
    const bool writes = !options->edges_path.empty() || !options->vcd_path.empty();
    if (hz->count() != 0 && (options->vcd_path.empty() || !options->program.empty())) {
      throw CLI::ValidationError("--fpga-hz",
                                 "is the time base of --vcd, of the counter alone; a program knows its own");
    }
    if (!options->program.empty() && clocks->count() != 0 && !writes) {
      throw CLI::ValidationError("--clocks", "is the length of --edges and --vcd; a program runs to its end");
    }
    if (options->program.empty()) {
      for (const CLI::Option* needed : {bits, m, increment, clocks}) {
        if (needed->count() == 0) {
          throw CLI::RequiredError("PROGRAM, or all of --bits, --m, --increment and --clocks; missing: " +
                                   needed->get_name());
        }
      }
    }
    command.run = [&command, options] {
      return options->program.empty() ? run_counter(*options, command) : run_program(*options, command);
    };
  });
}

}  // namespace gravure::cli
