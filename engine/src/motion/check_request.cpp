#include "check_request.hpp"

#include <fmt/format.h>

namespace gravure::motion {
namespace {

// Wide enough for picometres to metres in any length unit, narrow enough that no product leaves the range of double.
constexpr double kLeastLimit = 1e-12;
constexpr double kGreatestLimit = 1e21;
constexpr double kGreatestStroke = 1e15;

}  // namespace

Result<void> check_range(std::string_view field, double value, double low, double high) {
  if (value >= low && value <= high) {
    return {};
  }
  return Error{ErrorCode::out_of_range, fmt::format("motion: {} = {}: must be from {} to {}", field, value, low, high)};
}

Result<void> check_move(const Move& move) {
  GRAVURE_CHECK(check_range("stroke_mm", move.stroke_mm, -kGreatestStroke, kGreatestStroke));
  GRAVURE_CHECK(check_range("v_max_mm_s", move.v_max_mm_s, kLeastLimit, kGreatestLimit));
  GRAVURE_CHECK(check_range("a_up_mm_s2", move.a_up_mm_s2, kLeastLimit, kGreatestLimit));
  GRAVURE_CHECK(check_range("a_down_mm_s2", move.a_down_mm_s2, kLeastLimit, kGreatestLimit));
  GRAVURE_CHECK(check_range("start_velocity_mm_s", move.start_velocity_mm_s, -move.v_max_mm_s, move.v_max_mm_s));
  return check_range("end_velocity_mm_s", move.end_velocity_mm_s, -move.v_max_mm_s, move.v_max_mm_s);
}

Result<void> check_request(const SFactorRequest& request) {
  GRAVURE_CHECK(check_move(request.move));
  GRAVURE_CHECK(check_range("s_factor", request.s_factor, 0, kMostSFactor));
  return check_range("update_us", request.update_us, 1e-3, 1e9);
}

Result<void> check_request(const JerkRequest& request) {
  GRAVURE_CHECK(check_move(request.move));
  GRAVURE_CHECK(check_range("jerk_up_mm_s3", request.jerk_up_mm_s3, kLeastLimit, kGreatestLimit));
  return check_range("jerk_down_mm_s3", request.jerk_down_mm_s3, kLeastLimit, kGreatestLimit);
}

}  // namespace gravure::motion
