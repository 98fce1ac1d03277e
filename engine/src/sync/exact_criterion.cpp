#include "exact_criterion.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <numeric>

namespace gravure::sync_plan {

OddPart odd_part(std::uint64_t value) {
  const int twos = std::countr_zero(value);
  return {.odd = value >> static_cast<unsigned>(twos), .twos = twos};
}

ExactCriterion::ExactCriterion(const Job& job, const Plan& plan)
    : counter_bits_(job.fpga.counter_bits),
      wanted_(odd_part(static_cast<std::uint64_t>(job.rotary.encoder_lines) *
                       static_cast<std::uint64_t>(job.rotary.gear_encoder_turns))) {
  wanted_.twos += job.rotary.interpolation_bits;
  const OddPart slot = odd_part(static_cast<std::uint64_t>(plan.clock.ticks_per_slot));
  const OddPart gear = odd_part(static_cast<std::uint64_t>(job.rotary.gear_workpiece_turns));
  fixed_twos_ = slot.twos + gear.twos;
  const Integer fixed_odd = Integer(slot.odd) * gear.odd;  // beyond 64 bits for extreme dividers
  const Integer shared = gcd(fixed_odd, Integer(wanted_.odd));
  wanted_.odd /= static_cast<std::uint64_t>(shared);
  most_den_ = static_cast<std::uint64_t>(Integer(job.fpga.max_prescaler / Integer(fixed_odd / shared)));
  // wanted_hz <= max_ab_hz  <=>  np nL >= pulse_hz edges / (4 max_ab_hz). np nL stays below 2^62.
  const Integer least =
      ceil_of(plan.clock.pulse_hz * plan.rotary.edges_per_revolution / Rational(4 * Integer(job.rotary.max_ab_hz)));
  least_steps_ = static_cast<std::uint64_t>(std::min(least, Integer(std::numeric_limits<std::uint64_t>::max())));
}

void ExactCriterion::set_slots(std::int64_t slots) {
  slots_ = static_cast<std::uint64_t>(slots);
  const OddPart part = odd_part(slots_);
  const std::uint64_t shared = std::gcd(wanted_.odd, part.odd);
  left_ = wanted_.odd / shared;
  slots_odd_ = part.odd / shared;
  slots_twos_ = part.twos;
}

bool ExactCriterion::fits(std::int64_t lines_per_revolution) const {
  const auto lines = static_cast<std::uint64_t>(lines_per_revolution);
  const int lines_twos = std::countr_zero(lines);
  // Numerator <= 2^(n-2): odd numerator * 2^(n + N's twos - D's twos). A twos' balance below 0 goes to the denominator.
  const int spare = fixed_twos_ + slots_twos_ + lines_twos - wanted_.twos;
  if (spare < 2 || slots_ * lines < least_steps_) {
    return false;
  }
  const std::uint64_t lines_odd = lines >> static_cast<unsigned>(lines_twos);
  const std::uint64_t shared = std::gcd(left_, lines_odd);
  const int num_bits = std::min(spare, counter_bits_) - 2;
  const int den_bits = std::max(0, spare - counter_bits_);
  const bool num_fits = left_ / shared <= std::uint64_t{1} << static_cast<unsigned>(num_bits);
  const bool den_fits =
      den_bits < 64 && slots_odd_ * (lines_odd / shared) <= most_den_ >> static_cast<unsigned>(den_bits);
  return num_fits && den_fits;
}

}  // namespace gravure::sync_plan
