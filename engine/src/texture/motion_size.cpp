#include "motion_size.hpp"

#include <fmt/format.h>

#include "least_time.hpp"

namespace gravure::texture {
namespace {

constexpr double kMostPlaces = 1 << 27;  // 1 GiB
constexpr double kMostApart = 1 << 22;   // a weight for every period between two of them

}  // namespace

Result<void> check_duration(double time_s, double servo_s) {
  const double periods = time_s / servo_s;
  return periods <= static_cast<double>(kMostPeriods) ? Result<void>() : too_long(periods, servo_s);
}

Result<void> check_places(double time_s, double servo_s, double apart) {
  const double places = time_s / servo_s / apart;
  if (places <= kMostPlaces && apart <= kMostApart) {
    return {};
  }
  return Error{
      ErrorCode::out_of_range,
      fmt::format("the motion takes {:.4g} s at least and is described every {:.4g} s, at {:.4g} places {:.4g} "
                  "servo periods apart: at most {:.0f} places and {:.0f} periods are held; raise the limits "
                  "of the axes (acceleration no more than their jerk reaches in seconds), or take a smaller "
                  "texture or a longer servo period",
                  time_s, apart * servo_s, places, apart, kMostPlaces, kMostApart)};
}

}  // namespace gravure::texture
