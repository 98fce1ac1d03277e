#include "stimulus.hpp"

#include <map>

namespace gravure::cosim {
namespace {

/// How often a one-bit input changes, in clocks. What is not named here is thrown like a coin.
const std::map<std::string, std::uint64_t>& rare_strobes() {
  static const std::map<std::string, std::uint64_t> strobes = {
      {"rst", 5000},
      {"load", 300},
      {"load_increment", 100},
  };
  return strobes;
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
  return [ports = machine.inputs()](Dice& dice, std::span<std::uint64_t> in) {
    for (std::size_t at = 0; at < ports.size(); ++at) {
      const Port& port = ports[at];
      if (const auto rare = rare_strobes().find(port.name); rare != rare_strobes().end()) {
        in[at] = dice.one_in(rare->second) ? 1 : 0;
      } else if ((port.name == "enable" || port.name == "run")) {
        in[at] ^= dice.one_in(200) ? 1U : 0U;
      } else if (port.width > 1 && dice.one_in(20)) {
        in[at] = wide_value(dice, port);
      } else if (port.width == 1) {
        in[at] = dice.word() & 1U;
      }
    }
  };
}

}  // namespace gravure::cosim
