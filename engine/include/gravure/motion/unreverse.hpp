#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "gravure/motion/monotone_spline.hpp"

namespace gravure::motion {

/// How often the sense of motion changes: sign changes of the increments, standing still left out.
std::size_t count_reversals(std::span<const double> angle) noexcept;

/// Indices where the path turns back by more than `prominence` before it turns again, ends included: the reversals that
/// are meant. Between two of them everything that runs backwards is smaller.
std::vector<std::size_t> intended_turns(std::span<const double> angle, double prominence);

/// `angle` with full turns added so that no step exceeds half a turn (of `turn`, 360 or 2 pi). A step of just half a
/// turn keeps its sign.
std::vector<double> unwrapped(std::span<const double> angle, double turn);

struct UnreverseRequest {
  std::span<const double> parameter;  ///< rising strictly: arc length, time, or block number
  std::span<const double> angle;      ///< unwrapped
  double tolerance = 0;               ///< > 0: reversals up to this are removed, and no sample moves by more
  std::size_t control_points = 8;     ///< of each piece to begin with; doubled until the tolerance holds
};

struct Unreversed {
  std::vector<double> angle;        ///< at the same parameters
  std::vector<CubicSpline> pieces;  ///< between intended turns; they join with no speed and no acceleration
  std::vector<std::size_t> turns;   ///< indices of the intended turns, path ends included
  std::size_t reversals_before = 0;
  std::size_t reversals_after = 0;  ///< the intended ones
  std::size_t control_points = 0;   ///< of all pieces together
  double largest_deviation = 0;     ///< <= tolerance
  double rms_deviation = 0;
};

/// Splits the path at intended turns and gives each piece the least-squares monotone cubic B-spline with its ends
/// anchored ([C2], with the constraint in place of its iteration: a monotone control polygon leaves no reversal).
/// Fails like fit_monotone(), with out_of_range for a tolerance that is not above 0.
Result<Unreversed> remove_reversals(const UnreverseRequest& request);

/// The published rule, for comparison ([C2]): increments against `direction` are shifted by `shift` until they are not,
/// and accumulated again. It drifts; nothing bounds by how far.
std::vector<double> published_shift(std::span<const double> angle, double shift, int direction);

/// What the published rule makes of a whole path.
struct Shifted {
  std::vector<double> angle;
  std::size_t reversals_after = 0;
  double largest_deviation = 0;
  double rms_deviation = 0;
};

/// The published rule between the intended turns (by `prominence`), each piece in its own sense. It goes on from where
/// the piece before has drifted to.
Shifted published_shift_between_turns(std::span<const double> angle, double prominence, double shift);

/// The rotary axes of a G-code program, one entry for each block that moves A or C.
struct RotaryPath {
  std::vector<double> a_deg;
  std::vector<double> c_deg;
  std::vector<std::size_t> line;  ///< of the file, from 1
  std::vector<std::array<double, 3>> xyz_mm;

  /// A block that moves X, Y or Z alone: A and C stay where `block`, an index of the above, put them.
  struct Linear {
    std::size_t block = 0;
    std::size_t line = 0;
    std::array<double, 3> xyz_mm{};
  };
  std::vector<Linear> linear;  ///< those after the first that moves A or C
};

/// The blocks of a program with their modal words. Comments in brackets or after a semicolon are left out. bad_file
/// starts with name:line:column, for a letter without a plain decimal number, an open comment, and all that is no
/// straight, absolute move in mm (arcs, cycles, dwells that name an axis, G20, G91, offsets after the first move, other
/// axes, variables, calls); at most 10 million blocks.
Result<RotaryPath> parse_rotary_program(std::string_view text, std::string_view name = "rotary program");

}  // namespace gravure::motion
