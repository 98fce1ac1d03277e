#include "emulate/emulate_rtl.hpp"

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

std::string difference(std::uint64_t clock, const gravure_fpga_board_outputs& rtl, const SynchroEvents::Event& model) {
  return fmt::format(
      "after clock {}: A {:d} {:d}, B {:d} {:d}, A of axis 1 {:d} {:d}, B {:d} {:d}, gate {:d} {:d}, "
      "scan {:d} {:d}, fault {:d} {:d}",
      clock, rtl.a, model.axes[0].a, rtl.b, model.axes[0].b, rtl.a_1, model.axes[1].a, rtl.b_1, model.axes[1].b,
      rtl.gate, model.gate, rtl.scan, model.scan, rtl.fault, model.fault);
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
        pins_ = *next++;
      }
      compare(rtl);
      if (differences_ == kMostDifferences) {
        return check();
      }
    }
  }
  return {};
}

void TwoBoards::compare(const gravure_fpga_board_outputs& rtl) {
  ++compared_;
  edges_ += rtl.a != shown_.a || rtl.b != shown_.b ? 1 : 0;
  gate_clocks_ += rtl.gate != 0 ? 1 : 0;
  gate_changes_ += rtl.gate != shown_.gate ? 1 : 0;
  shown_ = rtl;
  if (!same(rtl, pins_)) {
    if (differences_ == 0) {
      first_difference_ = difference(compared_, rtl, pins_);
    }
    ++differences_;
  }
}

Result<void> TwoBoards::check() const {
  if (differences_ == 0) {
    return {};
  }
  return Error{ErrorCode::device,
               fmt::format("Verilog and model differ on {} of {} clocks compared{}; first {}", differences_, compared_,
                           differences_ == kMostDifferences ? ", stopped there" : "", first_difference_)};
}

Json TwoBoards::counts() const {
  return {{"clocks", json_integer(Integer(compared_))},
          {"edges", json_integer(Integer(edges_))},
          {"gate_clocks", json_integer(Integer(gate_clocks_))},
          {"gate_changes", json_integer(Integer(gate_changes_))},
          {"differences", json_integer(Integer(differences_))}};
}

std::string rtl_text(const Json& counts) {
  const auto number = [&counts](const char* name) { return counts.at(name).get<std::uint64_t>(); };
  return fmt::format(
      "Verilog: {} clocks with {} A-B edges and {} changes of the gate compared with the model, {} differ\n",
      number("clocks"), number("edges"), number("gate_changes"), number("differences"));
}

Result<Json> counter_on_rtl(const EmulateOptions& options) {
  GRAVURE_TRY(TwoBoards boards, TwoBoards::load());
  emulator::BoardHost host(
      emulator::kRtlFifoBits,
      [&boards](const fpga::Synchro::Inputs& inputs, std::uint64_t clocks) { return boards.hold(inputs, clocks); });
  DeviceSetup setup;
  setup.clock_multiplier = setup.ticks_per_slot = fpga::AbGenerator::kClockMultiplier;
  setup.counter_bits = options.registers.bits;
  setup.prescaler = options.registers.prescaler;
  setup.increment = options.registers.increment;
  setup.fraction_num = options.registers.fraction_num;
  setup.fraction_den = options.registers.fraction_den;
  GRAVURE_CHECK(host.start_axis(setup));
  GRAVURE_CHECK(host.wait(options.clocks + emulator::BoardHost::kAxisLatency));
  GRAVURE_CHECK(boards.check());
  const std::uint64_t closed_form = fpga::position_after(options.registers, options.clocks).edges;
  if (boards.edges() != closed_form) {
    return Error{ErrorCode::device, fmt::format("Verilog and model gave {} edges in {} clocks, the closed form {}",
                                                boards.edges(), options.clocks, closed_form)};
  }
  return boards.counts();
}

}  // namespace gravure::cli
