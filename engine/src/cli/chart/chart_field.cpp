#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "chart/charts.hpp"
#include "verb.hpp"

namespace gravure::cli {
namespace {

constexpr double kUsed = 0.9;         // of the field: its rim is left to the turns
constexpr double kSteepest_deg = 60;  // incidence up to which marks stay readable
constexpr std::int64_t kArm = 7;      // pixels of a cross, to either side of its middle

/// A row of marks: one job, its lines `offset_deg` round the circumference.
struct MarkRow {
  std::string name;
  double offset_deg = 0;
  double v_mm = 0;
  std::int64_t line = 0;  ///< of the middles of the marks
};

MarkRow mark_row(const ChartBase& base, const ChartOptions& options, std::int64_t row) {
  const double radius_mm = to_double(base.plan.rotary.circumference_um) / (2000 * std::numbers::pi);
  const double reach_mm =
      std::min(kUsed * base.field_mm / 2, radius_mm * std::sin(kSteepest_deg * std::numbers::pi / 180));
  const double share = 2 * static_cast<double>(row) / static_cast<double>(options.rows - 1) - 1;
  MarkRow made;
  // Whole millionths of a degree, so that the job says exactly what the table does.
  made.offset_deg = rounded(std::asin(share * reach_mm / radius_mm) * 180 / std::numbers::pi, 6);
  made.v_mm = radius_mm * std::sin(made.offset_deg * std::numbers::pi / 180);
  const std::int64_t middle = (options.rows - 1) / 2;
  made.name = row == middle ? "job" : fmt::format("job_{}", row);
  made.line = (2 * row + 1) * base.plan.rotary.lines_per_revolution / (2 * options.rows);
  return made;
}

/// Lines run one way, so the scanner flies back over all of them: dark slots that are enough under its limits, by ramps
/// that take the jerk limit at both ends and a flight at full speed between them, and a tenth more.
std::int64_t fly_back_slots(const ChartBase& base, double width_mm) {
  const ScannerPlan none;
  const ScannerPlan& scanner = base.plan.scanner ? *base.plan.scanner : none;
  if (!scanner.max_speed_mm_s || !scanner.max_acceleration_mm_s2) {
    return 0;
  }
  const double speed = 1000 * to_double(base.plan.line.scan_speed_m_s);
  const double most = to_double(*scanner.max_speed_mm_s);
  const double acceleration = to_double(*scanner.max_acceleration_mm_s2);
  const double jerk_s = scanner.max_jerk_mm_s3 ? acceleration / to_double(*scanner.max_jerk_mm_s3) : 0;
  const double ramp_s = (speed + most) / acceleration + jerk_s;
  const double flight_s = std::max(0.0, (width_mm + (speed - most) * ramp_s) / most);
  return static_cast<std::int64_t>(std::ceil(1.1 * (2 * ramp_s + flight_s) * to_double(base.plan.clock.pulse_hz)));
}

}  // namespace

Result<Chart> field_chart(const ChartBase& base, const ChartOptions& options) {
  if (base.plan.mode == Mode::flat) {
    return Error{
        ErrorCode::bad_argument,
        "the field chart is for a workpiece that turns, whose lines can lie at any V: give --job a rotary one"};
  }
  const std::int64_t lines = base.plan.rotary.lines_per_revolution;
  if (lines < options.rows * 4 * kArm) {
    return Error{ErrorCode::out_of_range, fmt::format("--rows {}: {} lines have room for {} rows of marks at most",
                                                      options.rows, lines, lines / (4 * kArm))};
  }
  const double pitch_mm = to_double(base.plan.line.pixel_pitch_um) / 1000;
  const auto width = static_cast<std::int64_t>(kUsed * base.field_mm / pitch_mm) + 2 * kArm + 1;
  if (static_cast<double>(width) * pitch_mm > base.field_mm || width < options.columns * 4 * kArm) {
    return Error{ErrorCode::out_of_range,
                 fmt::format("--columns {}: a field of {} mm has room for {} marks at most", options.columns,
                             base.field_mm, static_cast<std::int64_t>(kUsed * base.field_mm / pitch_mm) / (4 * kArm))};
  }
  Chart chart;
  std::string csv = "u_order_mm,v_order_mm,x_mm,s_mm,cos_offset\n";
  std::string runs;
  const std::int64_t turn_slots = std::max(base.plan.line.slots - base.plan.line.pixels,
                                           fly_back_slots(base, static_cast<double>(width) * pitch_mm));
  for (std::int64_t row = 0; row < options.rows; ++row) {
    const MarkRow made = mark_row(base, options, row);
    ChartPicture picture(width, lines);
    for (std::int64_t column = 0; column < options.columns; ++column) {
      const std::int64_t x = kArm + column * (width - 2 * kArm - 1) / (options.columns - 1);
      picture.fill({x - kArm, made.line, 2 * kArm + 1, 1});
      picture.fill({x, made.line - kArm, 1, 2 * kArm + 1});
      const double u_mm = (static_cast<double>(x) - static_cast<double>(width - 1) / 2) * pitch_mm;
      csv += fmt::format("{:.6f},{:.6f},{:.6f},{:.6f},{:.6f}\n", u_mm + 0.0, made.v_mm, u_mm + 0.0,
                         static_cast<double>(made.line) * to_double(base.plan.rotary.line_pitch_um) / 1000,
                         std::cos(made.offset_deg * std::numbers::pi / 180));
    }
    const std::string layer = fmt::format("layers/row_{}.tif", row);
    chart.pictures.push_back({layer, {picture}});
    chart.jobs.push_back({made.name + ".toml",
                          {fmt::format("field chart, row {} of {}", row, options.rows),
                           "rotary",
                           "files = [\"" + layer + "\"]\nfires = \"white\"\n",
                           {{{"scanner", "bidirectional"}, "false"},
                            {{"scanner", "turn_slots"}, std::to_string(turn_slots)},
                            {{"scanner", "field_mm"}, fmt::format("{}", base.field_mm)},
                            {{"scanner", "offset_deg"}, fmt::format("{:.6f}", made.offset_deg)}}}});
    runs += fmt::format("    gravure compile {0}.toml -o {0}.grv\n    gravure verify {0}.grv\n", made.name);
  }
  chart.texts.push_back({"orders.csv", csv});
  chart.texts.push_back(
      {"README.md",
       fmt::format(
           "# Field grid\n\n"
           "{0} rows of {1} crosses over {2} mm of the field. Each row is a job of its own with another `offset_deg`, "
           "because lines that lie beside the top of the workpiece are marked at another V. All rows go on the same "
           "workpiece, which must not be unclamped in between, and each lies on other lines. The scanner's own "
           "correction is off: take `field_grid` out of the job that this chart is made from.\n\n"
           "Measure each cross on the workpiece, unrolled: x along it from the middle cross of the middle row "
           "(job.toml), "
           "s round it from line 0, and write, a mark a line in the order of `orders.csv`,\n\n"
           "    u_order_mm, v_order_mm, u_landing_mm, v_landing_mm\n\n"
           "with u_landing = x measured, v_landing = v_order + (s measured - s_mm) * cos_offset (`orders.csv` has "
           "s_mm and cos_offset). Then\n\n"
           "    gravure calibrate marks.csv -o field_grid.txt --field-mm {3}\n\n"
           "and `field_grid = \"field_grid.txt\"` in [scanner] of your job undoes what was measured. Write this chart "
           "again with it: what is left is the error of measuring.\n"
           "\n## Run it\n\n{4}",
           options.rows, options.columns, kUsed * base.field_mm, base.field_mm, runs)});
  return chart;
}

}  // namespace gravure::cli
