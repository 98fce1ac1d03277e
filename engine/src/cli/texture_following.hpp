#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "gravure/texture/best_sigma.hpp"
#include "gravure/texture/following_error.hpp"
#include "verb.hpp"

namespace gravure::cli {

/// An option of one axis, "AXIS=NUMBER,NUMBER ...".
struct AxisSetting {
  std::size_t axis = 0;  ///< of kPathAxes
  std::vector<double> numbers;
};
/// `form` says what it has to look like, with as many commas as there are numbers less one. bad_argument otherwise.
Result<AxisSetting> axis_setting(const std::string& option, const std::string& text, std::string_view form);

/// The position loops of the axes.
struct ServoOptions {
  std::vector<std::string> servos;  ///< "AXIS=HZ,DAMPING"
};
void add_servo_options(CLI::App& verb, ServoOptions& options);

/// What the loops make of a motion; which of them are stated, the others are assumed.
struct Following {
  texture::SevenServos servos;
  std::array<bool, kPathAxes.size()> stated{};
  texture::FollowingErrors errors;
};
/// The loops, stated or assumed. Errors as texture::check_servos().
Result<Following> servos_of(const ServoOptions& options);
/// Fills in `errors`.
Result<void> predict(Following& following, const PathMotion& motion, const texture::PathMachine& machine);

Json following_json(const Following& following, double servo_s);
std::string following_text(const Following& following, double servo_s);

}  // namespace gravure::cli
