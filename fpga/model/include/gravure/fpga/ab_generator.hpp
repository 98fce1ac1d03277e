#pragma once

#include <cstdint>

namespace gravure::fpga {

/// Bit-exact model of fpga/rtl/ab_generator.v: one step() is one rising edge of the FPGA clock.
///
/// AbCounter is what this block does after one load; here are the load port, the checks and the output register too.
/// A and B follow the counter by kLatency clocks. Values wider than their register are cut to it, like wires.
class AbGenerator {
 public:
  static constexpr int kLatency = 1;  ///< clocks from AbCounter's pins to a and b

  struct Widths {
    int bits = 32;
    int prescaler_bits = 32;
    int fraction_bits = 34;
  };
  struct Inputs {
    bool rst = false;
    bool enable = false;          ///< low: everything stands
    bool load = false;            ///< takes all registers, starts a new count of clocks, keeps the counter
    bool load_increment = false;  ///< takes the increment alone, without a gap
    std::uint64_t increment = 0;
    std::uint64_t prescaler = 0;
    std::uint64_t fraction_num = 0;
    std::uint64_t fraction_den = 0;
  };
  struct Outputs {
    bool a = false;
    bool b = false;
    bool refused = false;  ///< the last load would have broken a rule and changed nothing
    std::uint64_t count = 0;
  };

  explicit AbGenerator(const Widths& widths) noexcept;
  Outputs step(const Inputs& inputs) noexcept;

 private:
  bool increment_fits(std::uint64_t increment, std::uint64_t num) const noexcept;
  void advance() noexcept;
  void load(const Inputs& inputs) noexcept;

  std::uint64_t count_mask_;
  std::uint64_t prescaler_mask_;
  std::uint64_t fraction_mask_;
  unsigned quarter_shift_;
  std::uint64_t step_ = 0;
  std::uint64_t period_ = 1;
  std::uint64_t phase_ = 0;
  std::uint64_t num_ = 0;
  std::uint64_t den_minus_num_ = 1;
  std::uint64_t acc_ = 0;
  Outputs out_;
};

}  // namespace gravure::fpga
