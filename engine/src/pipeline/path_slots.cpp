#include "gravure/pipeline/path_slots.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "gravure/core/units.hpp"

namespace gravure {
namespace {

bool bit_of(std::span<const std::byte> bits, std::int64_t at) {
  return (bits[static_cast<std::size_t>(at / 8)] & static_cast<std::byte>(0x80U >> (at % 8))) != std::byte{0};
}

void set_bit(std::span<std::byte> bits, std::int64_t at) {
  bits[static_cast<std::size_t>(at / 8)] |= static_cast<std::byte>(0x80U >> (at % 8));
}

std::string shown(double value) {
  return std::to_string(value);
}

}  // namespace

PathSlots::PathSlots(const Plan& plan, const PathPulses& pulses)
    : plan_(plan),
      pulses_(pulses),
      counts_per_mm_(to_double(plan.path->along_counts_per_mm)),
      pitch_counts_(to_double(plan.line.pixel_pitch_um * plan.path->along_counts_per_mm / Rational(1000))) {
  spacing_.least_slots = std::numeric_limits<double>::infinity();
}

Result<void> PathSlots::place(const PathWindow& window, std::span<std::byte> bits) {
  if (carried_) {
    set_bit(bits, 0);
    carried_ = false;
  }
  const auto begin = static_cast<double>(window[1].along_counts);
  const auto end = static_cast<double>(window[2].along_counts);
  const double periods_per_s = to_double(plan_.line.rate_hz);
  const CoveredPath covered(window);
  spacing_.max_speed_mm_s = std::max(spacing_.max_speed_mm_s, covered.max_speed() / counts_per_mm_ * periods_per_s);
  const auto slots = static_cast<double>(plan_.line.slots);
  while (next_ < pulses_.count) {
    const double belongs = (static_cast<double>(next_) + 0.5) * pitch_counts_;
    if (belongs >= end) {
      break;
    }
    const double share = covered.share_of(belongs - begin);
    const double slot = std::round(share * slots);
    const double error_counts = covered.at(std::min(1.0, slot / slots)) - (belongs - begin);
    GRAVURE_CHECK(place_pulse(share * slots, error_counts, bits));
  }
  ++line_;
  return {};
}

Result<void> PathSlots::place_pulse(double moment_slots, double wrong_counts, std::span<std::byte> bits) {
  const std::int64_t slots = plan_.line.slots;
  const std::int64_t inside = std::llround(moment_slots);
  const std::int64_t slot = line_ * slots + inside;
  const double moment = static_cast<double>(line_ * slots) + moment_slots;
  const double slot_s = to_double(Rational(1) / plan_.clock.pulse_hz);
  if (slot <= last_slot_) {
    return Error{ErrorCode::out_of_range,
                 "pulse " + std::to_string(next_) + " at " + shown(static_cast<double>(slot) * slot_s) +
                     " s of the path needs the slot of the pulse before it: the spot moves at " +
                     shown(spacing_.max_speed_mm_s) + " mm/s, pulses " + to_decimal_string(plan_.line.pixel_pitch_um) +
                     " um apart reach " + shown(to_double(plan_.line.scan_speed_m_s) * kUmPerMm) +
                     " mm/s: lower the feed or laser.pulse_divider, or raise the pitch"};
  }
  if (slot >= plan_.rotary.lines_per_revolution * slots) {
    return Error{ErrorCode::bad_argument, "pulse " + std::to_string(next_) +
                                              " belongs to the last half slot of the path: let the motion go on "
                                              "for a servo period"};
  }
  if (last_slot_ >= 0) {
    spacing_.least_slots = std::min(spacing_.least_slots, moment - last_moment_);
  }
  if (bit_of(pulses_.bits, next_)) {
    if (inside < slots) {
      set_bit(bits, inside);
    } else {
      carried_ = true;
    }
    ++spacing_.fired;
  }
  const double error_um = wrong_counts / counts_per_mm_ * kUmPerMm;
  spacing_.max_error_um = std::max(spacing_.max_error_um, std::abs(error_um));
  squares_ += error_um * error_um;
  last_slot_ = slot;
  last_moment_ = moment;
  ++next_;
  return {};
}

Result<void> PathSlots::finish() const {
  if (next_ < pulses_.count) {
    return Error{ErrorCode::bad_argument,
                 "the path ends before pulse " + std::to_string(next_) + " of " + std::to_string(pulses_.count) + ": " +
                     shown((static_cast<double>(next_) + 0.5) * pitch_counts_ / counts_per_mm_) +
                     " mm of it are wanted there; give fewer pulses or a longer path"};
  }
  return {};
}

PathSpacing PathSlots::spacing() const {
  PathSpacing spacing = spacing_;
  spacing.pulses = next_;
  spacing.rms_error_um = next_ > 0 ? std::sqrt(squares_ / static_cast<double>(next_)) : 0;
  spacing.half_slot_um = spacing.max_speed_mm_s * kUmPerMm / to_double(plan_.clock.pulse_hz) / 2;
  spacing.least_slots = next_ > 1 ? spacing.least_slots : 0;
  return spacing;
}

}  // namespace gravure
