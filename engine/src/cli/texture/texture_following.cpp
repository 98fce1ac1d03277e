#include "texture/texture_following.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "program/path_program.hpp"
#include "texture/texture_options.hpp"

namespace gravure::cli {
namespace {

Json error_json(const texture::FollowingError& error, const std::string& unit, double per_unit, double servo_s) {
  return {{"max_" + unit, rounded(error.max * per_unit, 6)},
          {"rms_" + unit, rounded(error.rms * per_unit, 6)},
          {"at_s", rounded(static_cast<double>(error.instant) * servo_s, 6)}};
}

std::string error_text(const texture::FollowingError& error, const char* unit, double per_unit, double servo_s) {
  return fmt::format("{:.4f} {} at most at {:.4f} s, {:.4f} rms", error.max * per_unit, unit,
                     static_cast<double>(error.instant) * servo_s, error.rms * per_unit);
}

texture::AxesServos servos_of(const MotionSettings& settings, bool focus_axis) {
  texture::AxesServos servos = texture::assumed_servos(focus_axis);
  for (std::size_t axis = 0; axis < servos.size(); ++axis) {
    const GivenServo& given = settings.servos[axis];
    servos[axis] = {given.natural_hz.value_or(servos[axis].natural_hz), given.damping.value_or(servos[axis].damping)};
  }
  return servos;
}

}  // namespace

Result<void> refuse_twice(std::string_view option, std::size_t axis, std::array<bool, kPathAxes.size()>& given) {
  if (given[axis]) {
    return Error{ErrorCode::bad_argument,
                 fmt::format("{} {}=...: stands there twice; give it once an axis", option, kPathAxes[axis])};
  }
  given[axis] = true;
  return {};
}

Result<AxisSetting> axis_setting(const std::string& option, const std::string& text, std::string_view form) {
  const auto axis = std::find(kPathAxes.begin(), kPathAxes.end(), text.substr(0, text.find('=')));
  if (text.find('=') == std::string::npos || axis == kPathAxes.end()) {
    return Error{ErrorCode::bad_argument,
                 fmt::format("{} {}: must be {} with X, Y, Z, A, C, U, V or W", option, text, form)};
  }
  AxisSetting setting;
  setting.axis = static_cast<std::size_t>(axis - kPathAxes.begin());
  GRAVURE_TRY(setting.numbers, numbers_of(option, text.substr(text.find('=') + 1), std::string(form)));
  const auto wanted = static_cast<std::size_t>(std::count(form.begin(), form.end(), ',')) + 1;
  if (setting.numbers.size() != wanted) {
    return Error{ErrorCode::bad_argument, fmt::format("{} {}: must be {}, {} numbers", option, text, form, wanted)};
  }
  return setting;
}

void add_servo_option(CLI::App& verb, std::vector<std::string>& servos) {
  verb.add_option("--servo", servos,
                  "AXIS=HZ,DAMPING of one axis' position loop, for what it will be behind; as often as needed");
}

Result<void> set_servos(const std::vector<std::string>& servos, MotionSettings& motion) {
  std::array<bool, kPathAxes.size()> given{};
  for (const std::string& text : servos) {
    GRAVURE_TRY(const AxisSetting setting, axis_setting("--servo", text, "AXIS=HZ,DAMPING"));
    GRAVURE_CHECK(refuse_twice("--servo", setting.axis, given));
    motion.servos[setting.axis] = {setting.numbers[0], setting.numbers[1]};
  }
  return texture::check_servos(servos_of(motion, true));
}

Result<Following> predict(const MotionSettings& settings, const PathMotion& motion,
                          const texture::PathMachine& machine) {
  Following following;
  following.servos = servos_of(settings, texture::has_focus_axis(machine.limits));
  for (std::size_t axis = 0; axis < following.servos.size(); ++axis) {
    following.stated[axis] = settings.servos[axis].natural_hz && settings.servos[axis].damping;
  }
  GRAVURE_TRY(const texture::RotaryTable table, texture::rotary_table(machine.machine));
  GRAVURE_TRY(following.errors,
              texture::predict_following(motion, following.servos, table, machine.servo_s, cancel_token()));
  return following;
}

Json following_json(const Following& following, double servo_s) {
  Json axes = Json::array();
  for (std::size_t axis = 0; axis < following.servos.size(); ++axis) {
    Json one{{"axis", kPathAxes[axis]},
             {"natural_hz", following.servos[axis].natural_hz},
             {"damping", following.servos[axis].damping},
             {"assumed", !following.stated[axis]}};
    one.update(axis_turns(axis) ? error_json(following.errors.axes[axis], "deg", kDegreesPerRad, servo_s)
                                : error_json(following.errors.axes[axis], "um", kUmPerMm, servo_s));
    axes.push_back(std::move(one));
  }
  return {{"axes", std::move(axes)},
          {"spot", error_json(following.errors.spot_mm, "um", kUmPerMm, servo_s)},
          {"focus", error_json(following.errors.focus_mm, "um", kUmPerMm, servo_s)}};
}

std::string following_text(const Following& following, double servo_s) {
  std::string text;
  for (std::size_t axis = 0; axis < following.servos.size(); ++axis) {
    const texture::FollowingError& error = following.errors.axes[axis];
    text += fmt::format("following     {} {} ({:.6g} Hz, damping {:.6g}{})\n", kPathAxes[axis],
                        axis_turns(axis) ? error_text(error, "deg", kDegreesPerRad, servo_s)
                                         : error_text(error, "um", kUmPerMm, servo_s),
                        following.servos[axis].natural_hz, following.servos[axis].damping,
                        following.stated[axis] ? "" : ", assumed");
  }
  text += "following     spot " + error_text(following.errors.spot_mm, "um", kUmPerMm, servo_s) + "\n";
  return text + "following     focus " + error_text(following.errors.focus_mm, "um", kUmPerMm, servo_s) + "\n";
}

}  // namespace gravure::cli
