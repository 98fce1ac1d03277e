#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "gravure/motion/five_axis.hpp"

namespace gravure::motion {

/// What X, Y and Z of a program are.
enum class ProgramFrame : std::uint8_t {
  workpiece,  ///< the tool's tip (or the focus) on the workpiece: the control follows it while A and C turn
  machine,    ///< the linear axes themselves, as axes_of() gives them
};

struct RewriteRequest {
  std::string_view program;
  std::span<const double> a_deg;  ///< new angles, one for each block of parse_rotary_program()
  std::span<const double> c_deg;
  ProgramFrame frame = ProgramFrame::workpiece;
  double ball_radius_mm = 0;  ///< of the tool's end, whose centre is held; 0 holds the tip or the focus
  Vector3 rotary_centre_mm{};
  std::string_view name = "rotary program";  ///< for errors
};

struct Rewritten {
  std::string program;
  double largest_tilt_deg = 0;  ///< between the tool's old and new direction on the workpiece
  double largest_shift_mm = 0;  ///< of X, Y and Z as they stand in the program
  double largest_error_mm = 0;  ///< of the centre that is held, as read back from the new text
  std::size_t changed_lines = 0;
};

/// The program with the new angles, and X, Y and Z computed anew so that the ball's centre (or the focus) stays where
/// it was; all other text stays as it is. A line that only moves X, Y or Z after the first turn is computed anew as
/// well. Numbers have six decimals. The new text is read back and compared. Fails with out_of_range where the angles
/// are not as many as the blocks or not finite, like parse_rotary_program(), and with bad_file, naming the line, for a
/// machine's axis that turns before X, Y and Z are known.
Result<Rewritten> rewrite_rotary_program(const RewriteRequest& request);

}  // namespace gravure::motion
