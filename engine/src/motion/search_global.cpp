#include "search_global.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "simplex.hpp"

namespace gravure::motion {
namespace {

/// SplitMix64: the same starting points on every machine.
class Random {
 public:
  explicit Random(std::uint64_t seed) noexcept : state_(seed) {}
  double uniform() noexcept {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15U);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
  }
  double log_between(double low, double high) noexcept { return low * std::exp(std::log(high / low) * uniform()); }

 private:
  std::uint64_t state_;
};

class GlobalSearch {
 public:
  GlobalSearch(const MoveSpace& space, SearchFor what) : space_(space), what_(what) {}

  std::vector<MovePoint> run(const SearchProblem& problem, std::uint64_t stream, const std::vector<MovePoint>& seeds) {
    for (const MovePoint& seed : seeds) {
      consider(seed);
    }
    add_notch_grid(problem);
    add_random_points(problem, stream);
    std::vector<Vertex<4>> ends;
    for (const Vertex<4>& start : starts_) {
      ends.push_back(refine(start, 0.1));
    }
    keep_best(ends, what_ == SearchFor::robust ? 3 : 15);
    return polish(ends);
  }

  std::vector<MovePoint> polish(const std::vector<MovePoint>& starts) {
    std::vector<Vertex<4>> ends;
    for (const MovePoint& start : starts) {
      ends.push_back({start, cost(start, std::numeric_limits<double>::infinity())});
    }
    return polish(ends);
  }

 private:
  /// Symmetric moves have one ramp for both directions.
  MovePoint shaped(const MovePoint& x) const noexcept {
    return what_ == SearchFor::symmetric ? MovePoint{x[0], x[1], x[1], x[3]} : x;
  }
  double cost(const MovePoint& x, double cutoff) const noexcept {
    return what_ == SearchFor::robust ? space_.worst_cost(x, cutoff) : space_.exact_cost(shaped(x), cutoff);
  }
  std::vector<MovePoint> polish(std::vector<Vertex<4>> ends) const {
    for (Vertex<4>& end : ends) {
      for (const double size : {0.3, 0.1, 0.03, 0.01, 0.003}) {
        end = refine(end, size);
      }
    }
    keep_best(ends, ends.size());
    std::vector<MovePoint> points;
    for (const Vertex<4>& end : ends) {
      points.push_back(shaped(end.x));
    }
    return points;
  }
  /// Keeps the best starts only, in order.
  void consider(const MovePoint& x) {
    const std::size_t most = what_ == SearchFor::robust ? 12 : 120;
    const bool full = starts_.size() >= most;
    const double value = cost(x, full ? starts_.back().cost : std::numeric_limits<double>::infinity());
    if (full && value >= starts_.back().cost) {
      return;
    }
    const auto after = [](double now, const Vertex<4>& other) { return now < other.cost; };
    starts_.insert(std::upper_bound(starts_.begin(), starts_.end(), value, after), {x, value});
    starts_.resize(std::min(starts_.size(), most));
  }
  void consider(const SearchProblem& problem, double jerk_s, double up_s, double down_s) {
    const double cruise_s = problem.stroke_mm / problem.v_max_mm_s - jerk_s - (up_s + down_s) / 2;
    consider(MoveSpace::point_of({jerk_s, up_s, down_s, cruise_s}));
    if (cruise_s > 0) {
      consider(MoveSpace::point_of({jerk_s, up_s, down_s, 0}));
    }
  }

  /// A segment as long as a whole period of a mode leaves nothing of it: start near such durations.
  void add_notch_grid(const SearchProblem& problem) {
    std::vector<double> widths;
    for (const Mode& mode : problem.modes) {
      for (const double periods : {0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0}) {
        widths.push_back(periods / mode.f_hz);
      }
    }
    std::vector<double> jerk_times = widths;
    jerk_times.push_back(0);
    const bool symmetric = what_ == SearchFor::symmetric;
    const std::size_t stride = what_ == SearchFor::robust ? 4 : 1;  // a robust cost is many costs
    std::size_t count = 0;
    for (const double jerk_s : jerk_times) {
      for (const double up_s : widths) {
        for (const double down_s : symmetric ? std::vector<double>{up_s} : widths) {
          if (up_s >= jerk_s && down_s >= jerk_s && count++ % stride == 0) {
            consider(problem, jerk_s, up_s, down_s);
          }
        }
      }
    }
  }

  void add_random_points(const SearchProblem& problem, std::uint64_t stream) {
    Random random(stream);
    double slowest_s = problem.stroke_mm / problem.v_max_mm_s;
    for (const Mode& mode : problem.modes) {
      slowest_s = std::max(slowest_s, 3 / mode.f_hz);
    }
    const int count = what_ == SearchFor::robust ? 400 : 3000;
    for (int i = 0; i < count; ++i) {
      const double jerk_s = random.log_between(1e-3 * slowest_s, slowest_s);
      const double up_s = jerk_s + random.log_between(1e-3 * slowest_s, slowest_s);
      const double down_s = jerk_s + random.log_between(1e-3 * slowest_s, slowest_s);
      consider(MoveSpace::point_of({jerk_s, up_s, down_s, random.log_between(1e-3 * slowest_s, slowest_s)}));
    }
  }

  static void keep_best(std::vector<Vertex<4>>& vertices, std::size_t count) {
    std::stable_sort(vertices.begin(), vertices.end(), [](const auto& a, const auto& b) { return a.cost < b.cost; });
    vertices.resize(std::min(vertices.size(), count));
  }

  Vertex<4> refine(const Vertex<4>& start, double size) const {
    const int steps = what_ == SearchFor::robust ? 120 : 150;
    const double scale = std::max({start.x[0], start.x[1], start.x[2], start.x[3]});
    const double edge = size * scale;
    return descend<4>(start, {edge, edge, edge, edge}, steps,
                      [this](const MovePoint& x, double cutoff) { return cost(x, cutoff); });
  }

  const MoveSpace& space_;
  SearchFor what_;
  std::vector<Vertex<4>> starts_;
};

}  // namespace

std::vector<MovePoint> search_global(const MoveSpace& space, const SearchProblem& problem, std::uint64_t stream,
                                     SearchFor what, const std::vector<MovePoint>& seeds) {
  return GlobalSearch(space, what).run(problem, stream, seeds);
}

std::vector<MovePoint> polish(const MoveSpace& space, SearchFor what, const std::vector<MovePoint>& starts) {
  return GlobalSearch(space, what).polish(starts);
}

}  // namespace gravure::motion
