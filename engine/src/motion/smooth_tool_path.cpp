#include "gravure/motion/smooth_tool_path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace gravure::motion {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;
constexpr std::size_t kMostRounds = 8;

class Smoother {
 public:
  explicit Smoother(const SmoothPathRequest& request)
      : r_(request), wanted_(request.c_deg.begin(), request.c_deg.end()), turned_(request.path.size(), 0) {}

  Result<SmoothPath> run() {
    GRAVURE_TRY(result_.a, smoothed(r_.a_deg));
    for (result_.rounds = 1; result_.rounds <= kMostRounds; ++result_.rounds) {
      GRAVURE_TRY(result_.c, smoothed(wanted_));
      place_tools();
      GRAVURE_TRY(const bool clear, turn_what_touches());
      if (clear) {
        measure();
        return std::move(result_);
      }
    }
    return Error{
        ErrorCode::out_of_range,
        fmt::format(
            "{}: still {} mm too deep after {} rounds of turning C and smoothing; take a slimmer tool or beam, or a "
            "smaller tolerance",
            touching_, depth_mm_, kMostRounds)};
  }

 private:
  Result<Unreversed> smoothed(std::span<const double> angle) const {
    return remove_reversals({r_.parameter, angle, r_.tolerance_deg, r_.control_points});
  }

  void place_tools() {
    result_.tools.clear();
    for (std::size_t k = 0; k < r_.path.size(); ++k) {
      result_.tools.push_back(
          tilted(r_.path[k], r_.ball_radius_mm, result_.a.angle[k] * kDegree, result_.c.angle[k] * kDegree));
    }
  }

  /// Place 0 is the sample itself, the others are its stops.
  std::string name_of(std::size_t sample, std::size_t place, std::size_t next_stop) const {
    const std::size_t line = place > 0 ? r_.stops[next_stop - places_.size() + place].line : 0;
    if (line > 0) {
      return fmt::format("line {}", line);
    }
    return r_.line_of_sample.empty() ? fmt::format("sample {}", sample + 1)
                                     : fmt::format("line {}", r_.line_of_sample[sample]);
  }

  /// The tool at a sample and at its stops.
  void take_places(std::size_t sample, std::size_t& next_stop) {
    places_.assign(1, result_.tools[sample]);
    for (; next_stop < r_.stops.size() && r_.stops[next_stop].sample == sample; ++next_stop) {
      places_.push_back(tilted({r_.stops[next_stop].centre_mm, r_.path[sample].axis}, r_.ball_radius_mm,
                               result_.a.angle[sample] * kDegree, result_.c.angle[sample] * kDegree));
    }
  }

  /// True where nothing touched; otherwise the C of what touched is turned.
  Result<bool> turn_what_touches() {
    const Surroundings& around = r_.around;
    result_.clearance_mm = std::numeric_limits<double>::infinity();
    bool clear = true;
    TurnFirst first = TurnFirst::up;
    std::size_t next_stop = 0;
    for (std::size_t k = 0; k < r_.path.size() && !around.points.empty(); ++k) {
      take_places(k, next_stop);
      const Interference found = find_interference(places_, around.shape, around.points, around.margin_mm);
      result_.clearance_mm = std::min(result_.clearance_mm, -found.depth_mm);
      if (!found.touches) {
        continue;
      }
      touching_ = name_of(k, found.place, next_stop);
      depth_mm_ = found.depth_mm;
      const auto cleared = turn_clear(places_, around.shape, around.points, around.margin_mm, r_.ball_radius_mm,
                                      around.c_step_rad, around.c_most_rad, first);
      if (!cleared) {
        return Error{cleared.error().code, touching_ + ": " + cleared.error().message};
      }
      const double turned = cleared.value().turned_rad / kDegree;
      first = turned > 0 ? TurnFirst::up : TurnFirst::down;  // neighbours the same way
      wanted_[k] = result_.c.angle[k] + turned;
      turned_[k] = wanted_[k] - r_.c_deg[k];
      clear = false;
    }
    return clear;
  }

  /// Deviations from what was wanted at first.
  void measure() {
    Unreversed& c = result_.c;
    c.largest_deviation = 0;
    double squares = 0;
    for (std::size_t k = 0; k < r_.c_deg.size(); ++k) {
      const double off = std::abs(c.angle[k] - r_.c_deg[k]);
      c.largest_deviation = std::max(c.largest_deviation, off);
      squares += off * off;
      result_.turned_samples += turned_[k] != 0 ? 1 : 0;
      result_.largest_turn_deg = std::max(result_.largest_turn_deg, std::abs(turned_[k]));
    }
    c.rms_deviation = std::sqrt(squares / static_cast<double>(r_.c_deg.size()));
    c.reversals_before = count_reversals(r_.c_deg);
  }

  const SmoothPathRequest& r_;
  std::vector<double> wanted_;    ///< C, with what was turned out of the way
  std::vector<double> turned_;    ///< by how much
  std::vector<ToolPose> places_;  ///< of the sample that is being tested
  SmoothPath result_;
  std::string touching_;  ///< what touched last
  double depth_mm_ = 0;
};

}  // namespace

Result<SmoothPath> smooth_tool_path(const SmoothPathRequest& r) {
  if (r.path.size() != r.a_deg.size() || r.path.size() != r.c_deg.size()) {
    return Error{ErrorCode::out_of_range,
                 fmt::format("smooth_tool_path: {} poses, {} angles of A and {} of C: one of each for every sample is "
                             "needed",
                             r.path.size(), r.a_deg.size(), r.c_deg.size())};
  }
  const auto by_sample = [](const HeldStop& a, const HeldStop& b) { return a.sample < b.sample; };
  if (!std::is_sorted(r.stops.begin(), r.stops.end(), by_sample) ||
      (!r.stops.empty() && r.stops.back().sample >= r.path.size()) ||
      (!r.line_of_sample.empty() && r.line_of_sample.size() != r.path.size())) {
    return Error{ErrorCode::out_of_range,
                 fmt::format("smooth_tool_path: stops must be in the order of their {} samples, and lines as many as "
                             "samples",
                             r.path.size())};
  }
  return Smoother(r).run();
}

}  // namespace gravure::motion
