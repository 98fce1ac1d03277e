#include "gravure/emulator/emulated_device.hpp"

#include <utility>

#include "device_checks.hpp"

namespace gravure::emulator {
namespace {

std::string place_of(std::int64_t revolution, std::int64_t line) {
  return "revolution " + std::to_string(revolution) + ", line " + std::to_string(line);
}

std::string hex32(std::uint32_t value) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text = "0x";
  for (int shift = 28; shift >= 0; shift -= 4) {
    text += kDigits[(value >> static_cast<unsigned>(shift)) & 15U];
  }
  return text;
}

}  // namespace

std::string EmulatedDevice::place() const {
  return place_of(revolution_, line_);
}

Result<void> EmulatedDevice::check_schedules(const DeviceSetup& setup) {
  const fpga::AbRegisters axis = ab_registers_of(setup);
  const fpga::AbRegisters carriage = carriage_registers_of(setup);
  const std::int64_t per_seed = setup.clock_multiplier;
  GRAVURE_CHECK(check_schedule("spin_up", setup.spin_up, axis, per_seed));
  GRAVURE_CHECK(check_schedule("spin_down", setup.spin_down, axis, per_seed));
  GRAVURE_CHECK(check_schedule("carriage.spin_up", setup.carriage.spin_up, carriage, per_seed));
  GRAVURE_CHECK(check_schedule("carriage.spin_down", setup.carriage.spin_down, carriage, per_seed));
  GRAVURE_CHECK(check_lead("spin_up", setup.spin_up));
  return check_lead("carriage.spin_up", setup.carriage.spin_up);
}

Result<void> EmulatedDevice::configure(const DeviceSetup& setup) {
  if (fault_ != DeviceFault::none) {
    return Error{ErrorCode::device, "configure: the fault \"" + to_string(fault_) +
                                        "\" stands and locks the registers; acknowledge it first (" + detail_ + ")"};
  }
  GRAVURE_CHECK(check_setup(setup));
  const std::int64_t per_seed = setup.clock_multiplier;
  GRAVURE_CHECK(check_schedules(setup));
  fired_.assign(fpga::packed_bytes(static_cast<std::uint32_t>(setup.window_slots)), std::byte{0});
  setup_ = setup;
  ab_ = ab_registers_of(setup);
  carriage_ = carriage_registers_of(setup);
  ab_start_ = run_schedule(setup.spin_up, ab_, per_seed);
  carriage_start_ = run_schedule(setup.carriage.spin_up, carriage_, per_seed);
  ticks_per_line_ = setup.slots_per_line * setup.ticks_per_slot;
  revolution_ = setup.first_revolution;
  line_ = setup.first_line;
  run_tick_ = setup.begin_revolution * setup.lines_per_revolution * ticks_per_line_;
  ordinal_ = setup.first_revolution * setup.lines_per_revolution + setup.first_line;
  lines_executed_ = 0;
  detail_.clear();
  configured_ = true;
  return {};
}

std::string EmulatedDevice::sequence_violation(const LineFrame& frame) const {
  if (frame.revolution == revolution_ && frame.line == line_) {
    return {};
  }
  return "frame of " + place_of(frame.revolution, frame.line) + ": only " + place() + " may come next";
}

std::string EmulatedDevice::shape_violation(const LineFrame& frame) const {
  if (frame.bits.size() != fired_.size()) {
    return "frame of " + place() + ": " + std::to_string(frame.bits.size()) + " bytes of bits, must be " +
           std::to_string(fired_.size()) + " for window_slots = " + std::to_string(setup_.window_slots);
  }
  const auto unused = static_cast<unsigned>(-setup_.window_slots & 7);
  if (unused != 0 && (std::to_integer<unsigned>(frame.bits.back()) & ((1U << unused) - 1U)) != 0) {
    return "frame of " + place() + ": the last byte is " +
           std::to_string(std::to_integer<unsigned>(frame.bits.back())) + ", its " + std::to_string(unused) +
           " low bits lie past the window and must be 0";
  }
  const std::int64_t last_first = setup_.slots_per_line - setup_.window_slots;
  if (frame.first_slot < 0 || frame.first_slot > last_first) {
    return "frame of " + place() + ": first_slot = " + std::to_string(frame.first_slot) + ", must be 0 to " +
           std::to_string(last_first) + " to keep the window inside the line";
  }
  return {};
}

Error EmulatedDevice::refuse(DeviceFault fault, std::string detail) {
  raise_fault(fault, std::move(detail));
  return {ErrorCode::device,
          "device fault \"" + to_string(fault) + "\": " + detail_ + "; the gate is closed until acknowledged"};
}

void EmulatedDevice::run_line(const LineFrame& frame, bool dark) {
  if (dark) {
    fpga::gate_line({}, static_cast<std::uint32_t>(setup_.window_slots), true, fired_);
  } else {
    fpga::gate_line(frame.bits, static_cast<std::uint32_t>(setup_.window_slots), false, fired_);
    ++lines_executed_;
  }
  if (observer_ != nullptr) {
    const std::int64_t tick = ordinal_ * ticks_per_line_;
    observer_->on_line({.start_tick = tick,
                        .ordinal = ordinal_,
                        .first_slot = dark ? 0 : frame.first_slot,
                        .fired = fired_,
                        .axis_at_start = axis_at(tick),
                        .carriage_at_start = axis_after(carriage_start_, carriage_, tick - run_tick_)});
  }
  ++ordinal_;
  if (++line_ == setup_.lines_per_revolution) {
    line_ = 0;
    ++revolution_;
  }
}

/// `what` came, and there is a line left to run.
Result<void> EmulatedDevice::check_running(const std::string& what) {
  if (!configured_) {
    return Error{ErrorCode::device, "send: the device is not configured; call configure() first"};
  }
  if (revolution_ == setup_.end_revolution) {
    return refuse(DeviceFault::sequence,
                  what + ": the run up to revolution " + std::to_string(setup_.end_revolution - 1) + " is over");
  }
  return {};
}

Result<void> EmulatedDevice::pass_line(DeviceFault fault, std::string detail) {
  GRAVURE_CHECK(check_running("line without a frame"));
  raise_fault(fault, place() + ": " + std::move(detail));
  run_line({}, true);
  return {};
}

Result<void> EmulatedDevice::send(const LineFrame& frame) {
  if (!configured_ || revolution_ == setup_.end_revolution) {
    return check_running("frame of " + place_of(frame.revolution, frame.line));
  }
  if (fault_ != DeviceFault::none) {
    const std::string here = place();
    run_line(frame, true);
    return Error{ErrorCode::device, "the fault \"" + to_string(fault_) + "\" stands (" + detail_ + "): " + here +
                                        " passed dark; acknowledge it first"};
  }
  DeviceFault fault = DeviceFault::none;
  std::string detail;
  if (detail = sequence_violation(frame); !detail.empty()) {
    fault = DeviceFault::sequence;
  } else if (detail = shape_violation(frame); !detail.empty()) {
    fault = DeviceFault::shape;
  } else if (const std::uint32_t crc = frame_crc32c(frame); crc != frame.crc32c) {
    fault = DeviceFault::checksum;
    detail = "frame of " + place() + ": crc32c = " + hex32(frame.crc32c) + ", its content gives " + hex32(crc);
  }
  run_line(frame, fault != DeviceFault::none);
  if (fault != DeviceFault::none) {
    return refuse(fault, std::move(detail));
  }
  return {};
}

DeviceStatus EmulatedDevice::status() const {
  DeviceStatus status{.lines_executed = lines_executed_,
                      .tick = ordinal_ * ticks_per_line_,
                      .axis = {},
                      .carriage = {},
                      .axis_spun_up = {},
                      .carriage_spun_up = {},
                      .axis_at_rest = {},
                      .carriage_at_rest = {},
                      .fault = fault_,
                      .detail = detail_};
  if (configured_) {
    status.axis = axis_at(status.tick);
    status.carriage = axis_after(carriage_start_, carriage_, status.tick - run_tick_);
    status.axis_spun_up = turned(state_of(ab_start_, ab_));
    status.carriage_spun_up = state_of(carriage_start_, carriage_);
  }
  if (configured_ && revolution_ == setup_.end_revolution) {
    const std::int64_t ticks = status.tick - run_tick_;
    const auto rest = [&](const std::vector<ScheduleSegment>& down, const fpga::AbRegisters& registers,
                          const ScheduleEnd& start) -> std::optional<AxisState> {
      if (down.empty()) {
        return std::nullopt;
      }
      return state_of(run_schedule(down, registers, setup_.clock_multiplier, mark(start, registers, ticks)), registers);
    };
    status.axis_at_rest = rest(setup_.spin_down, ab_, ab_start_);
    if (status.axis_at_rest) {
      status.axis_at_rest = turned(*status.axis_at_rest);
    }
    status.carriage_at_rest = rest(setup_.carriage.spin_down, carriage_, carriage_start_);
  }
  return status;
}

AxisState EmulatedDevice::turned(const AxisState& state) const {
  return setup_.backward ? mirrored(state) : state;
}

AxisState EmulatedDevice::axis_at(std::int64_t tick) const {
  return turned(axis_after(ab_start_, ab_, tick - run_tick_));
}

void EmulatedDevice::acknowledge() {
  fault_ = DeviceFault::none;
  detail_.clear();
}

void EmulatedDevice::raise_fault(DeviceFault fault, std::string detail) {
  if (fault == DeviceFault::none || fault_ != DeviceFault::none) {
    return;  // the first fault is the one that is kept
  }
  fault_ = fault;
  detail_ = std::move(detail);
}

}  // namespace gravure::emulator
