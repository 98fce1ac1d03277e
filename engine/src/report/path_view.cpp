#include "gravure/report/path_view.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gravure::report {
namespace {

std::int64_t remainder_of(std::int64_t value) {
  const std::int64_t left = value % PulseMap::kSide;
  return left < 0 ? left + PulseMap::kSide : left;
}

/// Half of it, downwards: the cell twice as wide that holds it.
std::int64_t half(std::int64_t value) {
  return value >= 0 ? value / 2 : -((1 - value) / 2);
}

/// What a count of each axis is, in mm or degrees.
std::vector<double> units_of(const PathPlan& path) {
  std::vector<double> units(path.axes.size());
  for (std::size_t axis = 0; axis < units.size(); ++axis) {
    const bool turns = kPathAxes[axis] == "A" || kPathAxes[axis] == "C";
    units[axis] = (turns ? 180 / std::numbers::pi : 1) / to_double(path.axes[axis].counts_per_unit);
  }
  return units;
}

}  // namespace

Result<PathTraces> path_traces(LineSource& program, std::size_t most_stretches, CancelToken* cancel) {
  const Plan& plan = program.header().plan;
  if (!plan.path || most_stretches < 1) {
    return Error{ErrorCode::bad_argument, "traces of axes: the program follows no path"};
  }
  constexpr std::int64_t kBlock = 8192;
  const std::int64_t total = set_points_of(plan);
  const std::int64_t stretches = std::min(total, static_cast<std::int64_t>(most_stretches));
  const std::vector<double> units = units_of(*plan.path);
  PathTraces traces(units.size());
  std::vector<PathSetPoint> block;
  for (std::int64_t first = 0; first < total; first += kBlock) {
    if (cancel != nullptr && cancel->cancelled()) {
      return Error{ErrorCode::cancelled, "stopped while the axes were drawn"};
    }
    block.resize(static_cast<std::size_t>(std::min(kBlock, total - first)));
    GRAVURE_CHECK(program.read_set_points(first, block));
    for (std::size_t i = 0; i < block.size(); ++i) {
      const auto stretch = static_cast<std::size_t>((first + static_cast<std::int64_t>(i)) * stretches / total);
      for (std::size_t axis = 0; axis < traces.size(); ++axis) {
        const double at = static_cast<double>(block[i].counts[axis]) * units[axis];
        AxisTrace& trace = traces[axis];
        if (trace.least.size() == stretch) {
          if (stretch > 0) {  // from where the stretch before ends
            trace.least[stretch - 1] = std::min(trace.least[stretch - 1], at);
            trace.most[stretch - 1] = std::max(trace.most[stretch - 1], at);
          }
          trace.least.push_back(at);
          trace.most.push_back(at);
        }
        trace.least[stretch] = std::min(trace.least[stretch], at);
        trace.most[stretch] = std::max(trace.most[stretch], at);
      }
    }
  }
  return traces;
}

std::size_t PulseMap::index(std::int64_t x, std::int64_t y) const {
  return static_cast<std::size_t>(remainder_of(y) * kSide + remainder_of(x));
}

Extent PulseMap::cells() const noexcept {
  return {high_x_ - low_x_ + 1, high_y_ - low_y_ + 1};
}

void PulseMap::take(double x_mm, double y_mm, double z_mm) {
  constexpr double kMost_mm = 1e9;  // what a cell's number can say
  if (!(std::abs(x_mm) < kMost_mm && std::abs(y_mm) < kMost_mm) || !std::isfinite(z_mm)) {
    return;
  }
  const auto number = [this](double at_mm) { return static_cast<std::int64_t>(std::floor(at_mm / cell_mm_)); };
  if (cells_.empty()) {
    cells_.resize(static_cast<std::size_t>(kSide * kSide));
    low_x_ = high_x_ = number(x_mm);
    low_y_ = high_y_ = number(y_mm);
    lowest_mm_ = highest_mm_ = z_mm;
  }
  widen(number(x_mm), number(y_mm));
  Cell& cell = cells_[index(number(x_mm), number(y_mm))];
  ++cell.pulses;
  cell.height_sum_mm += z_mm;
  lowest_mm_ = std::min(lowest_mm_, z_mm);
  highest_mm_ = std::max(highest_mm_, z_mm);
}

void PulseMap::widen(std::int64_t x, std::int64_t y) {
  while (std::max(high_x_, x) - std::min(low_x_, x) >= kSide || std::max(high_y_, y) - std::min(low_y_, y) >= kSide) {
    std::vector<Cell> wider(cells_.size());
    for (std::int64_t row = low_y_; row <= high_y_; ++row) {
      for (std::int64_t column = low_x_; column <= high_x_; ++column) {
        const Cell& from = at(column, row);
        Cell& to = wider[index(half(column), half(row))];
        to.pulses += from.pulses;
        to.height_sum_mm += from.height_sum_mm;
      }
    }
    cells_ = std::move(wider);
    cell_mm_ *= 2;
    for (std::int64_t* const number : {&low_x_, &high_x_, &low_y_, &high_y_, &x, &y}) {
      *number = half(*number);
    }
  }
  low_x_ = std::min(low_x_, x);
  high_x_ = std::max(high_x_, x);
  low_y_ = std::min(low_y_, y);
  high_y_ = std::max(high_y_, y);
}

void PulseSample::take(const std::array<double, 3>& place_mm) {
  const bool wanted = taken_ % every_ == 0;
  ++taken_;
  if (!wanted || !std::all_of(place_mm.begin(), place_mm.end(), [](double at) { return std::isfinite(at); })) {
    return;
  }
  if (places_mm_.size() == kMost) {  // this pulse is one of the next coarser sample: kMost is even
    for (std::size_t i = 0; i < kMost / 2; ++i) {
      places_mm_[i] = places_mm_[2 * i];
    }
    places_mm_.resize(kMost / 2);
    every_ *= 2;
  }
  places_mm_.push_back(place_mm);
}

std::vector<double> PulseMap::looked_at(double (*value)(const Cell&)) const {
  std::vector<double> values;
  values.reserve(static_cast<std::size_t>(cells().area()));
  for (std::int64_t row = high_y_; row >= low_y_; --row) {
    for (std::int64_t column = low_x_; column <= high_x_; ++column) {
      values.push_back(value(at(column, row)));
    }
  }
  return values;
}

std::vector<double> PulseMap::pulses() const {
  return looked_at([](const Cell& cell) { return static_cast<double>(cell.pulses); });
}

std::vector<double> PulseMap::heights() const {
  return looked_at(
      [](const Cell& cell) { return cell.pulses > 0 ? cell.height_sum_mm / static_cast<double>(cell.pulses) : 0.0; });
}

}  // namespace gravure::report
