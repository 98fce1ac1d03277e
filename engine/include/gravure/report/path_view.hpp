#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gravure/core/path_motion.hpp"
#include "gravure/core/program.hpp"
#include "gravure/report/area_count.hpp"
#include "gravure/report/line_view.hpp"
#include "gravure/twin/verify_path.hpp"

namespace gravure::report {

/// Where an axis goes over time: its least and its greatest set-point in each of equally long stretches; mm or degrees.
struct AxisTrace {
  std::vector<double> least;
  std::vector<double> most;
};

using PathTraces = std::vector<AxisTrace>;  ///< of the axes of the plan

/// Reads all set-points of a path program in blocks; at most `most_stretches` of them are kept an axis. A set-point on
/// the border of two stretches counts in both, so that what is drawn has no gaps. Fails as read_set_points() does.
Result<PathTraces> path_traces(LineSource& program, std::size_t most_stretches, CancelToken* cancel = nullptr);

/// Counts pulses by where they landed, seen along z, in square cells. How far they reach need not be known beforehand:
/// cells become twice as wide whenever a pulse does not fit, and at most kSide of them lie side by side.
class PulseMap {
 public:
  static constexpr std::int64_t kSide = 400;

  /// Takes a pulse at x, y and height z, mm. Positions that are no numbers are left out.
  void take(double x_mm, double y_mm, double z_mm);

  double cell_mm() const noexcept { return cell_mm_; }
  Extent cells() const noexcept;  ///< no wider than what was taken
  double left_mm() const noexcept { return static_cast<double>(low_x_) * cell_mm_; }
  double bottom_mm() const noexcept { return static_cast<double>(low_y_) * cell_mm_; }
  /// Row by row from the greatest y down, as it is looked at; pulses, and their mean height (0 where there are none).
  std::vector<double> pulses() const;
  std::vector<double> heights() const;
  double lowest_mm() const noexcept { return lowest_mm_; }  ///< of the heights
  double highest_mm() const noexcept { return highest_mm_; }

 private:
  struct Cell {
    std::int64_t pulses = 0;
    double height_sum_mm = 0;
  };
  void widen(std::int64_t x, std::int64_t y);
  std::vector<double> looked_at(double (*value)(const Cell&)) const;
  const Cell& at(std::int64_t x, std::int64_t y) const { return cells_[index(x, y)]; }
  std::size_t index(std::int64_t x, std::int64_t y) const;

  double cell_mm_ = 1.0 / 1024;  // exact in binary, so that halving and doubling lose nothing
  std::vector<Cell> cells_;      // kSide x kSide; cell (x, y) at its place modulo kSide
  std::int64_t low_x_ = 0;       // cells that hold something
  std::int64_t high_x_ = -1;
  std::int64_t low_y_ = 0;
  std::int64_t high_y_ = -1;
  double lowest_mm_ = 0;
  double highest_mm_ = 0;
};

/// Where pulses landed, in the order in which they are marked: all of them, or every second, fourth ... so that there
/// are never more than kMost.
class PulseSample {
 public:
  static constexpr std::size_t kMost = 20'000;

  /// Takes the next pulse. One whose place is no number is left out.
  void take(const std::array<double, 3>& place_mm);

  std::int64_t every() const noexcept { return every_; }  ///< of the pulses that were taken
  const std::vector<std::array<double, 3>>& places_mm() const noexcept { return places_mm_; }

 private:
  std::int64_t every_ = 1;
  std::int64_t taken_ = 0;
  std::vector<std::array<double, 3>> places_mm_;
};

/// Everything the page of a program that follows a path shows.
struct PathReportData {
  std::string generator;
  std::string program;  ///< name of the file
  const ProgramHeader* header = nullptr;
  PathReport verified;
  PathTraces traces;
  PulseMap map;
  PulseSample sample;
  LineView period;  ///< the first servo period in which a pulse fires
};

}  // namespace gravure::report
