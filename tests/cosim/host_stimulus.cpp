#include "host_stimulus.hpp"

namespace gravure::cosim {
namespace {

std::map<std::string, std::size_t> places_of(const std::vector<Port>& ports) {
  std::map<std::string, std::size_t> places;
  for (std::size_t at = 0; at < ports.size(); ++at) {
    places[ports[at].name] = at;
  }
  return places;
}

FrameMaker::Damage random_damage(Dice& dice, std::uint64_t rarity) {
  if (!dice.one_in(rarity)) {
    return FrameMaker::Damage::none;
  }
  return dice.one_in(2) ? FrameMaker::Damage::in_content : FrameMaker::Damage::on_the_way;
}

/// What is read while nothing is written: anything, and often how far the lines came.
std::uint64_t idle_address(Dice& dice) {
  if (dice.one_in(4)) {
    return dice.one_in(2) ? fpga::kExecutedLinesRegister.address : fpga::kClosedSlotRegister.address;
  }
  return dice.word() % 160;
}

}  // namespace

FrameStimulus::FrameStimulus(const std::vector<Port>& ports) : places_(places_of(ports)) {}

void FrameStimulus::operator()(Dice& dice, std::span<std::uint64_t> in) {
  const auto set = [&](const char* name, std::uint64_t value) { in[places_.at(name)] = value; };
  const bool reset = dice.one_in(20'000);
  const bool clear = dice.one_in(2000) || waiting_ > 20;
  set("rst", reset ? 1 : 0);
  set("clear", clear ? 1 : 0);
  set("position_load", clear ? 1 : 0);
  set("position_revolution", maker_.revolution());
  set("position_line", maker_.line());
  if (reset || clear) {
    frame_.clear();
    waiting_ = 0;
    spoilt_ = false;
    if (reset) {
      maker_.restart_at_zero();
    }
  }
  if (frame_.empty() && !spoilt_) {
    const std::uint64_t slots = 1 + dice.word() % 60;
    const std::uint64_t window = dice.word() % (slots + 1);
    if (maker_.line() == 0 && dice.one_in(10)) {
      const std::uint64_t lines = 1 + dice.word() % 4;
      maker_.configure(slots, window, lines);
      set("slots_per_line", slots);
      set("window_slots", window);
      set("lines_per_revolution", lines);
      set("position_load", 1);
      set("position_revolution", 0);
      set("position_line", 0);
    }
    const FrameMaker::Damage damage = random_damage(dice, 12);
    spoilt_ = damage != FrameMaker::Damage::none;
    const auto bytes = maker_.next(dice, damage);
    frame_.assign(bytes.begin(), bytes.end());
    set("in_valid", 0);  // a new position shows on the next clock
    return;
  }
  const bool send = !frame_.empty() && !dice.one_in(4);
  set("in_valid", send ? 1 : 0);
  set("in_data", send ? frame_.front() : dice.word() & 0xFFU);
  if (send) {
    frame_.pop_front();
  }
  waiting_ += spoilt_ && frame_.empty() ? 1 : 0;
}

HostStimulus::HostStimulus(const std::vector<Port>& ports) : places_(places_of(ports)) {}

void HostStimulus::write(const fpga::Register& target, std::uint64_t data) {
  actions_.push_back({Action::Kind::write, target.address, data & 0xFFFF'FFFFU});
  if (target.bits > 32) {
    actions_.push_back({Action::Kind::write, target.address + std::uint64_t{1}, data >> 32U});
  }
}

void HostStimulus::send(Dice& dice, FrameMaker::Damage damage) {
  for (const std::uint8_t byte : maker_.next(dice, damage)) {
    actions_.push_back({Action::Kind::byte, 0, byte});
  }
  ++lines_sent_;
}

/// The ways of both axes are thrown with each write; only a load takes them.
void HostStimulus::set_control(Dice& dice, std::uint64_t bits) {
  control_ = bits;
  write(fpga::kControlRegister, bits | (dice.word() & 384U));
}

void HostStimulus::set_up_axes(Dice& dice) {
  const std::uint64_t den = 1 + (dice.word() & 0x3'FFFF'FFFEU);
  write(fpga::kIncrementRegister, dice.one_in(8) ? dice.word() : dice.word() % (1U << 30U));
  write(fpga::kPrescalerRegister, dice.one_in(20) ? 0 : 1 + dice.word() % 3);
  write(fpga::kFractionNumRegister, dice.one_in(2) ? 0 : dice.word() % den);
  write(fpga::kFractionDenRegister, den);
  write(fpga::kIncrement1Register, dice.one_in(8) ? dice.word() : dice.word() % (1U << 30U));
  write(fpga::kPrescaler1Register, dice.one_in(20) ? 0 : 1 + dice.word() % 3);
  write(fpga::kFractionNum1Register, dice.one_in(2) ? 0 : dice.word() % den);
  write(fpga::kFractionDen1Register, den);
  write(fpga::kCommandRegister, 512);  // empties the schedules
  for (std::uint64_t segments = dice.word() % (dice.one_in(10) ? 40 : 8); segments > 0; --segments) {
    write(fpga::kScheduleIncrementRegister, dice.one_in(20) ? dice.word() : dice.word() % (1U << 30U));
    write(fpga::kScheduleSeedsRegister, dice.word() % 60);
    write(fpga::kCommandRegister, dice.one_in(2) ? 128 : 256);
  }
}

void HostStimulus::set_up(Dice& dice) {
  const std::uint64_t slots = 30 + dice.word() % 20;
  const std::uint64_t window = dice.one_in(10) ? dice.word() % 3 : dice.word() % (slots + 1);
  const bool wide = dice.one_in(4);
  const std::uint64_t seeds = wide ? 12 + dice.word() % 8 : dice.one_in(4) ? 1 + dice.word() % 2 : 2 + dice.word() % 5;
  const std::uint64_t lines = 1 + dice.word() % 4;
  const std::uint64_t delay = dice.one_in(30) ? seeds : dice.word() % (wide ? 4 : seeds);
  set_control(dice, 0);
  set_up_axes(dice);
  write(fpga::kSeedsPerSlotRegister, seeds);
  write(fpga::kSlotsPerLineRegister, slots);
  write(fpga::kWindowSlotsRegister, dice.one_in(40) ? slots + 1 : window);
  write(fpga::kSlotsPerMicrovectorRegister, dice.word() % 8);
  write(fpga::kLinesPerRevolutionRegister, lines);
  write(fpga::kPositionRevolutionRegister, dice.word() & 3U);
  write(fpga::kPositionRevolutionRegister, 0);
  write(fpga::kPositionLineRegister, 0);
  write(fpga::kSilenceLimitRegister, dice.one_in(5) ? 40 : 5000);
  write(fpga::kFirstTickRegister, dice.word() % 400);
  write(fpga::kReverseDelayRegister, dice.one_in(2) ? 0 : delay);
  write(fpga::kLowLevelRegister, dice.word() % 40);
  write(fpga::kCorrectionLimitRegister, wide ? dice.word() % 3 : 0);
  write(fpga::kIndexWindowRegister, dice.word() % 60);
  write(fpga::kRevolutionSeedsRegister, lines * slots * seeds);
  write(fpga::kCommandRegister, 1);
  write(fpga::kCommandRegister, 2 + 8 + 16);
  actions_.push_back({});  // the acknowledge drops a byte that comes two clocks behind it
  maker_.configure(slots, window, lines);
  line_ticks_ = slots * seeds;
  turn_ticks_ = lines * line_ticks_;
  next_index_ = clock_ + 200 + dice.word() % turn_ticks_;
  lines_sent_ = 0;
  send(dice, FrameMaker::Damage::none);
  send(dice, FrameMaker::Damage::none);
  const std::uint64_t timed = dice.one_in(3) ? 16 : 0;
  set_control(dice, (dice.one_in(3) ? 15 : 11) + timed + (dice.word() & 32U) + (dice.one_in(3) ? 0 : 64));
  write(fpga::kCommandRegister, timed != 0 || dice.one_in(2) ? 64 : 0);
  actions_.push_back({Action::Kind::start});
  ready_ = true;
}

void HostStimulus::feed(Dice& dice) {
  const std::uint64_t due = (clock_ - started_at_) / line_ticks_ + (dice.one_in(200) ? 20 : 2);
  if (lines_sent_ < due && !dice.one_in(40)) {
    send(dice, random_damage(dice, 20));
  } else if (dice.one_in(400)) {
    write(fpga::kIncrementRegister, dice.word() % (1U << 30U));
    write(fpga::kIncrement1Register, dice.word() % (1U << 30U));
    write(fpga::kCommandRegister, 4 + (dice.word() & 32U));
  } else if (dice.one_in(300)) {
    set_control(dice, control_);
    write(fpga::kCommandRegister, dice.word() & 18U);
  } else if (dice.one_in(2000)) {
    write(fpga::kSlotsPerLineRegister, 7);  // refused while lines run
  } else {
    actions_.push_back({});
  }
}

void HostStimulus::operator()(Dice& dice, std::span<std::uint64_t> in) {
  held_ = !held_;
  if (held_) {
    return;  // every input stays for the two FPGA clocks of a seed clock
  }
  const auto set = [&](const char* name, std::uint64_t value) { in[places_.at(name)] = value; };
  ++clock_;
  const bool reset = dice.one_in(50'000);
  if (reset || (actions_.empty() && dice.one_in(1500))) {
    actions_.clear();
    ready_ = false;
  }
  if (actions_.empty() && !ready_) {
    set_up(dice);
  } else if (actions_.empty()) {
    feed(dice);
  }
  Action action;
  if (!reset && !dice.one_in(8)) {
    action = actions_.front();
    actions_.pop_front();
  }
  if (action.kind == Action::Kind::start) {
    started_at_ = clock_;
  }
  set("rst", reset ? 1 : 0);
  set("interlock", dice.one_in(20'000) ? 1 : 0);
  if (clock_ >= next_index_ + 5) {
    next_index_ = clock_ + turn_ticks_ - 5 + dice.word() % 5 - (dice.one_in(30) ? turn_ticks_ / 2 : 0);
  }
  set("index", clock_ >= next_index_ ? 1 : 0);
  set("start", action.kind == Action::Kind::start ? 1 : 0);
  set("write", action.kind == Action::Kind::write ? 1 : 0);
  set("address", action.kind == Action::Kind::write ? action.address : idle_address(dice));
  set("write_data", action.kind == Action::Kind::write ? action.data : dice.word() & 0xFFFF'FFFFU);
  set("in_valid", action.kind == Action::Kind::byte ? 1 : 0);
  set("in_data", action.kind == Action::Kind::byte ? action.data : dice.word() & 0xFFU);
}

}  // namespace gravure::cosim
