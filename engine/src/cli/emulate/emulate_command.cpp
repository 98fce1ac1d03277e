#include <limits>
#include <memory>

#include "emulate/emulate.hpp"

namespace gravure::cli {
namespace {

/// What the options demand of each other and CLI11 cannot say.
void check_together(const EmulateOptions& options, const CLI::App& verb) {
  const auto given = [&verb](const char* name) { return verb.count(name) != 0; };
  const bool counter = options.program.empty();
  if (given("--fpga-hz") && (options.vcd_path.empty() || !counter)) {
    throw CLI::ValidationError("--fpga-hz", "is the time base of --vcd, of the counter alone; a program knows its own");
  }
  if (!counter && given("--clocks") && !options.writes()) {
    throw CLI::ValidationError("--clocks", "is the length of --edges and --vcd; a program runs to its end");
  }
  if (!counter && given("--clocks") && given("--to")) {
    throw CLI::ValidationError("--clocks", "and --to both give the end of a program's window: give --to alone");
  }
  for (const char* name : {"--from", "--to"}) {
    if (counter && given(name) && !options.writes()) {
      throw CLI::ValidationError(name, "is the window of --edges and --vcd; the counter runs for --clocks");
    }
  }
  for (const char* name : {"--fault", "--acknowledge"}) {
    if (counter && given(name)) {
      throw CLI::ValidationError(name, "needs a program: the counter alone has no lines");
    }
  }
  if (options.rtl && given("--fault")) {
    throw CLI::ValidationError("--rtl",
                               "feeds the board byte by byte, and there a mistake closes the gate as soon as it is "
                               "seen, not with its line as --fault counts: leave out --fault (the lock step of "
                               "tests/cosim runs every fault through Verilog and model)");
  }
  for (const char* name : {"--bits", "--m", "--increment", "--clocks"}) {
    if (counter && !given(name)) {
      throw CLI::RequiredError("PROGRAM, or all of --bits, --m, --increment and --clocks; missing: " +
                               std::string(name));
    }
  }
}

void add_counter_options(CLI::App& verb, EmulateOptions& options, CLI::Option* program) {
  const CLI::Validator natural = integer_from(0, std::numeric_limits<std::uint64_t>::max());
  fpga::AbRegisters& registers = options.registers;
  verb.add_option("--bits", registers.bits, "Counter bits n")
      ->excludes(program)
      ->check(integer_from(fpga::kMinCounterBits, fpga::kMaxCounterBits));
  verb.add_option("--m", registers.prescaler, "Prescaler m")->excludes(program)->check(natural);
  verb.add_option("--increment", registers.increment, "Added every m-th clock")->excludes(program)->check(natural);
  CLI::Option* num = verb.add_option("--num", registers.fraction_num, "Fraction: numerator");
  CLI::Option* den = verb.add_option("--den", registers.fraction_den, "Fraction: denominator");
  num->excludes(program)->check(natural)->needs(den);
  den->excludes(program)->check(natural)->needs(num);
  verb.add_option("--fpga-hz", options.fpga_hz, "Clock, for the times in the VCD file; without it a tick is 1 ns")
      ->check(integer_from(1, std::uint64_t{1} << 40));
  verb.add_option("--clocks", options.clocks, "FPGA clocks to run; for a program's edges: the same as --to")
      ->check(natural);
}

}  // namespace

void add_emulate(CLI::App& app, Command& command) {
  CLI::App* verb =
      add_verb(app, command, "emulate", "The FPGA alone: a program, or the A-B counter from its registers");
  const auto options = std::make_shared<EmulateOptions>();
  CLI::Option* program = verb->add_option("PROGRAM", options->program, "Program file (.grv)");
  add_counter_options(*verb, *options, program);
  const CLI::Validator natural = integer_from(0, std::numeric_limits<std::uint64_t>::max());
  verb->add_option("--edges", options->edges_path, "Write every A-B edge as CSV: tick,a,b");
  verb->add_option(
      "--vcd", options->vcd_path,
      "Write a waveform (VCD): A and B; of a program also gate, line start, scanner clock, revolution, line");
  verb->add_option("--from", options->from, "First tick of the window; a program is run there alone")->check(natural);
  verb->add_option("--to", options->to, "Last tick of the window")->check(natural);
  verb->add_option("--fault", options->faults,
                   "Make a mistake, KIND@WHERE: underrun, checksum, lost, shape, silence or interlock @ line=N (over "
                   "the whole job) or revolution=R,line=L; repeatable");
  verb->add_option("--acknowledge", options->acknowledgements,
                   "Acknowledge the fault before a line: line=N or revolution=R,line=L; repeatable");
  verb->add_flag(
      "--rtl", options->rtl,
      "Run the same on the Verilog board under Verilator and compare every pin on every clock; a program from "
      "the first line of the window, with its axis at 0 there");
  verb->callback([=, &command] {
    check_together(*options, *verb);
    command.run = [&command, options] {
      return options->program.empty() ? run_counter(*options, command) : run_program(*options, command);
    };
  });
}

}  // namespace gravure::cli
