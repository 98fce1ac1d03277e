#include "program/path_program.hpp"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "gravure/core/units.hpp"
#include "program/program_files.hpp"

namespace gravure::cli {
namespace {

Json figure_json(const PulseFigure& figure) {
  return {{"max", figure.max},
          {"rms", figure.rms},
          {"worst_pulse", figure.worst_pulse < 0 ? Json(nullptr) : Json(figure.worst_pulse)}};
}

Json axes_json(const PathReport& report) {
  Json axes = Json::object();
  for (std::size_t axis = 0; axis < report.axes.size(); ++axis) {
    const AxisUse& use = report.axes[axis];
    const std::string unit = axis_turns(axis) ? "deg" : "mm";
    axes[std::string(kPathAxes[axis])] = {{"least_" + unit, use.least},
                                          {"most_" + unit, use.most},
                                          {"max_speed_" + unit + "_s", use.max_speed},
                                          {"max_acceleration_" + unit + "_s2", use.max_acceleration},
                                          {"max_jerk_" + unit + "_s3", use.max_jerk}};
  }
  return axes;
}

Json json_of(const PathReport& report) {
  Json json = {{"within_limits", report.violations.empty()},
               {"violations", report.violations},
               {"notes", report.notes},
               {"lines", report.lines},
               {"ticks", json_integer(Integer(report.ticks))},
               {"pulses", report.pulses},
               {"fired_pulses", report.fired},
               {"bits_compared", report.bits_compared},
               {"misplaced_pulses", report.misplaced},
               {"missing_pulses", report.missing},
               {"unwanted_pulses", report.unwanted},
               {"points_compared", report.points_compared},
               {"half_slot_um", report.half_slot_um},
               {"spacing_um", figure_json(report.spacing_um)},
               {"fod_um", figure_json(report.focus_offset_um)},
               {"bia_deg", figure_json(report.incidence_deg)},
               {"displacement_mm", figure_json(report.displacement_mm)},
               {"landing_um", figure_json(report.landing_um)}};
  json["axes"] = axes_json(report);
  return json;
}

std::string text_of(const PathReport& report) {
  std::string text = fmt::format("{} periods, {} ticks emulated; {} of {} pulses fired\n", report.lines, report.ticks,
                                 report.fired, report.pulses);
  const auto row = [&text](const char* name, const PulseFigure& figure, const char* unit) {
    text += fmt::format("{:<14}{:>12.6g} {} at most (pulse {}), {:.6g} rms\n", name, figure.max, unit,
                        figure.worst_pulse, figure.rms);
  };
  row("spacing", report.spacing_um, "um");
  text += fmt::format("{:<14}{:>12.6g} um\n", "half a slot", report.half_slot_um);
  if (report.points_compared) {
    row("landing", report.landing_um, "um");
    row("focus offset", report.focus_offset_um, "um");
    row("incidence", report.incidence_deg, "deg");
  }
  row("galvo", report.displacement_mm, "mm");
  text += fmt::format("\n{:<6}{:>14}{:>14}{:>14}{:>16}{:>16}\n", "axis", "from", "to", "speed /s", "accel. /s^2",
                      "jerk /s^3");
  for (std::size_t axis = 0; axis < report.axes.size(); ++axis) {
    const AxisUse& use = report.axes[axis];
    text += fmt::format("{:<2}{:<4}{:>14.6f}{:>14.6f}{:>14.6g}{:>16.6g}{:>16.6g}\n", kPathAxes[axis],
                        axis_turns(axis) ? "deg" : "mm", rounded(use.least, 6), rounded(use.most, 6), use.max_speed,
                        use.max_acceleration, use.max_jerk);
  }
  text += "a figure beyond its limit by 1e-6 of that, for axes by what the rounding of set-points adds, is on it\n\n";
  for (const std::string& note : report.notes) {
    text += "note: " + note + "\n";
  }
  for (const std::string& violation : report.violations) {
    text += "violation: " + violation + "\n";
  }
  text += report.violations.empty() ? "within limits\n" : "NOT within limits\n";
  return text;
}

/// What follows contours or a curve, not a picture, has a pulse in every place of one, whatever it was made from.
PathPulses all_pulses_of(const PathPlan& path) {
  return {0, path.pulses, std::vector<std::byte>(static_cast<std::size_t>((path.pulses + 7) / 8), std::byte{0xFF})};
}

}  // namespace

Rational exact_decimal(double value, int digits) {
  return parse_decimal(fmt::format("{:.{}g}", value, digits)).value();
}

Json spacing_json(const PathSpacing& spacing) {
  return {{"pulses", spacing.pulses},
          {"fired_pulses", spacing.fired},
          {"spacing_um", {{"max", spacing.max_error_um}, {"rms", spacing.rms_error_um}}},
          {"half_slot_um", spacing.half_slot_um},
          {"max_speed_mm_s", spacing.max_speed_mm_s}};
}

std::string spacing_text(const PathSpacing& spacing) {
  return fmt::format("{:.4g} um off at most, {:.4g} rms, half a slot {:.4g}; spot at most {:.4g} mm/s",
                     spacing.max_error_um, spacing.rms_error_um, spacing.half_slot_um, spacing.max_speed_mm_s);
}

Result<PathPulses> all_pulses(const std::string& key, double pitch_mm, double length_mm) {
  constexpr double kMostPulses = 8'589'934'592.0;  // 2^33, as of pictures: their bits take 1 GiB
  const double wanted = std::floor(length_mm / pitch_mm + 0.5);
  if (!(wanted >= 1 && wanted <= kMostPulses)) {
    return Error{ErrorCode::out_of_range,
                 fmt::format("{} = {:.6g}: {:.6g} pulses along {:.6g} mm of path; must be 1 to {:.0f}", key,
                             pitch_mm * kUmPerMm, wanted, length_mm, kMostPulses)};
  }
  const auto count = static_cast<std::int64_t>(wanted);
  return PathPulses{pitch_mm, count,
                    std::vector<std::byte>(static_cast<std::size_t>((count + 7) / 8), std::byte{0xFF})};
}

bool axis_turns(std::size_t axis) {
  return kPathAxes[axis] == "A" || kPathAxes[axis] == "C";
}

Result<PathReport> judge_path_program(LineSource& program, const VerifyPathOptions& given,
                                      const std::vector<std::string>& violations,
                                      const std::vector<std::string>& notes) {
  VerifyPathOptions options = given;
  options.cancel = &cancel_token();
  PathPulses all;
  if (const Plan& plan = program.header().plan; options.wanted == nullptr && !plan.path->picture) {
    all = all_pulses_of(*plan.path);
    options.wanted = &all;
  }
  Result<PathReport> judged = [&] {
    ProgressBar bar("verify");
    options.progress = &bar;
    return verify_path(program, emulated_devices(), options);
  }();
  GRAVURE_TRY(PathReport report, std::move(judged));
  report.violations.insert(report.violations.begin(), violations.begin(), violations.end());
  report.notes.insert(report.notes.begin(), notes.begin(), notes.end());
  return report;
}

int print_path_report(const PathReport& report, const Command& command) {
  if (command.json) {
    print_json(json_of(report));
  } else {
    print(text_of(report));
  }
  return report.violations.empty() ? kDone : kLimitViolated;
}

Result<int> unroll_path_program(LineSource& program, const BilevelTiffPage& page, const std::string& output,
                                const Command& command) {
  const Plan& plan = program.header().plan;
  const double pixel_mm = to_double(plan.line.pixel_pitch_um) / 1000;
  const double line_mm = to_double(plan.rotary.line_pitch_um) / 1000;
  const auto row_bytes = static_cast<std::size_t>((page.width + 7) / 8);
  std::vector<std::byte> bits(row_bytes * static_cast<std::size_t>(page.height));
  VerifyPathOptions options;
  options.cancel = &cancel_token();
  std::int64_t outside = 0;
  options.landed = [&](const LandedPulse& landed) -> Result<void> {
    const auto& at = landed.spot.position_mm;
    const auto column = static_cast<std::int64_t>(std::floor(at.x() / pixel_mm + static_cast<double>(page.width) / 2));
    const auto row = static_cast<std::int64_t>(std::floor(static_cast<double>(page.height) / 2 - at.y() / line_mm));
    if (column < 0 || column >= page.width || row < 0 || row >= page.height) {
      ++outside;
      return {};
    }
    bits[static_cast<std::size_t>(row) * row_bytes + static_cast<std::size_t>(column / 8)] |=
        static_cast<std::byte>(0x80U >> static_cast<unsigned>(column % 8));
    return {};
  };
  GRAVURE_TRY(const PathReport report, verify_path(program, emulated_devices(), options));
  if ((program.header().fires == Fires::black) != page.zero_is_white) {
    for (std::size_t i = 0; i < bits.size(); ++i) {
      const bool last = i % row_bytes == row_bytes - 1 && page.width % 8 != 0;
      bits[i] = ~bits[i] & static_cast<std::byte>(last ? 0xFFU << static_cast<unsigned>(8 - page.width % 8) : 0xFFU);
    }
  }
  GRAVURE_TRY(BilevelTiffWriter writer, BilevelTiffWriter::create(output, page));
  GRAVURE_CHECK(writer.append_rows(bits));
  GRAVURE_CHECK(writer.commit());
  if (command.json) {
    print_json({{"picture", output},
                {"width", page.width},
                {"height", page.height},
                {"fired_pulses", report.fired},
                {"outside", outside}});
  } else {
    print(fmt::format("{}: {} x {} pixels, {} pulses, {} of them beside the picture\n", output, page.width, page.height,
                      report.fired, outside));
  }
  return kDone;
}

std::string path_text(const Plan& plan) {
  const PathPlan& path = *plan.path;
  std::string text =
      fmt::format("path      {} periods of {} slots, {} ticks = {:.3f} s; {} pulses {} um apart, {} wanted points\n",
                  plan.rotary.lines_per_revolution, plan.line.slots, plan.job.ticks, to_double(plan.job.duration_s),
                  path.pulses, to_decimal_string(plan.line.pixel_pitch_um), path.targets);
  text += fmt::format("machine   X Y Z A C{}, signs of {}\n",
                      path.has_focus_axis() ? ", galvo and focus axis W" : " and galvo", path.machine);
  for (const auto& [name, value] : {std::pair("surface", path.surface), std::pair("texture", path.texture)}) {
    if (!value.empty()) {
      text += fmt::format("{:<10}{}\n", name, value);
    }
  }
  return text;
}

}  // namespace gravure::cli
