#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "gravure/formats/freeform_job.hpp"
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
/// bad_argument for an axis that is `given` already; notes it.
Result<void> refuse_twice(std::string_view option, std::size_t axis, std::array<bool, kPathAxes.size()>& given);

/// `--servo AXIS=HZ,DAMPING` as text, as often as needed, then into the settings.
void add_servo_option(CLI::App& verb, std::vector<std::string>& servos);
Result<void> set_servos(const std::vector<std::string>& servos, MotionSettings& motion);

/// What the loops make of a motion; those that are not wholly stated are assumed.
struct Following {
  texture::AxesServos servos;
  std::array<bool, kPathAxes.size()> stated{};  ///< of `servos`
  texture::FollowingErrors errors;
};
/// Errors as texture::check_servos() and texture::predict_following().
Result<Following> predict(const MotionSettings& settings, const PathMotion& motion,
                          const texture::PathMachine& machine);

Json following_json(const Following& following, double servo_s);
std::string following_text(const Following& following, double servo_s);

}  // namespace gravure::cli
