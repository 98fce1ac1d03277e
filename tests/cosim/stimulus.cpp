#include "stimulus.hpp"

#include <map>

namespace gravure::cosim {
namespace {

/// How rare a one-bit input is: high in one of so many clocks. What is not named here is thrown like a coin.
const std::map<std::string, std::uint64_t>& rare_strobes() {
  static const std::map<std::string, std::uint64_t> strobes = {
      {"rst", 5000},       {"load", 300},          {"load_increment", 100}, {"flush", 500},
      {"clear", 300},      {"fault", 400},         {"commit", 10},          {"rollback", 60},
      {"acknowledge", 20}, {"sequence_error", 40}, {"checksum_error", 40},  {"shape_error", 40},
      {"underrun", 40},    {"host_silence", 40},   {"interlock", 40},       {"kick", 8},
  };
  return strobes;
}

/// Inputs that stay for a while: stops and back-pressure come in stretches.
bool is_level(const std::string& name) {
  return name == "enable" || name == "run" || name == "pop" || name == "byte_valid";
}

/// A value for a wide input: extremes, small numbers, anything.
std::uint64_t wide_value(Dice& dice, const Port& port) {
  switch (dice.word() % 8) {
    case 0:
      return port.mask();
    case 1:
      return (port.mask() >> 2U) + dice.word() % 3;  // around the largest increment
    case 2:
    case 3:
      return dice.word() % 5;
    default:
      return dice.of_any_length() & port.mask();
  }
}

/// Frames as a host sends them, with idle clocks, now and then damaged in one of the ways a link or a host can.
class FrameStimulus {
 public:
  explicit FrameStimulus(const std::vector<Port>& ports) {
    for (std::size_t at = 0; at < ports.size(); ++at) {
      places_[ports[at].name] = at;
    }
  }

  void operator()(Dice& dice, std::span<std::uint64_t> in) {
    const auto set = [&](const char* name, std::uint64_t value) { in[places_.at(name)] = value; };
    set("rst", dice.one_in(20'000) ? 1 : 0);
    set("clear", dice.one_in(2000) || waiting_ > 20 ? 1 : 0);
    set("position_load", in[places_.at("clear")]);
    set("position_revolution", revolution_);
    set("position_line", line_);
    if (in[places_.at("rst")] != 0 || in[places_.at("clear")] != 0) {
      frame_.clear();
      waiting_ = 0;
      spoilt_ = false;
      if (in[places_.at("rst")] != 0) {
        revolution_ = line_ = 0;
      }
    }
    if (frame_.empty() && !spoilt_) {
      configure(dice, set);
      build(dice);
    }
    const bool send = !frame_.empty() && !dice.one_in(4);
    set("in_valid", send ? 1 : 0);
    set("in_data", send ? frame_.front() : dice.word() & 0xFFU);
    if (send) {
      frame_.erase(frame_.begin());
    }
    waiting_ += spoilt_ && frame_.empty() ? 1 : 0;
  }

 private:
  template <class Set>
  void configure(Dice& dice, const Set& set) {
    slots_ = 1 + dice.word() % 60;
    window_ = dice.word() % (slots_ + 1);
    lines_ = 1 + dice.word() % 4;
    set("slots_per_line", slots_);
    set("window_slots", window_);
    set("lines_per_revolution", lines_);
  }

  void append(std::uint64_t value, int bytes) {
    for (int byte = 0; byte < bytes; ++byte) {
      frame_.push_back(static_cast<std::uint8_t>(value >> static_cast<unsigned>(8 * byte)));
    }
  }

  void build(Dice& dice) {
    append(0xA5, 1);
    append(revolution_, 8);
    append(line_, 8);
    append(dice.word() % (slots_ - window_ + 1), 8);
    for (std::uint64_t slot = 0; slot < window_; slot += 8) {
      const std::uint64_t unused = slot + 8 > window_ ? slot + 8 - window_ : 0;
      append((dice.word() << unused) & 0xFFU, 1);
    }
    if (dice.one_in(12)) {  // wrong, but with a good checksum
      frame_[1 + dice.word() % (frame_.size() - 1)] ^= static_cast<std::uint8_t>(1U << (dice.word() % 8));
      spoilt_ = true;
    }
    append(crc(), 4);
    if (dice.one_in(12)) {  // damaged on the way
      frame_[dice.word() % frame_.size()] ^= static_cast<std::uint8_t>(1U << (dice.word() % 8));
      spoilt_ = true;
    }
    line_ = line_ + 1 >= lines_ ? 0 : line_ + 1;
    revolution_ += line_ == 0 ? 1 : 0;
  }

  std::uint32_t crc() const {
    std::uint32_t state = ~0U;
    for (std::size_t at = 1; at < frame_.size(); ++at) {
      state ^= frame_[at];
      for (int bit = 0; bit < 8; ++bit) {
        state = (state >> 1U) ^ ((state & 1U) != 0 ? 0x82F63B78U : 0U);
      }
    }
    return ~state;
  }

  std::map<std::string, std::size_t> places_;
  std::vector<std::uint8_t> frame_;  ///< what is left to send
  std::uint64_t revolution_ = 0, line_ = 0;
  std::uint64_t slots_ = 1, window_ = 0, lines_ = 1;
  bool spoilt_ = false;
  int waiting_ = 0;
};

}  // namespace

Stimulus stimulus_for(const Machine& machine) {
  for (const Port& port : machine.inputs()) {
    if (port.name == "in_data") {
      return FrameStimulus(machine.inputs());
    }
  }
  return [ports = machine.inputs()](Dice& dice, std::span<std::uint64_t> in) {
    for (std::size_t at = 0; at < ports.size(); ++at) {
      const Port& port = ports[at];
      if (const auto rare = rare_strobes().find(port.name); rare != rare_strobes().end()) {
        in[at] = dice.one_in(rare->second) ? 1 : 0;
      } else if (is_level(port.name)) {
        in[at] ^= dice.one_in(50) ? 1U : 0U;
      } else if (port.width > 1 && dice.one_in(20)) {
        in[at] = wide_value(dice, port);
      } else if (port.width == 1) {
        in[at] = dice.word() & 1U;
      }
    }
  };
}

}  // namespace gravure::cosim
