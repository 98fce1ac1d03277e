#pragma once

#include <vector>

#include "gravure/core/exposure_map.hpp"
#include "gravure/core/plan.hpp"
#include "gravure/core/program.hpp"
#include "gravure/scan/landing.hpp"
#include "gravure/scan/plan_trajectory.hpp"

namespace gravure::scan {

/// Which line of a job.
struct LineNumber {
  std::int64_t revolution = 0;
  std::int64_t line = 0;
};

/// Where everything stands when the pulse of a slot fires (or would).
struct SlotState {
  std::int64_t tick = 0;  ///< from the start of the job
  kinematics::FieldPoint mirrors;
  /// Of the machine of the mode: c (rad, turns counted from line 0), x, z; or x, y, z (mm). x and y put column and line
  /// 0 of the image at 0 on the workpiece.
  kinematics::JointPositions joints;
  kinematics::Vector3 spot_mm = kinematics::Vector3::Zero();  ///< on the surface, in the workpiece's frame
};

/// The trajectories of all lines of a job: those of plan_trajectory(), with what tells one line from another. In flat
/// jobs of several passes the stage comes back; in helical jobs U takes up the fraction of a column at which a line
/// starts, and goes from one fraction to the next in the turn, smoothly. In bands the head stands further along.
class JobTrajectory {
 public:
  /// Fails as plan_trajectory() does.
  static Result<JobTrajectory> make(const Plan& plan);

  /// What the lines of a revolution (pass) have in common.
  const LineTrajectory& of_revolution(std::int64_t revolution) const noexcept;
  Direction direction_of(const LineNumber& number) const noexcept;
  /// The set-points of a line, one for each microvector. Fails with out_of_range where the field grid ends.
  Result<std::vector<SetPoint>> set_points(const LineNumber& number) const;
  /// What is added to U at a time of a line: helical jobs alone. Any slot, also of neighbouring lines.
  double shift_mm(const LineNumber& number, double slot) const;
  /// At the pulse of a slot of a line. Fails as set_points().
  Result<SlotState> at(const LineNumber& number, std::int64_t slot, const LandingModel& model) const;
  /// The point of the workpiece that a pixel of a line is meant for: its column along x, its image line round the
  /// circumference or along y. In the first line's frame of SlotState.
  kinematics::Vector3 target_of(const LineNumber& number, std::int64_t pixel) const;

  /// What a program stores: the set-points of each way that lines run, of a helical job those of lines that start on a
  /// whole column.
  std::vector<LineSetPoints> stored_set_points() const;
  /// Are the set-points that a program stores those of this trajectory, each? Fails with bad_file, naming the first
  /// that is not. None at all are: older programs have none.
  Result<void> check_stored(const std::vector<LineSetPoints>& stored) const;

  const Plan& plan() const noexcept { return plan_; }

 private:
  explicit JobTrajectory(const Plan& plan);
  std::int64_t ordinal_of(const LineNumber& number) const noexcept;
  LineNumber number_of(std::int64_t ordinal) const noexcept;
  double fraction_mm(std::int64_t ordinal) const noexcept;
  Result<SetPoint> set_point(std::int64_t ordinal, std::int64_t index) const;
  Result<kinematics::FieldPoint> mirrors_at(std::int64_t ordinal, double slot, const LandingModel& model) const;
  kinematics::JointPositions joints_at(const LineNumber& number, double slot, bool turns_counted) const;
  double head_mm(const LineNumber& number) const;

  Plan plan_;
  ExposureMap map_;
  double pitch_mm_ = 0;
  std::int64_t feed_num_ = 0;  ///< columns a line of a helical job, in lowest terms
  std::int64_t feed_den_ = 1;
  std::vector<LineTrajectory> sweeps_;  ///< onwards, and backwards where the stage comes back
};

}  // namespace gravure::scan
