#include "chart/charts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace gravure::cli {
namespace {

constexpr std::int64_t kMargin = 16;  // pixels and rows round everything
constexpr std::int64_t kReach = 8;    // marks of a vernier to either side of the middle
constexpr std::int64_t kPitch = 12;   // of its fixed scale; the other one has a pixel less

Result<void> check_rows(const ChartBase& base, std::int64_t wanted, const char* chart) {
  const std::int64_t lines = base.plan.rotary.lines_per_revolution;
  if (lines >= wanted) {
    return {};
  }
  return Error{ErrorCode::out_of_range, fmt::format("the {} chart takes {} lines, the workpiece has {}: give --job one "
                                                    "with more lines_per_revolution, or a larger workpiece",
                                                    chart, wanted, lines)};
}

std::string mode_word(const Plan& plan) {
  return plan.mode == Mode::flat ? "flat" : "rotary";
}

std::string image_section(const std::string& files, const std::string& more = "") {
  return "files = [\"" + files + "\"]\nfires = \"white\"\n" + more;
}

std::string signed_number(std::int64_t number) {
  return number == 0 ? "0" : fmt::format("{:+}", number);
}

/// What every README ends with.
std::string how_to_run(const std::string& jobs) {
  return "\n## Run it\n\n" + jobs +
         "\nThe exit status of `verify` is 0: what is judged afterwards is the machine, not the program.\n";
}

std::string commands(const std::string& job) {
  return fmt::format("    gravure compile {0}.toml -o {0}.grv\n    gravure verify {0}.grv\n", job);
}

}  // namespace

Result<Chart> bidirectional_chart(const ChartBase& base, const ChartOptions& options) {
  constexpr std::int64_t kScaleRows = 48;
  constexpr std::int64_t kBarRows = 48;
  constexpr std::int64_t kLabelRows = 16;
  GRAVURE_CHECK(check_rows(base, 2 * kMargin + kLabelRows + 2 * kScaleRows + kMargin + kBarRows, "bidirectional"));
  const std::int64_t width = 2 * (kMargin + kPitch * (kReach + 1));
  const std::int64_t middle = width / 2;
  ChartPicture picture(width, base.plan.rotary.lines_per_revolution);
  const std::int64_t scale_row = kMargin + kLabelRows;  // even: forward lines; both counts of rows are even, too
  for (std::int64_t mark = -kReach; mark <= kReach; ++mark) {
    const std::int64_t thick = mark == 0 ? 4 : 2;
    picture.fill({middle + mark * kPitch - 1, scale_row, 2, kScaleRows, 2});
    picture.fill({middle + mark * (kPitch - 1) - 1, scale_row + kScaleRows + 1, 2, kScaleRows, 2});
    if (mark % 4 == 0) {
      const std::string label = signed_number(mark);
      picture.write(middle + mark * kPitch - ChartPicture::text_width(label, thick / 2) / 2, kMargin, label, 2, 2);
    }
    const std::int64_t bars_row = scale_row + 2 * kScaleRows + kMargin;
    picture.fill({middle + mark * kPitch - 1, bars_row, 2, kBarRows});
  }
  Chart chart;
  chart.pictures.push_back({"layers/bidirectional.tif", {picture}});
  const std::int64_t slot_ticks = base.plan.clock.ticks_per_slot;
  std::string table = "| job | scan speed, m/s | a mark is |\n|---|---|---|\n";
  std::string runs;
  for (const std::int64_t percent : options.speeds) {
    const std::string name = percent == 100 ? "job" : fmt::format("job_{}", percent);
    const Rational pitch_um = base.plan.line.pixel_pitch_um * percent / 100;
    chart.jobs.push_back({name + ".toml",
                          {"bidirectional offset chart, " + std::to_string(percent) + " % of the speed",
                           mode_word(base.plan),
                           image_section("layers/bidirectional.tif"),
                           {{{"scanner", "bidirectional"}, "true"},
                            {{"scanner", "bidirectional_offset_ticks"}, std::to_string(options.offset_ticks)},
                            {{"scanner", "pixel_pitch_um"}, to_decimal_string(pitch_um)}}}});
    table +=
        fmt::format("| {}.toml | {:.6g} | {:.6g} um |\n", name,
                    to_double(base.plan.line.scan_speed_m_s) * static_cast<double>(percent) / 100, to_double(pitch_um));
    runs += commands(name);
  }
  chart.texts.push_back(
      {"README.md",
       fmt::format(
           "# Bidirectional offset against speed\n\n"
           "The upper scale is marked by lines running forward alone, the lower one by lines running back, a pixel "
           "a mark closer. Find the mark that goes straight on from the upper scale to the lower one: it is the "
           "middle one, under the number 0, where the offset is right. The bars below are straight then.\n\n"
           "Mark +n (to the right of 0): lines running back lie n pixels too far right. Set\n\n"
           "    bidirectional_offset_ticks = {0} + n * {1}\n\n"
           "({1} FPGA ticks are a pulse slot, a pixel) in [scanner] of your job, and write this chart again with "
           "`--offset-ticks` to see what is left.\n\n{2}\n"
           "A pure delay of the scanner shows the same mark at every speed. Where the marks differ, its lag depends "
           "on the speed: use the offset of the speed that you run.\n",
           options.offset_ticks, slot_ticks, table) +
           how_to_run(runs)});
  return chart;
}

Result<Chart> seam_chart(const ChartBase& base, const ChartOptions& options) {
  if (base.plan.mode == Mode::flat) {
    return Error{ErrorCode::bad_argument, "the seam chart is for a workpiece that turns: give --job a rotary one"};
  }
  constexpr std::int64_t kJointRows = 40;
  constexpr std::int64_t kBlock = 64;  // columns of a revolution that is looked at
  constexpr std::int64_t kBlocks = 6;
  constexpr std::int64_t kScaleRows = 2 * kPitch * (kReach + 1);
  GRAVURE_CHECK(check_rows(base, 2 * kJointRows + kScaleRows + 4 * kMargin, "seam"));
  const std::int64_t lines = base.plan.rotary.lines_per_revolution;
  const std::int64_t blocks = std::min(kBlocks, options.revolutions);
  std::vector<std::int64_t> shown;  // the revolutions that are looked at, the last one among them
  for (std::int64_t block = 0; block < blocks; ++block) {
    shown.push_back(blocks == 1 ? 0 : block * (options.revolutions - 1) / (blocks - 1));
  }
  const std::int64_t width = 2 * kMargin + blocks * kBlock;
  const std::int64_t middle = kJointRows + kMargin + kScaleRows / 2;
  Chart chart;
  chart.pictures.push_back({"layers/seam.tif", {}});
  for (std::int64_t revolution = 0; revolution < options.revolutions; ++revolution) {
    ChartPicture picture(width, lines);
    for (std::int64_t block = 0; block < blocks; ++block) {
      const std::int64_t left = kMargin + block * kBlock;
      for (std::int64_t mark = -kReach; mark <= kReach && revolution == 0; ++mark) {
        picture.fill({left, middle + mark * kPitch - 1, mark == 0 ? 30 : 20, 2});
      }
      if (shown[static_cast<std::size_t>(block)] != revolution) {
        continue;
      }
      picture.fill({left, -kJointRows, kBlock / 2, 2 * kJointRows});
      picture.fill({left + kBlock / 2, -kJointRows, kBlock / 4, kJointRows});
      for (std::int64_t mark = -kReach; mark <= kReach; ++mark) {
        picture.fill({left + 32, middle + mark * (kPitch - 1) - 1, mark == 0 ? 30 : 20, 2});
      }
      const std::string label = std::to_string(revolution);
      picture.write(left + 4, middle + kScaleRows / 2 + kMargin, label, 2);
    }
    chart.pictures.back().pages.push_back(picture);
  }
  chart.jobs.push_back({"job.toml",
                        {fmt::format("seam chart, {} revolutions", options.revolutions),
                         "rotary",
                         image_section("layers/seam.tif"),
                         {}}});
  const double drift_um = to_double(base.plan.ab.drift_um_per_revolution);
  chart.texts.push_back(
      {"README.md",
       fmt::format(
           "# Butt joint of the seam at {0} revolutions\n\n"
           "Each block of columns belongs to one revolution, whose number stands in it. A line is {1:.6g} um.\n\n"
           "**Joint.** At the seam, where line {2} meets line 0, the area to the left is marked on both sides of it, "
           "in "
           "one revolution. It must look whole: a dark line is a gap, a bright one an overlap, as large as the error "
           "of "
           "one turn. A gap that is equal in all blocks and that `plan` does not know comes from the machine: the "
           "encoder lines, the gear ratio, or a slipping chuck.\n\n"
           "**Scale.** On the left the scale of revolution 0, on the right that of the block's own revolution, a line "
           "a "
           "mark closer. The mark that goes straight on from left to right says by how many lines that revolution has "
           "moved; in the block of revolution 0 it is the long one in the middle. n marks onward in the direction of "
           "rising lines: n lines = n * {1:.6g} um in all.\n\n"
           "The plan says {3:.6g} um of drift a revolution, {4:.6g} um after {0}. More than that has a cause outside "
           "the "
           "clocks.\n",
           options.revolutions, to_double(base.plan.rotary.line_pitch_um), lines - 1, drift_um,
           drift_um * static_cast<double>(options.revolutions)) +
           how_to_run(commands("job"))});
  return chart;
}

Result<Chart> dots_chart(const ChartBase& base, const ChartOptions& options) {
  constexpr std::int64_t kDots = 6;      // a side of a cell
  constexpr std::int64_t kSpacing = 16;  // of the dots, and of the lines
  constexpr std::int64_t kCell = kDots * kSpacing;
  constexpr std::int64_t kLargest = 4;  // pixels a side of a dot
  std::vector<std::int64_t> pulses;
  for (std::int64_t count = 1; count <= options.most_pulses; count *= 2) {
    pulses.push_back(count);
  }
  const auto groups = static_cast<std::int64_t>(pulses.size());
  GRAVURE_CHECK(check_rows(base, 2 * kMargin + groups * (kCell + kMargin), "dots"));
  const std::int64_t left = 2 * kMargin + ChartPicture::text_width("1024", 3);
  const std::int64_t width = left + (kLargest + 2) * (kCell + kMargin);
  Chart chart;
  chart.pictures.push_back({"layers/dots.tif", {}});
  for (std::int64_t layer = 0; layer < pulses.back(); ++layer) {
    ChartPicture picture(width, base.plan.rotary.lines_per_revolution);
    for (std::int64_t group = 0; group < groups; ++group) {
      const std::int64_t top = kMargin + group * (kCell + kMargin);
      if (layer == 0) {
        picture.write(kMargin, top, std::to_string(pulses[static_cast<std::size_t>(group)]), 3);
      }
      if (pulses[static_cast<std::size_t>(group)] <= layer) {
        continue;
      }
      for (std::int64_t size = 1; size <= kLargest; ++size) {
        for (std::int64_t dot = 0; dot < kDots * kDots; ++dot) {
          picture.fill({left + (size - 1) * (kCell + kMargin) + dot % kDots * kSpacing, top + dot / kDots * kSpacing,
                        size, size});
        }
      }
      for (std::int64_t line = 0; line < kDots; ++line) {
        picture.fill({left + kLargest * (kCell + kMargin) + line * kSpacing, top, line + 1, kCell});
        picture.fill({left + (kLargest + 1) * (kCell + kMargin), top + line * kSpacing, kCell, line + 1});
      }
    }
    chart.pictures.back().pages.push_back(picture);
  }
  chart.jobs.push_back({"job.toml", {"dot chart", mode_word(base.plan), image_section("layers/dots.tif"), {}}});
  chart.texts.push_back(
      {"README.md",
       fmt::format(
           "# Dot size\n\n"
           "A group of cells for each number of pulses on one place: the number to the left of it, 1 to {0}. In "
           "a group, from left to right: dots of 1 x 1, 2 x 2, 3 x 3 and 4 x 4 pixels, {1} pixels apart; bars round "
           "the workpiece, 1 to 6 pixels wide; bars along the lines, 1 to 6 lines wide. A pixel is {2:.6g} um, a "
           "line {3:.6g} um.\n\n"
           "Measure the diameter of the 1 x 1 dots in each group: diameter^2 against the logarithm of the pulse "
           "energy is a straight line whose slope gives the waist (cut the chart once more with another energy). The "
           "first group in which single dots touch says when the pitch is too small. Dots that are longer along the "
           "lines than round the workpiece: the pulse is longer than the gate, or the scan is out of focus. The group "
           "of the deepest dots that are still round is the largest useful number of pulses.\n",
           pulses.back(), kSpacing, to_double(base.plan.line.pixel_pitch_um),
           to_double(base.plan.rotary.line_pitch_um)) +
           how_to_run(commands("job"))});
  return chart;
}

}  // namespace gravure::cli
