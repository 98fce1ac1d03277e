#include "gravure/motion/smooth_tool_path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "vector3.hpp"

namespace gravure::motion {
namespace {

constexpr std::size_t kMostRounds = 8;
constexpr const char* kAddPoints = ", or add points between the two";

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
            "{}: still {:.6g} mm too deep after {} rounds of turning C and smoothing; take a slimmer tool or beam, "
            "another tilt or a smaller tolerance{}",
            touching_, depth_mm_, kMostRounds, on_the_way_ ? kAddPoints : "")};
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

  std::string name_of(std::size_t sample) const {
    return r_.line_of_sample.empty() ? fmt::format("sample {}", sample + 1)
                                     : fmt::format("line {}", r_.line_of_sample[sample]);
  }

  void add_place(const ToolPose& tool, const std::string& name) {
    places_.push_back(tool);
    names_.push_back(name);
  }

  /// The tool at a sample, at its stops, and on the way from each to the next.
  Result<void> take_places(std::size_t sample, std::size_t& next_stop) {
    places_.clear();
    names_.clear();
    add_place(result_.tools[sample], name_of(sample));
    for (; next_stop < r_.stops.size() && r_.stops[next_stop].sample == sample; ++next_stop) {
      const HeldStop& stop = r_.stops[next_stop];
      const ToolPose there = tilted({stop.centre_mm, r_.path[sample].axis}, r_.ball_radius_mm,
                                    result_.a.angle[sample] * kDegree, result_.c.angle[sample] * kDegree);
      const std::string name = stop.line > 0 ? fmt::format("line {}", stop.line) : name_of(sample);
      const ToolPose from = places_.back();
      const std::string way = way_of(names_.back(), name);
      const double travel_mm = distance(from.centre_mm, there.centre_mm);
      if (!far_away(from, travel_mm)) {
        GRAVURE_TRY(const std::size_t pieces, pieces_for(travel_mm, way));
        for (std::size_t i = 1; i < pieces; ++i) {
          const double share = static_cast<double>(i) / static_cast<double>(pieces);
          add_place({between(from.centre_mm, there.centre_mm, share), there.axis}, way);
        }
      }
      add_place(there, name);
    }
    return {};
  }

  static Vector3 between(const Vector3& a, const Vector3& b, double share) noexcept {
    return {a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1]), a[2] + share * (b[2] - a[2])};
  }

  static std::string way_of(const std::string& from, const std::string& to) {
    return fmt::format("between {} and {}", from, to);
  }

  /// No point of the tool moves by more than half its reach in a piece: what passes between two tests is then at most a
  /// 31st of the reach deep.
  Result<std::size_t> pieces_for(double travel_mm, const std::string& way) const {
    constexpr double kLeastStep_mm = 0.02;
    constexpr double kMostPieces = 1e6;
    const double step_mm = std::max(kLeastStep_mm, (r_.around.shape.radius_mm + r_.around.margin_mm) / 2);
    const double pieces = std::max(1.0, std::ceil(travel_mm / step_mm));
    if (!(pieces <= kMostPieces)) {
      return Error{
          ErrorCode::out_of_range,
          fmt::format("{}: {:.6g} mm to test in steps of {} mm: more than {} steps; add points between the two", way,
                      travel_mm, step_mm, kMostPieces)};
    }
    return static_cast<std::size_t>(pieces);
  }

  /// How far any point of the tool moves, at most, while its angles sweep so much in sum. With straight axes the tip
  /// swings about the rotary centre as well.
  double sweep_mm(const ToolPose& from, const ToolPose& to, double swept_rad) const noexcept {
    const double arm_mm = r_.straight_axes_about_mm ? std::max(distance(from.centre_mm, *r_.straight_axes_about_mm),
                                                               distance(to.centre_mm, *r_.straight_axes_about_mm))
                                                    : 0;
    return distance(from.centre_mm, to.centre_mm) + (r_.around.shape.length_mm + 2 * arm_mm) * swept_rad;
  }

  /// True where nothing can touch as far as the tool moves from here.
  bool far_away(const ToolPose& from, double travel_mm) const {
    ToolShape around = r_.around.shape;
    around.length_mm += travel_mm;
    around.clear_from_mm -= travel_mm;
    const double reach_mm = r_.around.margin_mm + travel_mm * (1 + std::abs(around.widening));
    return !find_interference(from, around, r_.around.points, reach_mm).touches;
  }

  /// The tool on the way from the last place of a sample to the next sample: all axes move evenly, or the tip does.
  ToolPose on_the_way(const ToolPose& from, std::size_t sample, double share) const {
    const auto angle = [share, sample](const std::vector<double>& angles) {
      return (angles[sample] + share * (angles[sample + 1] - angles[sample])) * kDegree;
    };
    const ToolPose& to = result_.tools[sample + 1];
    AxisPose axes{0, 0, 0, angle(result_.a.angle), angle(result_.c.angle)};
    if (r_.straight_axes_about_mm) {
      const Vector3& centre = *r_.straight_axes_about_mm;
      const AxisPose a =
          axes_at(from.centre_mm, centre, result_.a.angle[sample] * kDegree, result_.c.angle[sample] * kDegree);
      const AxisPose b =
          axes_at(to.centre_mm, centre, result_.a.angle[sample + 1] * kDegree, result_.c.angle[sample + 1] * kDegree);
      axes.x_mm = a.x_mm + share * (b.x_mm - a.x_mm);
      axes.y_mm = a.y_mm + share * (b.y_mm - a.y_mm);
      axes.z_mm = a.z_mm + share * (b.z_mm - a.z_mm);
      return tool_of(axes, centre);
    }
    return {between(from.centre_mm, to.centre_mm, share), tool_of(axes, {}).axis};
  }

  /// Gives the blocks at both ends of what touches between them one C at which it and they are free: a turn between
  /// them then moves on to the blocks before or after, away from what is touched.
  Result<bool> turn_what_touches_after(std::size_t sample, TurnFirst& first) {
    const Surroundings& around = r_.around;
    const ToolPose from = places_.back();
    const ToolPose& to = result_.tools[sample + 1];
    const double swept = (std::abs(result_.a.angle[sample + 1] - result_.a.angle[sample]) +
                          std::abs(result_.c.angle[sample + 1] - result_.c.angle[sample])) *
                         kDegree;
    const double travel = sweep_mm(from, to, swept);
    if (far_away(from, travel)) {
      return true;
    }
    const std::string way = way_of(names_.back(), name_of(sample + 1));
    GRAVURE_TRY(const std::size_t pieces, pieces_for(travel, way));
    std::vector<ToolPose> deepest;
    double depth_mm = 0;
    double share = 0;
    for (std::size_t i = 1; i < pieces; ++i) {
      const ToolPose tool = on_the_way(from, sample, static_cast<double>(i) / static_cast<double>(pieces));
      const Interference found = find_interference(tool, around.shape, around.points, around.margin_mm);
      result_.clearance_mm = std::min(result_.clearance_mm, -found.depth_mm);
      if (found.touches && found.depth_mm > depth_mm) {
        depth_mm = found.depth_mm;
        const double c_rad = std::atan2(tool.axis[0], tool.axis[1]);
        const double a_rad = std::atan2(std::hypot(tool.axis[0], tool.axis[1]), tool.axis[2]);
        deepest = {tool, tilted(from, r_.ball_radius_mm, a_rad, c_rad), tilted(to, r_.ball_radius_mm, a_rad, c_rad)};
        share = static_cast<double>(i) / static_cast<double>(pieces);
      }
    }
    if (deepest.empty()) {
      return true;
    }
    touching_ = way;
    on_the_way_ = true;
    depth_mm_ = depth_mm;
    GRAVURE_TRY(const double turned, free_turn(deepest, first));
    const double c_deg =
        result_.c.angle[sample] + share * (result_.c.angle[sample + 1] - result_.c.angle[sample]) + turned;
    turn_sample(sample, c_deg);
    turn_sample(sample + 1, c_deg);
    return false;
  }

  Result<double> free_turn(const std::vector<ToolPose>& places, TurnFirst& first) const {
    const Surroundings& around = r_.around;
    const auto cleared = turn_clear(places, around.shape, around.points, around.margin_mm, r_.ball_radius_mm,
                                    around.c_step_rad, around.c_most_rad, first);
    if (!cleared) {
      return Error{cleared.error().code, touching_ + ": " + cleared.error().message + (on_the_way_ ? kAddPoints : "")};
    }
    const double turned = cleared.value().turned_rad / kDegree;
    first = turned > 0 ? TurnFirst::up : TurnFirst::down;  // neighbours the same way
    return turned;
  }

  void turn_sample(std::size_t sample, double c_deg) {
    wanted_[sample] = c_deg;
    turned_[sample] = wanted_[sample] - r_.c_deg[sample];
  }

  /// True where nothing touched; otherwise the C of what touched is turned.
  Result<bool> turn_what_touches() {
    const Surroundings& around = r_.around;
    result_.clearance_mm = std::numeric_limits<double>::infinity();
    bool clear = true;
    TurnFirst first = TurnFirst::up;
    std::size_t next_stop = 0;
    for (std::size_t k = 0; k < r_.path.size() && !around.points.empty(); ++k) {
      GRAVURE_CHECK(take_places(k, next_stop));
      const Interference found = find_interference(places_, around.shape, around.points, around.margin_mm);
      result_.clearance_mm = std::min(result_.clearance_mm, -found.depth_mm);
      if (found.touches) {
        touching_ = names_[found.place];
        on_the_way_ = false;
        depth_mm_ = found.depth_mm;
        GRAVURE_TRY(const double turned, free_turn(places_, first));
        turn_sample(k, result_.c.angle[k] + turned);
        clear = false;
      } else if (k + 1 < r_.path.size()) {
        GRAVURE_TRY(const bool free, turn_what_touches_after(k, first));
        clear = clear && free;
      }
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
  std::vector<double> wanted_;      ///< C, with what was turned out of the way
  std::vector<double> turned_;      ///< by how much
  std::vector<ToolPose> places_;    ///< of the sample that is being tested
  std::vector<std::string> names_;  ///< of these, for errors
  SmoothPath result_;
  std::string touching_;     ///< what touched last
  bool on_the_way_ = false;  ///< it did between two samples
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
