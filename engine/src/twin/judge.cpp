#include "judge.hpp"

#include <cmath>
#include <cstdio>

namespace gravure {
namespace {

/// Six significant digits, however small the value is.
std::string figure(double value) {
  char text[32];
  static_cast<void>(std::snprintf(text, sizeof text, "%.6g", value));
  return text;
}

/// The seam after every revolution: the drift of the registers the device ran with, exact.
void fill_seam(const Plan& plan, const AxisCheck& axis, VerifyReport& report) {
  const Rational per_revolution = axis.drift_per_line() * plan.rotary.lines_per_revolution;
  report.seam.reserve(static_cast<std::size_t>(report.revolutions));
  for (std::int64_t r = 0; r < report.revolutions; ++r) {
    SeamRow row;
    row.revolution = r;
    row.drift_lines = per_revolution * (r + 1);
    row.drift_um = to_double(Rational(row.drift_lines * plan.rotary.line_pitch_um));
    report.seam.push_back(std::move(row));
  }
  // It grows line by line, so the end of the last line is the worst place.
  report.seam_end_um = report.seam.empty() ? 0.0 : report.seam.back().drift_um;
  report.seam_max_um = std::fabs(report.seam_end_um);
  report.seam_worst_revolution = std::max<std::int64_t>(0, report.revolutions - 1);
  report.seam_worst_line = plan.rotary.lines_per_revolution - 1;
  report.seam_limit_um = to_double(plan.ab.seam_limit_um);
}

/// Does the plan's own word on the drift agree with its registers, and with where the device's axis came to stand?
void judge_drift(const Plan& plan, const AxisCheck& axis, const Tally& tally, VerifyReport& report) {
  const Rational per_revolution = axis.drift_per_line() * plan.rotary.lines_per_revolution;
  if (per_revolution != plan.ab.drift_lines_per_revolution) {
    report.violations.push_back(
        "the A-B registers (m = " + std::to_string(plan.ab.prescaler) +
        ", increment = " + std::to_string(plan.ab.increment) + " + " + std::to_string(plan.ab.fraction_num) + "/" +
        std::to_string(plan.ab.fraction_den) + ") drift by " + figure(to_double(per_revolution)) +
        " lines per revolution, the plan says " + figure(to_double(plan.ab.drift_lines_per_revolution)) +
        ": they are not those of this geometry; compile the job again");
  }
  if (!tally.end_edges) {
    return;  // the last line never ended, which is said
  }
  const std::int64_t lines = plan.job.revolutions * plan.rotary.lines_per_revolution;
  const Rational measured = axis.exact_error_edges(lines, *tally.end_edges);
  report.seam_end_measured_um = to_double(Rational(measured)) * axis.step_um();
  const Rational drift = plan.ab.drift_lines_per_revolution * plan.job.revolutions * plan.rotary.edges_per_revolution /
                         plan.rotary.lines_per_revolution;
  if (measured > drift || drift - measured >= axis.largest_lag_edges()) {
    report.violations.push_back("at the end of the last line the device's axis is " +
                                figure(*report.seam_end_measured_um) + " um off, the plan's drift explains " +
                                figure(to_double(drift) * axis.step_um()) + " um and less than " +
                                figure(to_double(axis.largest_lag_edges()) * axis.step_um()) + " um of step behind it");
  }
}

/// Do the windows put a pixel of either direction on the same place? The reverse one is the forward one run backwards,
/// later by the offset; the run-in of the forward line is half of what the pixels leave.
void judge_windows(const LinePlan& line, VerifyReport& report) {
  const std::int64_t dark = line.slots - line.pixels;
  const std::int64_t forward = dark / 2;
  const std::int64_t reverse = dark - forward + line.offset_slots;
  if (line.forward_first_slot != forward || (line.bidirectional && line.reverse_first_slot != reverse)) {
    report.violations.push_back("the marking windows start at slots " + std::to_string(line.forward_first_slot) +
                                " (forward) and " + std::to_string(line.reverse_first_slot) +
                                " (reverse), but this line has them at " + std::to_string(forward) + " and " +
                                std::to_string(reverse) + ": compile the job again");
  }
}

std::string layers_text(std::int64_t first, std::int64_t last) {
  return first == last ? "layer " + std::to_string(first)
                       : "layers " + std::to_string(first) + " to " + std::to_string(last);
}

/// One violation for each run of layers whose images say the same, for example the slices of one depth map.
void say_unread(const Tally& tally, VerifyReport& report) {
  constexpr int kSaid = 20;
  int said = 0;
  std::int64_t more = 0;
  for (auto from = tally.unread.begin(); from != tally.unread.end();) {
    auto to = from;
    std::int64_t lines = 0;
    std::int64_t last = from->first;
    for (; to != tally.unread.end() && to->second.why == from->second.why && to->first <= last + 1; ++to) {
      lines += to->second.lines;
      last = to->first;
    }
    report.uncompared_lines += lines;
    if (++said <= kSaid) {
      report.violations.push_back("the image of " + layers_text(from->first, last) + " cannot be read, so " +
                                  std::to_string(lines) + " lines were not compared: " + from->second.why);
    } else {
      ++more;
    }
    from = to;
  }
  if (more > 0) {
    report.violations.push_back("and " + std::to_string(more) + " more images cannot be read");
  }
}

void say_violations(const Plan& plan, const AxisCheck& axis, const Tally& tally, bool images_given,
                    VerifyReport& report) {
  const auto say = [&](const std::string& what) { report.violations.push_back(what); };
  if (tally.refused.count > 0) {
    say("the device refused " + place(plan, tally.refused.ordinal) + ": " + tally.refused.detail);
  }
  const std::int64_t lines = plan.job.revolutions * plan.rotary.lines_per_revolution;
  if (tally.lines != lines) {
    say(std::to_string(lines - tally.lines) + " of " + std::to_string(lines) + " lines were never executed");
  }
  if (tally.misplaced.count > 0) {
    say(std::to_string(tally.misplaced.count) + " line(s) in the wrong place, the first at " +
        place(plan, tally.misplaced.ordinal) + ": " + tally.misplaced.detail);
  }
  if (tally.off_axis.count > 0) {
    say("the axis stands wrong at " + std::to_string(tally.off_axis.count) + " line start(s) or ends, the first at " +
        place(plan, tally.off_axis.ordinal) + ": " + tally.off_axis.detail);
  }
  if (!images_given) {
    say("the images were not found, so nothing proves that the program shows them: give --images DIR");
  }
  say_unread(tally, report);
  if (report.wrong_pixels > 0) {
    say(std::to_string(report.wrong_pixels) + " landed pixels differ from the images, the first at " +
        place(plan, tally.first_wrong_ordinal) + ", column " + std::to_string(tally.first_wrong_column));
  }
  judge_windows(plan.line, report);
  judge_drift(plan, axis, tally, report);
  const Rational limit_lines = plan.ab.seam_limit_um / plan.rotary.line_pitch_um;
  if (abs(Rational(axis.drift_per_line() * lines)) > limit_lines) {
    say("seam error of " + figure(report.seam_max_um) +
        " um at the end of the job exceeds limits.seam_um = " + to_decimal_string(plan.ab.seam_limit_um) +
        ": set fpga.fractional, raise scanner.max_extra_slots, or see `gravure suggest`");
  }
}

}  // namespace

VerifyReport judge(const Plan& plan, const AxisCheck& axis, const Tally& tally, bool images_given) {
  VerifyReport report;
  report.revolutions = plan.job.revolutions;
  report.lines = tally.lines;
  report.fired_pixels = tally.fired;
  report.pixels = plan.job.revolutions * plan.rotary.lines_per_revolution * plan.line.pixels;
  report.images_compared = images_given && tally.unread.empty();
  report.wrong_pixels = tally.wrong_pixels;
  if (tally.first_wrong_ordinal >= 0) {
    report.first_wrong_pixel =
        PixelPlace{tally.first_wrong_ordinal / plan.rotary.lines_per_revolution,
                   tally.first_wrong_ordinal % plan.rotary.lines_per_revolution, tally.first_wrong_column};
  }
  report.ticks = tally.end_tick;
  report.ab_step_um = axis.step_um();
  if (tally.worst_ordinal >= 0) {
    report.axis_error_max_um = std::fabs(tally.worst_edges) * axis.step_um();
    report.axis_worst_revolution = tally.worst_ordinal / plan.rotary.lines_per_revolution;
    report.axis_worst_line = tally.worst_ordinal % plan.rotary.lines_per_revolution;
  }
  fill_seam(plan, axis, report);
  say_violations(plan, axis, tally, images_given, report);
  return report;
}

}  // namespace gravure
