// Any bytes are a machine or an Error; a machine is one that the kinematics core takes.

#include <cstdint>
#include <string>
#include <string_view>

#include "gravure/formats/machine_file.hpp"
#include "text_reader.hpp"

namespace {

using gravure::fuzz::check_error;
using gravure::fuzz::kPath;
using gravure::fuzz::require;

void check_machine_of(const gravure::kinematics::Machine& machine) {
  require(static_cast<bool>(gravure::kinematics::check_machine(machine)));
  const gravure::kinematics::JointPositions joints(machine.joints.size(), 0.1);
  const auto spot = gravure::kinematics::forward(machine, joints, {0.1, -0.1, 0.1});
  require(spot.position_mm.allFinite() && spot.towards_head.allFinite());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = gravure::fuzz::text_of(data, size);
  const auto machine = gravure::parse_machine(text, std::string(kPath));
  machine ? check_machine_of(machine.value()) : check_error(machine.error());
  return 0;
}
