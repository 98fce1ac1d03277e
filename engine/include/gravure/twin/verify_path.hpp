#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gravure/core/path_motion.hpp"
#include "gravure/core/program.hpp"
#include "gravure/core/progress.hpp"
#include "gravure/kinematics/machine.hpp"
#include "gravure/twin/exposure.hpp"

namespace gravure {

/// The machine that a path plan names: joints X Y Z A C, head with U and V; W is the place in its field along the beam.
kinematics::Machine path_machine(const PathPlan& path);

/// The most that is asked of an axis: mm or degrees, and per s, s^2 and s^3, by the cubics of the stored set-points
/// (core/path_expand.hpp) at ten places a period.
struct AxisUse {
  double least = 0;
  double most = 0;
  double max_speed = 0;
  double max_acceleration = 0;
  double max_jerk = 0;
  /// What the rounding of set-points to counts may add to these three, and a limit allows for.
  double speed_rounding = 0;
  double acceleration_rounding = 0;
  double jerk_rounding = 0;
};

/// The largest of a figure over all pulses that fired.
struct PulseFigure {
  double max = 0;
  double rms = 0;
  std::int64_t worst_pulse = -1;
};

struct PathReport {
  std::int64_t lines = 0;  ///< executed by the device
  std::int64_t ticks = 0;
  std::int64_t pulses = 0;              ///< along the path
  std::int64_t fired = 0;               ///< what the gate let through
  bool bits_compared = false;           ///< with `wanted`
  std::int64_t misplaced = 0;           ///< fired in a slot that is not the nearest to any pulse's place, or twice
  std::int64_t missing = 0;             ///< wanted and not fired
  std::int64_t unwanted = 0;            ///< fired though their bit is 0
  PulseFigure spacing_um;               ///< along the path, from where the pulse belongs
  double half_slot_um = 0;              ///< half a slot at the greatest speed of a pulse
  bool points_compared = false;         ///< with wanted points
  PulseFigure focus_offset_um;          ///< FOD: the wanted point from focus, along the beam
  PulseFigure incidence_deg;            ///< BIA: beam and normal of the surface
  PulseFigure displacement_mm;          ///< of the galvo from its centre
  PulseFigure landing_um;               ///< from the wanted point to the beam, across it
  std::vector<AxisUse> axes;            ///< those of the plan
  std::vector<std::string> violations;  ///< each once, with where; empty: within limits
  std::vector<std::string> notes;
};

/// Where a pulse that fired has landed.
struct LandedPulse {
  std::int64_t pulse = 0;
  std::int64_t tick = 0;  ///< since the begin of the path
  kinematics::Spot spot;
};

struct VerifyPathOptions {
  /// The bits that the job asks for; none: not compared, and said in a note.
  const PathPulses* wanted = nullptr;
  /// The points that the job asks for; empty: those that the program stores.
  std::span<const PathTarget> targets = {};
  /// Told of every pulse in order of time.
  std::function<Result<void>(const LandedPulse&)> landed = {};
  CancelToken* cancel = nullptr;
  Progress* progress = nullptr;
};

/// Runs every line of a path program through a device, takes each slot that fired, lets the axes move between the
/// stored set-points, and puts the pulse on the workpiece by the kinematics: where it lies from the point wanted there,
/// and every limit of the plan. Violations are reported, not errors. Fails with bad_argument for other programs,
/// bad_file for a damaged one, device where the device refuses, cancelled.
Result<PathReport> verify_path(LineSource& program, const DeviceFactory& devices, const VerifyPathOptions& options);

}  // namespace gravure
