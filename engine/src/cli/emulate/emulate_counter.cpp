#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "emulate/emulate.hpp"
#include "emulate/emulate_rtl.hpp"
#include "gravure/core/board_runs.hpp"
#include "gravure/formats/waves.hpp"
#include "gravure/fpga/edge_stream.hpp"
#include "program/program_files.hpp"
#include "text_output.hpp"

namespace gravure::cli {
namespace {

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

Integer to_integer(fpga::Uint128 value) {
  return (Integer(static_cast<std::uint64_t>(value >> 64U)) << 64) + static_cast<std::uint64_t>(value);
}

/// Gives the edges of a window to `write`, which appends to the text of `output`; gives their number.
Result<std::uint64_t> write_each(const fpga::AbRegisters& registers, TickWindow window, TextOutput& output,
                                 const std::function<Result<void>(const fpga::AbEdge&)>& write) {
  std::uint64_t edges = 0;
  Result<void> written;
  static_cast<void>(fpga::stream_edges(registers, window.first, window.last, [&](const fpga::AbEdge& edge) {
    ++edges;
    written = write(edge);
    return written && output.flush(false) && !cancel_token().cancelled();
  }));
  if (!written) {
    return written.error();
  }
  if (cancel_token().cancelled()) {
    return Error{ErrorCode::cancelled, "stopped; nothing was written"};
  }
  return edges;
}

/// A file that is written but not in its place, and the edges in it.
struct WrittenEdges {
  TextOutput output;
  std::uint64_t edges = 0;
};

Result<WrittenEdges> write_csv_edges(const EmulateOptions& options, TickWindow window) {
  GRAVURE_TRY(TextOutput output, TextOutput::create(options.edges_path));
  formats::append_csv_header(output.text());
  GRAVURE_TRY(const std::uint64_t edges, write_each(options.registers, window, output, [&](const fpga::AbEdge& edge) {
                formats::append_csv_edge(output.text(), edge);
                return Result<void>();
              }));
  return WrittenEdges{std::move(output), edges};
}

Result<WrittenEdges> write_vcd_edges(const EmulateOptions& options, TickWindow window) {
  GRAVURE_TRY(const formats::VcdTime time, vcd_time(options.fpga_hz));
  GRAVURE_TRY(formats::VcdWriter waves, formats::VcdWriter::make(time));
  GRAVURE_TRY(TextOutput output, TextOutput::create(options.vcd_path));
  const fpga::AbPins pins = fpga::position_after(options.registers, window.first).pins;
  GRAVURE_CHECK(waves.begin(output.text(), window.first, pins));
  GRAVURE_TRY(const std::uint64_t edges, write_each(options.registers, window, output, [&](const fpga::AbEdge& edge) {
                return waves.edge(output.text(), edge);
              }));
  GRAVURE_CHECK(waves.end(output.text(), window.last));
  return WrittenEdges{std::move(output), edges};
}

}  // namespace

Result<TickWindow> tick_window(const EmulateOptions& options, std::uint64_t end) {
  const TickWindow window{options.from.value_or(0), options.to.value_or(end)};
  for (const auto& [name, tick] : {std::pair("--from", window.first), std::pair("--to", window.last)}) {
    if (tick > end) {
      return Error{ErrorCode::out_of_range,
                   fmt::format("{} {}: the run ends at tick {}; allowed is 0 to {}", name, tick, end, end)};
    }
  }
  if (window.first > window.last) {
    return Error{ErrorCode::bad_argument, fmt::format("--from {} lies after --to {}: give the earlier tick to --from",
                                                      window.first, window.last)};
  }
  return window;
}

Result<formats::VcdTime> vcd_time(std::int64_t fpga_hz) {
  if (fpga_hz <= 0) {
    return formats::VcdTime{};
  }
  const Rational femtoseconds = Rational(Integer("1000000000000000")) / fpga_hz;
  GRAVURE_TRY(const std::uint64_t num, to_uint64(numerator_of(femtoseconds), "clock period"));
  GRAVURE_TRY(const std::uint64_t den, to_uint64(denominator_of(femtoseconds), "clock period"));
  return formats::VcdTime{"1 fs", num, den};
}

Result<TextOutput> write_run_edges(const std::string& path, const Plan& plan, TickWindow window) {
  const fpga::AbRegisters registers{plan.ab.counter_bits, plan.ab.prescaler, plan.ab.increment, plan.ab.fraction_num,
                                    plan.ab.fraction_den};
  GRAVURE_TRY(TextOutput output, TextOutput::create(path));
  formats::append_csv_header(output.text());
  const auto run_ticks = static_cast<std::uint64_t>(run_with(plan, 0).ticks);
  for (std::uint64_t begin = window.first / run_ticks * run_ticks; begin < window.last; begin += run_ticks) {
    const std::int64_t revolution = static_cast<std::int64_t>(begin) / plan.rotary.ticks_per_revolution;
    const bool backward = run_with(plan, revolution).backward;
    const TickWindow part{std::max(window.first, begin) - begin, std::min(window.last - begin, run_ticks)};
    GRAVURE_CHECK(write_each(registers, part, output, [&](const fpga::AbEdge& edge) {
      const fpga::AbPins pins = backward ? fpga::AbPins{edge.pins.b, edge.pins.a} : edge.pins;
      formats::append_csv_edge(output.text(), {edge.clock + begin, pins});
      return Result<void>();
    }));
  }
  return output;
}

Json axis_json(const fpga::AbRegisters& registers, std::uint64_t tick) {
  const fpga::AbPosition end = fpga::position_after(registers, tick);
  const Integer counts = to_integer(end.counts);
  return {{"tick", json_integer(Integer(tick))},
          {"counts", json_integer(counts)},
          {"counter", json_integer(counts % (Integer(1) << registers.bits))},
          {"accumulator", json_integer(Integer(end.accumulator))},
          {"edges", json_integer(Integer(end.edges))},
          {"a", end.pins.a ? 1 : 0},
          {"b", end.pins.b ? 1 : 0}};
}

Result<int> run_counter(const EmulateOptions& options, const Command& command) {
  GRAVURE_CHECK(check_registers(options.registers));
  GRAVURE_TRY(const TickWindow window, tick_window(options, options.clocks));
  GRAVURE_CHECK(refuse_overwrite({{"--edges", options.edges_path}, {"--vcd", options.vcd_path}}, {}));
  const std::uint64_t closed_form = fpga::position_after(options.registers, window.last).edges -
                                    fpga::position_after(options.registers, window.first).edges;
  std::vector<TextOutput> files;
  const auto keep = [&](Result<WrittenEdges> made) -> Result<void> {
    GRAVURE_TRY(WrittenEdges written, std::move(made));
    GRAVURE_CHECK(written.output.finish());  // a full disk ends the edges early
    if (written.edges != closed_form) {      // two ways to the same number
      return Error{ErrorCode::device,
                   fmt::format("the event model gave {} edges, the closed form {}", written.edges, closed_form)};
    }
    files.push_back(std::move(written.output));
    return {};
  };
  if (!options.vcd_path.empty()) {
    GRAVURE_CHECK(keep(write_vcd_edges(options, window)));
  }
  if (!options.edges_path.empty()) {
    GRAVURE_CHECK(keep(write_csv_edges(options, window)));
  }
  const fpga::AbPosition end = fpga::position_after(options.registers, options.clocks);
  Json rtl;
  if (options.rtl) {
    GRAVURE_TRY(rtl, counter_on_rtl(options));
  }
  GRAVURE_CHECK(commit_together(std::move(files)));
  if (command.json) {
    Json result = {{"clocks", json_integer(Integer(options.clocks))},
                   {"edges", json_integer(Integer(end.edges))},
                   {"a", end.pins.a ? 1 : 0},
                   {"b", end.pins.b ? 1 : 0},
                   {"axis", axis_json(options.registers, options.clocks)}};
    if (options.rtl) {
      result["rtl"] = rtl;
    }
    print_json(result);
  } else {
    print(fmt::format("{} clocks, {} edges, ends at A = {}, B = {}\n", options.clocks, end.edges, end.pins.a ? 1 : 0,
                      end.pins.b ? 1 : 0));
    if (options.rtl) {
      print(rtl_text(rtl));
    }
  }
  return kDone;
}

}  // namespace gravure::cli
