#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "gravure/core/error.hpp"
#include "gravure/core/line_device.hpp"
#include "gravure/emulator/emulated_device.hpp"

namespace gravure::emulator {

/// What can go wrong between host and board on purpose.
enum class FaultKind : std::uint8_t {
  underrun,   ///< the frame of a line does not come in time
  checksum,   ///< one of its bits is turned over on the way
  lost,       ///< it is left out: the frame of the next line comes in its place
  shape,      ///< its window lies past the end of the line
  silence,    ///< the host says nothing any more, from this line until it acknowledges
  interlock,  ///< the machine's interlock opens
};
std::string to_string(FaultKind kind);

struct PlannedFault {
  FaultKind kind = FaultKind::underrun;
  std::int64_t ordinal = 0;  ///< line, counted over the whole job
};

/// "line=N" (over the whole job) or "revolution=R,line=L" as a line over the whole job, which
/// ends where the setup does. bad_argument or out_of_range,
/// naming what is allowed.
Result<std::int64_t> parse_line_place(std::string_view text, const DeviceSetup& setup);
/// "KIND@" and a place.
Result<PlannedFault> parse_fault(std::string_view text, const DeviceSetup& setup);

/// Lines that stayed dark because a fault stood.
struct DarkLines {
  std::int64_t tick = 0;  ///< at which the gate went dark: slot 0 of the first line
  std::int64_t first = 0;
  std::int64_t last = 0;  ///< both counted over the whole job, included
  DeviceFault fault = DeviceFault::none;
  std::string detail;
};

/// A host that makes the planned mistakes in front of an emulated board, and goes on sending: the board passes every
/// line dark from the fault on, until the host acknowledges.
class FaultyHost final : public LineDevice {
 public:
  /// bad_argument where two faults hit one line, or an acknowledgement comes where no fault stands. The device must
  /// outlive the host. Before a line of `acknowledgements`
  /// the standing fault is acknowledged.
  static Result<FaultyHost> make(EmulatedDevice& device, std::vector<PlannedFault> faults,
                                 std::vector<std::int64_t> acknowledgements);

  Result<void> configure(const DeviceSetup& setup) override;
  /// Fails only where the board refuses what was not planned.
  Result<void> send(const LineFrame& frame) override;
  DeviceStatus status() const override { return device_->status(); }

  /// In order of time; there is one more at most than acknowledgements.
  const std::vector<DarkLines>& dark() const noexcept { return dark_; }

 private:
  FaultyHost(EmulatedDevice& device, std::vector<PlannedFault> faults, std::vector<std::int64_t> acknowledgements)
      : device_(&device), faults_(std::move(faults)), acknowledgements_(std::move(acknowledgements)) {}
  Result<void> send_badly(FaultKind kind, const LineFrame& frame, std::int64_t ordinal);
  void note(std::int64_t ordinal);
  void acknowledge_to(std::int64_t ordinal);

  EmulatedDevice* device_;
  std::vector<PlannedFault> faults_;  ///< by line
  std::vector<std::int64_t> acknowledgements_;
  std::size_t next_fault_ = 0;
  std::size_t next_acknowledgement_ = 0;
  bool silent_ = false;
  DeviceSetup setup_;
  std::vector<std::byte> spoilt_;
  std::vector<DarkLines> dark_;
};

}  // namespace gravure::emulator
