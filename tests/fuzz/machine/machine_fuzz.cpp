// Any bytes are a machine or an Error; a machine is one that the kinematics core takes.

#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "gravure/formats/machine_file.hpp"

namespace {

constexpr std::string_view kPath = "fuzz.toml";

void require(bool holds) {
  if (!holds) {
    std::abort();
  }
}

void check_error(const gravure::Error& error) {
  require(error.code == gravure::ErrorCode::bad_argument || error.code == gravure::ErrorCode::out_of_range ||
          error.code == gravure::ErrorCode::bad_file);
  require(error.message.substr(0, kPath.size()) == kPath);
  for (const char c : error.message) {
    require(c == '\n' || static_cast<unsigned char>(c) >= 0x20U);
  }
}

void check_machine_of(const gravure::kinematics::Machine& machine) {
  require(static_cast<bool>(gravure::kinematics::check_machine(machine)));
  const gravure::kinematics::JointPositions joints(machine.joints.size(), 0.1);
  const auto spot = gravure::kinematics::forward(machine, joints, {0.1, -0.1, 0.1});
  require(spot.position_mm.allFinite() && spot.towards_head.allFinite());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto machine = gravure::parse_machine(text, std::string(kPath));
  machine ? check_machine_of(machine.value()) : check_error(machine.error());
  return 0;
}
