#pragma once

#include <vector>

#include "gravure/texture/path_timing.hpp"
#include "gravure/texture/prove_limits.hpp"
#include "path_feed.hpp"
#include "path_instants.hpp"
#include "slow_stages.hpp"

namespace gravure::texture {

/// Finds the times of all runs: first by the galvo, then slower where stages need it.
class SevenAxisPlanner {
 public:
  /// The request must be in order, and outlive the planner.
  explicit SevenAxisPlanner(const PathTimingRequest& request);
  /// Slows runs until no look finds a stage beyond its limits.
  Result<void> settle(const CancelToken& cancel);
  /// For the breaches of a proof.
  Needs needs() const { return Needs(path_); }
  /// Takes one down.
  void note(const LimitUse& breach, Needs& needs) const;
  /// Slows what they ask for.
  Result<void> lower(const Needs& needs);
  TimedPath timed() const;

 private:
  /// The first times, by the galvo alone.
  Result<void> start();
  /// Feeds, times and the stages' place, after something has been slowed.
  Result<void> retime();
  const PathTimingRequest& request_;
  PathRuns path_;
  PathFeed feed_;
  StageSpline stages_;
  SmoothPlace place_;
  std::vector<double> corner_feed_;  ///< empty: no corner law
  std::int64_t cell_ = 2;
  int passes_ = 0;
};

}  // namespace gravure::texture
