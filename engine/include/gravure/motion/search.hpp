#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "gravure/motion/settling.hpp"

namespace gravure::motion {

/// The move whose positioning time is to be shortest: from rest to rest under limits, carrying modes.
struct SearchProblem {
  double stroke_mm = 0;  ///< of either sign: limits go with the sense of the move
  double v_max_mm_s = 0;
  double a_up_max_mm_s2 = 0;
  double a_down_max_mm_s2 = 0;
  double jerk_max_mm_s3 = 1e21;  ///< bounds a / tj; the default is none
  double update_us = 250;        ///< S factors are counted in these
  std::vector<Mode> modes;
  Band band;
  double mode_error_percent = 5;  ///< of each frequency and damping, for the worst case; shares stay
};

/// A parameter from `first` to `last` in steps.
struct GridAxis {
  double first = 0;
  double last = 0;
  double step = 1;
  std::size_t count() const noexcept;
  double at(std::size_t index) const noexcept { return first + static_cast<double>(index) * step; }
};

/// The published grid of [C1] has 61,634 feasible symmetric points.
struct SearchGrid {
  GridAxis v_mm_s{200, 500, 5};
  GridAxis a_mm_s2{10000, 30000, 500};  ///< for both directions
  GridAxis s_factor{2.5, 115, 2.5};
};

/// One point of the search, always feasible ([C1]: tj <= V/Au, tj <= V/Ad, cruise >= 0).
struct Candidate {
  double v_mm_s = 0;
  double a_up_mm_s2 = 0;
  double a_down_mm_s2 = 0;
  double s_factor = 0;
  double access_time_s = 0;
  double positioning_time_s = 0;
};

struct GridSearch {
  Candidate best;
  std::uint64_t evaluated = 0;   ///< feasible points, every one of them
  std::uint64_t below_mark = 0;  ///< points with a positioning time below the mark
};

/// Every feasible point of the grid, symmetric (one acceleration for both directions) or asymmetric (every pair).
/// `mark_s` > 0 counts the points below it. Fails with out_of_range for a grid of more than 1e9 points or values that
/// are not above 0, with bad_argument where no point is feasible.
Result<GridSearch> search_grid(const SearchProblem& problem, const SearchGrid& grid, bool asymmetric,
                               double mark_s = 0);

/// One way to make the move, with what it costs.
struct Alternative {
  std::string name;                  ///< "fastest", "best_symmetric", "best_asymmetric", "robust", "zv", "zvd"
  std::optional<Candidate> profile;  ///< of the move, before shaping
  double access_time_s = 0;          ///< the input ends
  double positioning_time_s = 0;
  double envelope_time_s = 0;
  double worst_positioning_time_s = 0;  ///< over the mode errors
  double residual = 0;                  ///< envelope when the input ends, in the band's unit
};

/// The two complete grids that a search began with.
struct SearchedGrids {
  GridSearch symmetric;
  GridSearch asymmetric;
};

struct SearchReport {
  std::vector<Alternative> alternatives;
  Candidate best;  ///< of the profiles: the asymmetric one, never worse than the symmetric one
  std::uint64_t evaluated = 0;
  std::optional<SearchedGrids> grids;  ///< where the options asked for them; never better than the alternatives
  std::string verdict;         ///< in words: what is shortest for exact modes and under mode errors, and by how much
  std::string shortest;        ///< name of the alternative, for exact modes
  std::string shortest_worst;  ///< name of the alternative, under mode errors
};

struct SearchOptions {
  std::optional<SearchGrid> grid;  ///< searched completely first, symmetric and asymmetric
  std::uint64_t seed = 1;          ///< of the random starting points; the first round does without
  std::uint32_t effort = 1;        ///< rounds with random starting points; one more never makes a profile worse
  bool robust = true;              ///< also optimise for the worst case
};

/// Global search by notch-grid and random starts and a simplex descent of the best ones, in durations, where every
/// point is feasible. Not proved global; never worse than its grids, than with less effort, and the asymmetric profile
/// never slower than the symmetric one. Fails like search_grid() and settle().
Result<SearchReport> search(const SearchProblem& problem, const SearchOptions& options);

/// Longest positioning time over all errors of the modes within +-mode_error_percent of each frequency and damping,
/// each on its own; shares stay. Never less than the truth, and not more than the truth for a band 0.1 % narrower, as
/// long as the proof stays within its means (else the time from which on the band is proved to hold).
double worst_positioning_time_s(const SearchProblem& problem, std::span<const InputJump> input);

}  // namespace gravure::motion
