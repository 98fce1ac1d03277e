#include <fmt/format.h>
#include <muParser.h>

#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>

#include "gravure/texture/surface.hpp"

namespace gravure::texture {
namespace {

/// Half the width of the differences: errors of the fourth order (h^4 f''''' / 30) and of rounding (eps z / h) are both
/// near 1e-12 for shapes of millimetres.
constexpr double kStep_mm = 1e-3;

class ExpressionSurface final : public Surface {
 public:
  explicit ExpressionSurface(const std::string& expression) : expression_(expression) {
    parser_.DefineVar("x", &x_);
    parser_.DefineVar("y", &y_);
    parser_.DefineConst("pi", std::numbers::pi);
    parser_.SetExpr(expression);
    height(0, 0);  // it parses, or throws
  }
  /// One value, not a list of them.
  bool is_height() const { return parser_.GetNumResults() == 1; }

  Result<void> project(std::span<const Vector2> plane_mm, std::span<SurfacePoint> out) const override {
    for (std::size_t i = 0; i < plane_mm.size(); ++i) {
      const double x = plane_mm[i].x();
      const double y = plane_mm[i].y();
      const double z = height(x, y);
      const Vector2 slope((8 * (height(x + kStep_mm, y) - height(x - kStep_mm, y)) -
                           (height(x + 2 * kStep_mm, y) - height(x - 2 * kStep_mm, y))) /
                              (12 * kStep_mm),
                          (8 * (height(x, y + kStep_mm) - height(x, y - kStep_mm)) -
                           (height(x, y + 2 * kStep_mm) - height(x, y - 2 * kStep_mm))) /
                              (12 * kStep_mm));
      if (!std::isfinite(z) || !slope.allFinite()) {
        return Error{ErrorCode::out_of_range,
                     fmt::format("surface \"{}\": at x = {} mm, y = {} mm its height or slope is not finite; the "
                                 "texture must lie where the surface is finite and smooth",
                                 expression_, x, y)};
      }
      out[i] = {Vector3(x, y, z), Vector3(-slope.x(), -slope.y(), 1).normalized()};
    }
    return {};
  }

 private:
  double height(double x, double y) const {
    x_ = x;
    y_ = y;
    return parser_.Eval();
  }

  std::string expression_;
  mu::Parser parser_;
  mutable double x_ = 0;
  mutable double y_ = 0;
};

/// muParser would let an expression set x, and give several values.
bool assigns(const std::string& expression) {
  for (std::size_t i = 0; i < expression.size(); ++i) {
    const bool compares = (i > 0 && std::string_view("<>!=").find(expression[i - 1]) != std::string_view::npos) ||
                          (i + 1 < expression.size() && expression[i + 1] == '=');
    if (expression[i] == '=' && !compares) {
      return true;
    }
  }
  return false;
}

}  // namespace

Result<std::unique_ptr<Surface>> expression_surface(const std::string& expression) {
  constexpr std::size_t kMostCharacters = 4096;
  if (expression.size() > kMostCharacters) {
    return Error{ErrorCode::bad_argument, fmt::format("surface expression: {} characters, at most {} are taken",
                                                      expression.size(), kMostCharacters)};
  }
  if (assigns(expression)) {
    return Error{ErrorCode::bad_argument,
                 fmt::format("surface expression \"{}\": sets a variable; write z alone, by x and y", expression)};
  }
  try {
    auto surface = std::make_unique<ExpressionSurface>(expression);
    if (!surface->is_height()) {
      return Error{ErrorCode::bad_argument,
                   fmt::format("surface expression \"{}\": gives several values; write z alone", expression)};
    }
    return std::unique_ptr<Surface>(std::move(surface));
  } catch (const mu::Parser::exception_type& problem) {
    return Error{ErrorCode::bad_argument,
                 fmt::format("surface expression \"{}\", character {}: {}; write z in mm by x and y, for example "
                             "\"2.6*cos(2*pi*x/39)\"",
                             expression, problem.GetPos(), problem.GetMsg())};
  }
}

}  // namespace gravure::texture
