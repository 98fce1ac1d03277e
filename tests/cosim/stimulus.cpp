#include "stimulus.hpp"

#include <algorithm>
#include <map>

#include "host_stimulus.hpp"

namespace gravure::cosim {
namespace {

/// How rare a one-bit input is: high in one of so many clocks. What is not named here is thrown like a coin.
const std::map<std::string, std::uint64_t>& rare_strobes() {
  static const std::map<std::string, std::uint64_t> strobes = {
      {"rst", 5000},       {"load", 300},          {"load_increment", 100}, {"flush", 500},
      {"clear", 300},      {"fault", 400},         {"commit", 10},          {"rollback", 60},
      {"acknowledge", 20}, {"sequence_error", 40}, {"checksum_error", 40},  {"shape_error", 40},
      {"underrun", 40},    {"host_silence", 40},   {"interlock", 40},       {"kick", 8},
      {"go", 60},          {"strobe", 30},         {"line_end", 20},        {"adjust", 30},
  };
  return strobes;
}

/// Inputs that stay for a while: stops and back-pressure come in stretches.
bool is_level(const std::string& name) {
  return name == "enable" || name == "run" || name == "pop" || name == "byte_valid" || name == "timed" ||
         name == "index" || name == "reverse";
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

}  // namespace

Stimulus stimulus_for(const Machine& machine) {
  const auto has = [&machine](const char* name) {
    const auto& ports = machine.inputs();
    return std::any_of(ports.begin(), ports.end(), [name](const Port& port) { return port.name == name; });
  };
  if (has("in_data")) {
    return has("write_data") ? Stimulus(HostStimulus(machine.inputs())) : Stimulus(FrameStimulus(machine.inputs()));
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
