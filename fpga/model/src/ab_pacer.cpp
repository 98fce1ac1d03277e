#include "gravure/fpga/ab_pacer.hpp"

namespace gravure::fpga {
namespace {

std::uint64_t mask_of(int bits) noexcept {
  return ~std::uint64_t{0} >> static_cast<unsigned>(64 - bits);
}

}  // namespace

AbPacer::AbPacer(const Widths& widths) noexcept
    : count_mask_(mask_of(widths.bits)),
      prescaler_mask_(mask_of(widths.prescaler_bits)),
      fraction_mask_(mask_of(widths.fraction_bits)),
      quarter_(std::uint64_t{1} << static_cast<unsigned>(widths.bits - 2)),
      with_fraction_(widths.fraction) {}

/// The last stage: what the accumulator sees.
void AbPacer::words(const Inputs& in) noexcept {
  out_.due = word_due_;
  out_.carry = less_ & word_due_;
  const std::uint64_t increment = in.increment & count_mask_;
  const bool fits = !over(increment) && !(increment == quarter_ && has_fraction_);
  const bool taken = in.load_increment && !in.load && !out_.busy;
  if (loading(7)) {
    out_.step = load_.step;
    out_.back = load_.back;
    has_fraction_ = !load_.num_zero;
  } else if (next_step_ok_) {
    out_.step = next_step_;
  }
  if (loading(2)) {
    out_.refused = !load_.ok;
  }
  out_.refused = (out_.refused && !next_step_ok_) || next_step_bad_;
  next_step_ = increment;
  next_step_ok_ = taken && fits;
  next_step_bad_ = (taken && !fits) || (out_.busy && (in.load || in.load_increment));
}

/// Two steps of acc += num modulo den a clock, when two are due; a carry is a sum less than num.
void AbPacer::fraction() noexcept {
  word_due_ = add_due_;
  less_ = with_fraction_ ? (add_x_ < num_ ? 1U : 0U) | (add_y_ < num_ ? 2U : 0U) : 0U;
  if (loading(5)) {
    num_ = load_.num;
  }
  add_due_ = pace_due_;
  add_x_ = x_;
  add_y_ = two_ ? y_ : x_;
  const auto advanced = [this](std::uint64_t sum) {
    return (sum >= below_ ? sum - below_ : sum + addend_) & fraction_mask_;
  };
  if (loading(4)) {
    x_ = load_.num;
    y_ = load_.num_2;
    addend_ = load_.one ? load_.num_2 : load_.num;
    below_ = load_.one ? load_.rest_2 : load_.rest;
    two_ = load_.one;
  } else if (pace_due_ != 0) {
    x_ = advanced(x_);
    y_ = advanced(y_);
  }
}

void AbPacer::pace(bool enable) noexcept {
  const bool first = left_ == 1;
  const bool second = left_ == 2 || (first && every_);
  pace_due_ = enable ? (first ? 1U : 0U) | (second ? 2U : 0U) : 0U;
  if (loading(3)) {
    left_ = period_ = load_.period;
    period_less_ = load_.period_less;
    every_ = load_.one;
  } else if (enable) {
    if (first) {
      left_ = every_ ? period_ : period_less_;
    } else {
      left_ = left_ == 2 ? period_ : (left_ - 2) & prescaler_mask_;
    }
  }
}

/// Stages 0 to 2 of a load, the last first.
void AbPacer::check_load(const Inputs& in) noexcept {
  Load& l = load_;
  const bool fraction_ok = with_fraction_ ? !l.improper && l.rest != 0 : l.num_zero;
  const bool passed = l.ok;
  l.ok = !l.over && !l.zero && fraction_ok && (l.num_zero || !l.quarter);
  l.num_2 = (l.wraps ? l.twice : l.num << 1U) & fraction_mask_;
  l.rest_2 = (l.wraps ? l.rest << 1U : 0 - l.twice) & fraction_mask_;
  l.twice = (l.num - l.rest) & fraction_mask_;
  l.wraps = l.num >= l.rest;
  l.rest = (l.den - l.num) & fraction_mask_;
  l.improper = l.num > l.den;
  l.num_zero = l.num == 0 && (with_fraction_ || l.den != 0);
  l.zero = l.period == 0;
  l.one = l.period == 1;
  l.period_less = (l.period - 1) & prescaler_mask_;
  const bool taken = in.load && !out_.busy;
  if (taken) {
    l.step = in.increment & count_mask_;
    l.back = in.backward;
    l.over = over(l.step);
    l.quarter = l.step == quarter_;
    l.period = in.prescaler & prescaler_mask_;
    l.num = in.fraction_num & fraction_mask_;
    l.den = in.fraction_den & fraction_mask_;
  }
  const unsigned shifted = (loading_ << 1U) & 0xF7U;
  loading_ = shifted | (loading(2) && passed ? 8U : 0U) | (taken ? 1U : 0U);
  out_.busy = loading_ != 0;
}

AbPacer::Outputs AbPacer::step(const Inputs& inputs) noexcept {
  if (inputs.rst) {
    loading_ = pace_due_ = add_due_ = word_due_ = less_ = 0;
    left_ = period_ = below_ = 1;
    period_less_ = x_ = y_ = addend_ = num_ = 0;
    every_ = two_ = true;
    has_fraction_ = next_step_ok_ = next_step_bad_ = false;
    return out_ = {};
  }
  words(inputs);
  fraction();
  pace(inputs.enable);
  check_load(inputs);
  return out_;
}

}  // namespace gravure::fpga
