#include "residual_kernel.hpp"

namespace gravure::motion {

ResidualKernel::ResidualKernel(std::span<const Mode> modes, BandOf of) noexcept {
  for (const Mode& mode : modes) {
    const ModeConstants m = constants_of(mode.f_hz, mode.zeta);
    const std::complex<double> scale = -mode.participation / m.rad_per_s;
    scale_[count_] = of == BandOf::position ? twice_integrated(scale, m) : scale;
    modes_[count_++] = m;
  }
}

Turns ResidualKernel::turns(double duration_s) const noexcept {
  Turns turns;
  for (std::size_t i = 0; i < count_; ++i) {
    turns[i] = exp_of(modes_[i], duration_s);
  }
  return turns;
}

ResidualSignal ResidualKernel::residual(const Durations& d, double velocity) const noexcept {
  return residual(turns(d.jerk_s), turns(d.up_s), turns(d.down_s), turns(d.cruise_s), d, velocity);
}

ResidualSignal ResidualKernel::residual(const Turns& jerk, const Turns& up, const Turns& down, const Turns& cruise,
                                        const Durations& d, double velocity) const noexcept {
  ResidualSignal signal;
  const double a_up = velocity / d.up_s;
  const double a_down = velocity / d.down_s;
  for (std::size_t i = 0; i < count_; ++i) {
    const std::complex<double> ramp = d.jerk_s > 0 ? (jerk[i] - 1.0) / d.jerk_s : modes_[i].lambda;
    const std::complex<double> rising = times(times(up[i] - 1.0, cruise[i]), times(down[i], jerk[i])) * a_up;
    const std::complex<double> falling = (down[i] - 1.0) * a_down;
    signal.add({times(scale_[i], times(ramp, rising - falling)), modes_[i].decay_per_s, modes_[i].rad_per_s});
  }
  return signal;
}

}  // namespace gravure::motion
