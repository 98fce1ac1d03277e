#include "gravure/motion/rotary_rewrite.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "gravure/motion/unreverse.hpp"
#include "rotary_words.hpp"
#include "vector3.hpp"

namespace gravure::motion {
namespace {

constexpr std::string_view kLetters = "XYZAC";
/// Half the last decimal that is written.
constexpr double kSame = 5e-7;

/// Where the program stands: X, Y, Z, A, C.
struct Modal {
  std::array<double, 5> value{};
  std::array<bool, 5> known{};
};

Vector3 xyz_of(const Modal& modal) noexcept {
  return {modal.value[0], modal.value[1], modal.value[2]};
}

ToolPose tool_at(const Modal& modal, const RewriteRequest& r) noexcept {
  const double a = modal.value[3] * kDegree;
  const double c = modal.value[4] * kDegree;
  ToolPose tool = tool_of({modal.value[0], modal.value[1], modal.value[2], a, c}, r.rotary_centre_mm);
  if (r.frame == ProgramFrame::workpiece) {
    tool.centre_mm = xyz_of(modal);
  }
  return tool;
}

/// What is held: the centre of the ball, or the tip.
Vector3 held_at(const Modal& modal, const RewriteRequest& r) noexcept {
  const ToolPose tool = tool_at(modal, r);
  Vector3 held = tool.centre_mm;
  for (std::size_t i = 0; i < 3; ++i) {
    held[i] += r.ball_radius_mm * tool.axis[i];
  }
  return held;
}

std::string decimal(double value) {
  std::string text = fmt::format("{:.6f}", value);
  text.erase(text.find_last_not_of('0') + 1);
  text.erase(text.find_last_not_of('.') + 1);
  return text == "-0" ? "0" : text;
}

class Rewriter {
 public:
  explicit Rewriter(const RewriteRequest& request) noexcept : r_(request) {}

  Result<Rewritten> run() {
    std::string_view rest = r_.program;
    for (std::size_t number = 1; !rest.empty(); ++number) {
      const std::size_t end = rest.find('\n');
      GRAVURE_CHECK(take_line(rest.substr(0, end), number));
      if (end != std::string_view::npos) {
        result_.program += '\n';
      }
      rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    }
    return std::move(result_);
  }

 private:
  Result<void> take_line(std::string_view line, std::size_t number) {
    GRAVURE_TRY(const std::vector<Word> words, words_of({r_.name, number, line}));
    bool moves = false;
    bool turns = false;
    for (const Word& word : words) {
      const std::size_t axis = kLetters.find(word.letter);
      if (axis != std::string_view::npos) {
        old_.value[axis] = word.value;
        old_.known[axis] = true;
        moves = true;
        turns = turns || axis >= 3;
      }
    }
    if (!moves) {
      result_.program += line;
      return {};
    }
    block_ += turns ? 1 : 0;
    GRAVURE_TRY(const Modal next, moved(number));
    write(line, words, next);
    return {};
  }

  /// The new place for the old one.
  Result<Modal> moved(std::size_t number) {
    Modal next = old_;
    if (block_ == 0) {
      return next;
    }
    next.value[3] = r_.a_deg[block_ - 1];
    next.value[4] = r_.c_deg[block_ - 1];
    const bool turned =
        std::abs(next.value[3] - old_.value[3]) > kSame || std::abs(next.value[4] - old_.value[4]) > kSame;
    if (!turned) {
      return next;
    }
    if (!(old_.known[0] && old_.known[1] && old_.known[2])) {
      if (r_.frame == ProgramFrame::machine || r_.ball_radius_mm != 0) {
        return error_at({r_.name, number, {}}, 0,
                        "X, Y and Z are not all known where A or C turns; start the program with a move that has all "
                        "of them");
      }
      return next;
    }
    const ToolPose tool = tool_at(old_, r_);
    const double a = next.value[3] * kDegree;
    const double c = next.value[4] * kDegree;
    const ToolPose tool_next = tilted(tool, r_.ball_radius_mm, a, c);
    Vector3 xyz = tool_next.centre_mm;
    if (r_.frame == ProgramFrame::machine) {
      const AxisPose axes = axes_at(tool_next.centre_mm, r_.rotary_centre_mm, a, c);
      xyz = {axes.x_mm, axes.y_mm, axes.z_mm};
    }
    std::copy(xyz.begin(), xyz.end(), next.value.begin());
    // Twice the half angle's sine keeps small angles exact.
    const double tilt = 2 * std::asin(std::min(1.0, distance(tool.axis, tool_next.axis) / 2));
    result_.largest_tilt_deg = std::max(result_.largest_tilt_deg, tilt / kDegree);
    result_.largest_shift_mm = std::max(result_.largest_shift_mm, distance(xyz, xyz_of(old_)));
    return next;
  }

  void write(std::string_view line, const std::vector<Word>& words, const Modal& next) {
    std::string text;
    std::size_t copied = 0;
    bool changed = false;
    std::array<bool, 5> present{};
    std::size_t code_end = 0;
    for (const Word& word : words) {
      const std::size_t axis = kLetters.find(word.letter);
      code_end = word.end;
      if (axis == std::string_view::npos) {
        continue;
      }
      present[axis] = true;
      written_.value[axis] = word.value;
      if (std::abs(next.value[axis] - word.value) > kSame) {
        text += line.substr(copied, word.begin + 1 - copied);
        text += decimal(next.value[axis]);
        copied = word.end;
        changed = true;
        written_.value[axis] = next.value[axis];
      }
    }
    text += line.substr(copied, code_end - copied);
    for (std::size_t axis = 0; axis < 5; ++axis) {
      if (!present[axis] && old_.known[axis] && std::abs(next.value[axis] - written_.value[axis]) > kSame) {
        text += fmt::format(" {}{}", kLetters[axis], decimal(next.value[axis]));
        written_.value[axis] = next.value[axis];
        changed = true;
      }
    }
    text += line.substr(code_end);
    result_.changed_lines += changed ? 1 : 0;
    result_.program += text;
    if (old_.known[0] && old_.known[1] && old_.known[2]) {
      result_.largest_error_mm =
          std::max(result_.largest_error_mm, distance(held_at(read_back(), r_), held_at(old_, r_)));
    }
  }

  /// Where a machine stands that reads what was written.
  Modal read_back() const {
    Modal modal = written_;
    for (double& value : modal.value) {
      value = std::round(value * 1e6) / 1e6;
    }
    return modal;
  }

  const RewriteRequest& r_;
  Rewritten result_;
  Modal old_;
  Modal written_;
  std::size_t block_ = 0;  ///< how many blocks have turned A or C
};

}  // namespace

Result<Rewritten> rewrite_rotary_program(const RewriteRequest& request) {
  GRAVURE_TRY(const RotaryPath path, parse_rotary_program(request.program, request.name));
  const auto finite = [](std::span<const double> angles) {
    return std::all_of(angles.begin(), angles.end(), [](double angle) { return std::abs(angle) <= 1e9; });
  };
  if (request.a_deg.size() != path.line.size() || request.c_deg.size() != path.line.size() || !finite(request.a_deg) ||
      !finite(request.c_deg)) {
    return Error{ErrorCode::out_of_range,
                 fmt::format("{}: {} blocks, but {} angles of A and {} of C: as many as blocks are needed, "
                             "each within +-1e9 degrees",
                             request.name, path.line.size(), request.a_deg.size(), request.c_deg.size())};
  }
  GRAVURE_TRY(Rewritten rewritten, Rewriter(request).run());
  GRAVURE_TRY(const RotaryPath back, parse_rotary_program(rewritten.program, request.name));
  for (std::size_t k = 0; k < path.line.size(); ++k) {
    if (back.line.size() != path.line.size() || back.line[k] != path.line[k] ||
        std::abs(back.a_deg[k] - request.a_deg[k]) > 1e-6 || std::abs(back.c_deg[k] - request.c_deg[k]) > 1e-6) {
      return error_at({request.name, path.line[k], {}}, 0,
                      "reads otherwise than it was written; the program has a form this rewriter does not know");
    }
  }
  return rewritten;
}

}  // namespace gravure::motion
