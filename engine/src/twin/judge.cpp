#include "judge.hpp"

#include <cmath>

#include "figure.hpp"
#include "gravure/core/board_runs.hpp"

namespace gravure {
namespace {

/// Revolutions over which a drift adds up by the end of revolution `revolution`: those of its run.
std::int64_t drifting_revolutions(const Plan& plan, std::int64_t revolution) {
  return revolution - run_with(plan, revolution).first_revolution + 1;
}

/// The seam after every revolution: the drift of the registers the device ran with, exact.
void fill_seam(const Plan& plan, const AxisCheck& axis, VerifyReport& report) {
  const Rational per_revolution = axis.drift_per_line() * plan.rotary.lines_per_revolution;
  report.seam.reserve(static_cast<std::size_t>(report.revolutions));
  for (std::int64_t r = 0; r < report.revolutions; ++r) {
    SeamRow row;
    row.revolution = r;
    row.drift_lines = per_revolution * drifting_revolutions(plan, r);
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

/// Does a channel's own word on its drift agree with its registers, and with where the device's axis came to stand?
/// Gives where that is against the ideal, in um.
std::optional<double> judge_drift(const Plan& plan, const AbPlan& ab, const Rational& edges_per_revolution,
                                  const AxisCheck& axis, const AxisTally& tally, VerifyReport& report) {
  const std::string whose = axis.name() == std::string("axis") ? "" : std::string(axis.name()) + ": ";
  const Rational per_revolution = axis.drift_per_line() * plan.rotary.lines_per_revolution;
  if (per_revolution != ab.drift_lines_per_revolution) {
    report.violations.push_back(
        whose + "the A-B registers (m = " + std::to_string(ab.prescaler) +
        ", increment = " + std::to_string(ab.increment) + " + " + std::to_string(ab.fraction_num) + "/" +
        std::to_string(ab.fraction_den) + ") drift by " + figure(to_double(per_revolution)) +
        " lines per revolution, the plan says " + figure(to_double(ab.drift_lines_per_revolution)) +
        ": they are not those of this geometry; compile the job again");
  }
  if (!tally.end_edges) {
    return std::nullopt;  // the last line never ended, which is said
  }
  const std::int64_t lines = plan.job.revolutions * plan.rotary.lines_per_revolution;
  const Rational measured = axis.exact_error_at_end(lines - 1, *tally.end_edges);
  const double measured_um = to_double(Rational(measured)) * axis.step_um();
  const Rational drift = ab.drift_lines_per_revolution * drifting_revolutions(plan, plan.job.revolutions - 1) *
                         edges_per_revolution / plan.rotary.lines_per_revolution;
  if (measured > drift + axis.largest_lead_edges() || drift - measured >= axis.largest_lag_edges()) {
    report.violations.push_back(whose + "at the end of the last line the device's axis is " + figure(measured_um) +
                                " um off, the plan's drift explains " + figure(to_double(drift) * axis.step_um()) +
                                " um and less than " + figure(to_double(axis.largest_lag_edges()) * axis.step_um()) +
                                " um of step behind it");
  }
  return measured_um;
}

void judge_carriage(const Plan& plan, const AxisCheck& axis, const AxisTally& tally, VerifyReport& report) {
  const CarriagePlan& carriage = *plan.carriage;
  CarriageReport said;
  said.ab_step_um = axis.step_um();
  if (tally.worst_ordinal >= 0) {
    said.error_max_um = std::fabs(tally.worst_edges) * axis.step_um();
    said.worst_revolution = tally.worst_ordinal / plan.rotary.lines_per_revolution;
    said.worst_line = tally.worst_ordinal % plan.rotary.lines_per_revolution;
  }
  const Rational end_um = axis.drift_per_line() * plan.job.revolutions * carriage.feed_um;
  said.seam_end_um = to_double(end_um);
  said.drift_um_per_revolution = to_double(Rational(axis.drift_per_line() * carriage.feed_um));
  said.seam_end_measured_um = judge_drift(plan, carriage.ab, carriage.edges_per_revolution, axis, tally, report);
  if (abs(end_um) > carriage.ab.seam_limit_um) {
    report.violations.push_back("the carriage is " + figure(std::fabs(said.seam_end_um)) +
                                " um off at the end of the job, which exceeds limits.seam_um = " +
                                to_decimal_string(carriage.ab.seam_limit_um) +
                                ": raise scanner.max_extra_slots, or change carriage.feed_pixels");
  }
  report.carriage = said;
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

/// Stored layers; in a helical program those are revolutions.
std::string layers_text(const Plan& plan, std::int64_t first, std::int64_t last) {
  const std::string one = plan.carriage ? "revolution" : "layer";
  return first == last ? one + " " + std::to_string(first)
                       : one + "s " + std::to_string(first) + " to " + std::to_string(last);
}

/// One violation for each run of layers whose images say the same, for example the slices of one depth map.
void say_unread(const Plan& plan, const Tally& tally, VerifyReport& report) {
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
      report.violations.push_back("the image of " + layers_text(plan, from->first, last) + " cannot be read, so " +
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

void say_off_axis(const Plan& plan, const AxisCheck& axis, const Finding& wrong, VerifyReport& report) {
  if (wrong.count > 0) {
    report.violations.push_back(std::string("the ") + axis.name() + " stands wrong at " + std::to_string(wrong.count) +
                                " line start(s) or ends, the first at " + place(plan, wrong.ordinal) + ": " +
                                wrong.detail);
  }
}

void say_violations(const Plan& plan, const AxisChecks& axes, const Tally& tally, bool images_given,
                    VerifyReport& report) {
  const AxisCheck& axis = axes.cross_scan;
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
  say_off_axis(plan, axis, tally.axis.wrong, report);
  if (axes.carriage) {
    say_off_axis(plan, *axes.carriage, tally.carriage.wrong, report);
  }
  if (!images_given) {
    say("the images were not found, so nothing proves that the program shows them: give --images DIR");
  }
  say_unread(plan, tally, report);
  if (report.wrong_pixels > 0) {
    say(std::to_string(report.wrong_pixels) + " landed pixels differ from the images, the first at " +
        place(plan, tally.first_wrong_ordinal) + ", column " + std::to_string(tally.first_wrong_column));
  }
  judge_windows(plan.line, report);
  report.seam_end_measured_um = judge_drift(plan, plan.ab, plan.rotary.edges_per_revolution, axis, tally.axis, report);
  const Rational limit_lines = plan.ab.seam_limit_um / plan.rotary.line_pitch_um;
  const std::int64_t drifting = drifting_revolutions(plan, plan.job.revolutions - 1) * plan.rotary.lines_per_revolution;
  if (abs(Rational(axis.drift_per_line() * drifting)) > limit_lines) {
    say("seam error of " + figure(report.seam_max_um) + " um at the end of the job exceeds limits.seam_um = " +
        to_decimal_string(plan.ab.seam_limit_um) + ": set fpga.fractional" +
        (plan.mode == Mode::rotary ? ", raise scanner.max_extra_slots, or see `gravure suggest`"
                                   : " or raise scanner.max_extra_slots"));
  }
  if (axes.carriage) {
    judge_carriage(plan, *axes.carriage, tally.carriage, report);
  }
}

}  // namespace

VerifyReport judge(const Plan& plan, const AxisChecks& axes, const Tally& tally, bool images_given) {
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
  const AxisTally& seen = tally.axis;
  report.ab_step_um = axes.cross_scan.step_um();
  if (seen.worst_ordinal >= 0) {
    report.axis_error_max_um = std::fabs(seen.worst_edges) * axes.cross_scan.step_um();
    report.axis_worst_revolution = seen.worst_ordinal / plan.rotary.lines_per_revolution;
    report.axis_worst_line = seen.worst_ordinal % plan.rotary.lines_per_revolution;
  }
  fill_seam(plan, axes.cross_scan, report);
  say_violations(plan, axes, tally, images_given, report);
  return report;
}

}  // namespace gravure
