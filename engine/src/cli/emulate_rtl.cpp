#include "emulate_rtl.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace gravure::cli {
namespace {

using fpga::SynchroEvents;

bool same(const gravure_fpga_board_outputs& rtl, const SynchroEvents::Event& model) {
  return (rtl.a != 0) == model.axes[0].a && (rtl.b != 0) == model.axes[0].b && (rtl.a_1 != 0) == model.axes[1].a &&
         (rtl.b_1 != 0) == model.axes[1].b && (rtl.gate != 0) == model.gate && (rtl.scan != 0) == model.scan &&
         rtl.fault == model.fault;
}

Error difference(std::uint64_t clock, const gravure_fpga_board_outputs& rtl, const SynchroEvents::Event& model) {
  return {ErrorCode::device,
          fmt::format("Verilog and model differ after clock {}: A {} {}, B {} {}, gate {} {}, scan {} {}, fault {} {}",
                      clock, rtl.a, model.axes[0].a, rtl.b, model.axes[0].b, rtl.gate, model.gate, rtl.scan, model.scan,
                      rtl.fault, model.fault)};
}

}  // namespace

Result<TwoBoards> TwoBoards::load() {
  GRAVURE_TRY(emulator::RtlBoard rtl, emulator::RtlBoard::load());
  return TwoBoards(std::move(rtl));
}

Result<void> TwoBoards::hold(const fpga::Synchro::Inputs& inputs, std::uint64_t clocks) {
  constexpr std::uint64_t kPiece = 1U << 20U;  // bounds what is kept of the model's events
  const gravure_fpga_board_inputs in = {inputs.rst,        inputs.write,     inputs.address,
                                        inputs.write_data, inputs.in_valid,  inputs.in_data,
                                        inputs.start,      inputs.interlock, inputs.index};
  for (std::uint64_t left = clocks; left != 0;) {
    const std::uint64_t piece = std::min(left, kPiece);
    left -= piece;
    if (cancel_token().cancelled()) {
      return Error{ErrorCode::cancelled, "stopped before the end of the comparison"};
    }
    std::uint64_t clock = events_.clock();
    const std::uint64_t end = clock + piece;
    expected_.clear();
    events_.run(inputs, piece, [this](const SynchroEvents::Event& event) { expected_.push_back(event); });
    auto next = expected_.begin();
    while (clock != end) {
      const gravure_fpga_board_outputs rtl = rtl_.step(in);
      ++clock;
      if (next != expected_.end() && next->clock == clock) {
        edges_ += next->axes[0] == pins_.axes[0] ? 0 : 1;
        pins_ = *next++;
      }
      gate_clocks_ += pins_.gate ? 1 : 0;
      if (!same(rtl, pins_)) {
        return difference(clock, rtl, pins_);
      }
    }
  }
  return {};
}

Result<Json> counter_on_rtl(const EmulateOptions& options) {
  using fpga::AbGenerator;
  GRAVURE_TRY(TwoBoards boards, TwoBoards::load());
  emulator::BoardHost host(
      emulator::kRtlFifoBits,
      [&boards](const fpga::Synchro::Inputs& inputs, std::uint64_t clocks) { return boards.hold(inputs, clocks); });
  DeviceSetup setup;
  setup.counter_bits = options.registers.bits;
  setup.prescaler = options.registers.prescaler;
  setup.increment = options.registers.increment;
  setup.fraction_num = options.registers.fraction_num;
  setup.fraction_den = options.registers.fraction_den;
  GRAVURE_CHECK(host.start_axis(setup));
  // The command register shows for one seed clock after the write; the load is taken on the first edge of that.
  constexpr auto kLoad = static_cast<std::uint64_t>(AbGenerator::load_latency(fpga::Synchro::kAxisWidths));
  GRAVURE_CHECK(host.wait(options.clocks + kLoad + 1));
  const std::uint64_t closed_form = fpga::position_after(options.registers, options.clocks).edges;
  if (boards.edges() != closed_form) {
    return Error{ErrorCode::device, fmt::format("Verilog and model gave {} edges in {} clocks, the closed form {}",
                                                boards.edges(), options.clocks, closed_form)};
  }
  return Json{{"clocks", json_integer(Integer(boards.clocks()))},
              {"edges", json_integer(Integer(boards.edges()))},
              {"differences", 0}};
}

}  // namespace gravure::cli
