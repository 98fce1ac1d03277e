#include "gravure/fpga/ab_generator.hpp"

#include "gravure/fpga/ab_registers.hpp"

namespace gravure::fpga {
namespace {

std::uint64_t mask_of(int bits) noexcept {
  return ~std::uint64_t{0} >> static_cast<unsigned>(64 - bits);
}

}  // namespace

AbGenerator::AbGenerator(const Widths& widths) noexcept
    : count_mask_(mask_of(widths.bits)),
      prescaler_mask_(mask_of(widths.prescaler_bits)),
      fraction_mask_(mask_of(widths.fraction_bits)),
      quarter_shift_(static_cast<unsigned>(widths.bits - 2)) {}

bool AbGenerator::increment_fits(std::uint64_t increment, std::uint64_t num) const noexcept {
  const std::uint64_t quarter = std::uint64_t{1} << quarter_shift_;
  return num == 0 ? increment <= quarter : increment < quarter;
}

void AbGenerator::advance() noexcept {
  if (phase_ != period_ - 1) {
    ++phase_;
    return;
  }
  phase_ = 0;
  const bool carry = acc_ >= den_minus_num_;
  acc_ = carry ? acc_ - den_minus_num_ : acc_ + num_;
  out_.count = (out_.count + step_ + (carry ? 1U : 0U)) & count_mask_;
}

void AbGenerator::load(const Inputs& inputs) noexcept {
  const std::uint64_t increment = inputs.increment & count_mask_;
  if (!inputs.load) {
    out_.refused = !increment_fits(increment, num_);
    step_ = out_.refused ? step_ : increment;
    return;
  }
  const std::uint64_t num = inputs.fraction_num & fraction_mask_;
  const std::uint64_t den = inputs.fraction_den & fraction_mask_;
  const std::uint64_t period = inputs.prescaler & prescaler_mask_;
  out_.refused = !(num < den && period != 0 && increment_fits(increment, num));
  if (!out_.refused) {
    step_ = increment;
    period_ = period;
    phase_ = 0;
    num_ = num;
    den_minus_num_ = den - num;
    acc_ = 0;
  }
}

AbGenerator::Outputs AbGenerator::step(const Inputs& inputs) noexcept {
  if (inputs.rst) {
    step_ = phase_ = num_ = acc_ = 0;
    period_ = den_minus_num_ = 1;
    return out_ = {};
  }
  const AbPins pins = pins_of_quarter(out_.count >> quarter_shift_);  // before the counter moves
  out_.a = pins.a;
  out_.b = pins.b;
  if (inputs.enable) {
    advance();
  }
  if (inputs.load || inputs.load_increment) {
    load(inputs);
  }
  return out_;
}

}  // namespace gravure::fpga
