#include "gravure/fpga/ab_edges.hpp"

namespace gravure::fpga {
namespace {

constexpr std::uint64_t kMaxClock = std::numeric_limits<std::uint64_t>::max();

Uint128 common_divisor(Uint128 a, Uint128 b) noexcept {
  while (b != 0) {
    const Uint128 rest = a % b;
    a = b;
    b = rest;
  }
  return a;
}

/// steps * prescaler, or kMaxClock where 64 bits do not hold it.
std::uint64_t clocks_of(Uint128 steps, std::uint64_t prescaler) noexcept {
  return steps > kMaxClock / prescaler ? kMaxClock : static_cast<std::uint64_t>(steps) * prescaler;
}

}  // namespace

AbPosition position_after(const AbRegisters& registers, std::uint64_t clock) noexcept {
  AbPosition position;
  position.steps = clock / registers.prescaler;
  const Uint128 scaled = static_cast<Uint128>(position.steps) * registers.fraction_num;
  const Uint128 carries = scaled / registers.fraction_den;
  position.accumulator = static_cast<std::uint64_t>(scaled - carries * registers.fraction_den);
  position.counts = static_cast<Uint128>(position.steps) * registers.increment + carries;
  position.edges = static_cast<std::uint64_t>(position.counts >> static_cast<unsigned>(registers.bits - 2));
  position.pins = pins_of_quarter(position.edges);
  return position;
}

AbEdges::AbEdges(const AbRegisters& registers) noexcept : registers_(registers) {
  const Uint128 p = static_cast<Uint128>(registers.increment) * registers.fraction_den + registers.fraction_num;
  const Uint128 q = static_cast<Uint128>(registers.fraction_den) << static_cast<unsigned>(registers.bits - 2);
  if (p == 0) {
    exhausted_ = true;
    return;
  }
  common_ = common_divisor(q, p);
  reduced_p_ = p / common_;
  reduced_q_ = q / common_;
  wide_ = reduced_q_ > kMaxClock;  // P <= Q
  const Uint128 quotient = reduced_q_ / reduced_p_;
  wide_walk_.rest = reduced_q_ - quotient * reduced_p_;
  wide_walk_.back = reduced_p_ - wide_walk_.rest;
  narrow_walk_.rest = static_cast<std::uint64_t>(wide_walk_.rest);
  narrow_walk_.back = static_cast<std::uint64_t>(wide_walk_.back);
  short_gap_ = clocks_of(quotient, registers.prescaler);
  long_gap_ = clocks_of(quotient + 1, registers.prescaler);
  seek(0);
}

std::optional<AbEdges> AbEdges::make(const AbRegisters& registers) noexcept {
  if (check(registers) != AbRefusal::none) {
    return std::nullopt;
  }
  return AbEdges(registers);
}

void AbEdges::seek(std::uint64_t clock) noexcept {
  const AbPosition position = position_after(registers_, clock);
  edges_ = position.edges;
  if (reduced_p_ == 0) {
    return;
  }
  // K P - e Q: how far past the last edge the counter is, in units of 1/den; less than Q, and a multiple of common_.
  const Uint128 quarter = Uint128{1} << static_cast<unsigned>(registers_.bits - 2);
  const Uint128 past = (position.counts & (quarter - 1)) * registers_.fraction_den + position.accumulator;
  const Uint128 missing = reduced_q_ - past / common_;
  const Uint128 steps = (missing + (reduced_p_ - 1)) / reduced_p_;
  wide_walk_.slack = steps * reduced_p_ - missing;
  narrow_walk_.slack = static_cast<std::uint64_t>(wide_walk_.slack);
  // steps <= Q < 2^127: the sum cannot overflow.
  const Uint128 next_step = steps + position.steps;
  exhausted_ = next_step > kMaxClock / registers_.prescaler;
  next_clock_ = exhausted_ ? kMaxClock : static_cast<std::uint64_t>(next_step) * registers_.prescaler;
}

}  // namespace gravure::fpga
