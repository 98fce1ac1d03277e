#pragma once

#include <vector>

#include "gravure/kinematics/machines.hpp"
#include "gravure/texture/path_timing.hpp"
#include "gravure/texture/split.hpp"

namespace gravure::texture::test {

/// A path on a surface, split and ready to be timed on the texturing machine with its published limits. The request
/// looks into the rest of it, so it stays where it was made.
struct TimingCase {
  TimingCase(const Surface& surface, const TexturePath& path, const GaussianFilter& how,
             const Vector3& rotary_centre_mm, Stops stops) {
    split = split_path(surface, path, how).value();
    machine = kinematics::xyzac_machine(kinematics::XyzacSigns::texturing, rotary_centre_mm, {});
    axes = seven_axes(machine, split.targets, split.stages).value();
    pulse_mm = pulse_lengths_mm(path, split.targets);
    request.targets = split.targets;
    request.axes = axes;
    request.pulse_mm = pulse_mm;
    request.table = rotary_table(machine).value();
    request.limits = published_limits();
    request.stops = stops;
    request.sigma_points = how.sigma_mm / path.step_mm;
  }
  TimingCase(const TimingCase&) = delete;
  TimingCase& operator=(const TimingCase&) = delete;

  Split split;
  kinematics::Machine machine;
  std::vector<SevenAxes> axes;
  std::vector<double> pulse_mm;
  PathTimingRequest request;
};

}  // namespace gravure::texture::test
