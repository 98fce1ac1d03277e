#include "job/job_scanner.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "gravure/core/file_output.hpp"
#include "gravure/scan/field_grid.hpp"
#include "verb.hpp"

namespace gravure::cli {
namespace {

namespace fs = std::filesystem;

std::string beside(const Job& job, const std::string& file) {
  return (fs::path(job.path).parent_path() / file).string();
}

/// `error` with the place of the key it is about: the first of those that it names.
Error at_key(const Job& job, const Error& error) {
  for (const char* key : {"turn_slots", "field_mm", "lag_us", "offset_deg", "max_speed_mm_s", "field_grid"}) {
    if (error.message.find(key) != std::string::npos) {
      return {error.code, job.place_of(std::string("scanner.") + key) + error.message};
    }
  }
  return {error.code, job.place_of("scanner") + error.message};
}

/// The turn with the least time to spare.
struct Turn {
  double lasts_us = 0;
  double shortest_us = 0;  ///< 0: no limits
};

Turn tightest_turn(const scan::LinePath& path) {
  Turn tightest;
  bool is_first = true;
  for (const scan::Direction before : {scan::Direction::forward, scan::Direction::reverse}) {
    if (before == scan::Direction::reverse && !path.timing().bidirectional) {
      continue;
    }
    for (const scan::MirrorTurn& turn : path.turn_after(before)) {
      const Turn here{turn.lasts_s * 1e6, turn.shortest_s * 1e6};
      if (is_first || here.lasts_us - here.shortest_us < tightest.lasts_us - tightest.shortest_us) {
        tightest = here;
        is_first = false;
      }
    }
  }
  return tightest;
}

}  // namespace

Result<void> read_scanner_files(Job& job) {
  if (!job.scanner.field_grid) {
    return {};
  }
  const std::string path = beside(job, *job.scanner.field_grid);
  const auto text = read_file(path, scan::kMostGridBytes);
  if (!text) {
    return Error{text.error().code, job.place_of("scanner.field_grid") + text.error().message};
  }
  GRAVURE_TRY(const scan::FieldGrid grid, scan::parse_field_grid(text.value(), path));
  job.scanner.field_grid_text = scan::field_grid_text(grid);
  return {};
}

Result<std::optional<scan::JobTrajectory>> check_trajectory(const Job& job, Plan& plan) {
  if (!plan.scanner) {
    return std::optional<scan::JobTrajectory>();
  }
  Result<scan::JobTrajectory> made = scan::JobTrajectory::make(plan);
  if (!made) {
    return at_key(job, made.error());
  }
  const std::vector<std::string>& warnings = made.value().of_revolution(0).warnings;
  plan.warnings.insert(plan.warnings.end(), warnings.begin(), warnings.end());
  return std::optional(std::move(made).value());
}

std::string trajectory_text(const scan::LineTrajectory& trajectory) {
  const scan::LineQuality& quality = trajectory.quality;
  const Turn turn = tightest_turn(trajectory.path);
  const double slot_us = trajectory.path.timing().slot_s() * 1e6;
  std::string text = fmt::format(
      "{:<10}{:.6g} mm/s, turn {:.6g} us = {:.6g} slots of constant speed to constant speed, {}, reach {:.6g} mm\n",
      "scanner", trajectory.scan_speed_mm_s, turn.lasts_us, turn.lasts_us / slot_us,
      turn.shortest_us > 0 ? fmt::format("shortest {:.6g} us", turn.shortest_us) : "shortest unknown without limits",
      trajectory.path.reach_mm());
  text += fmt::format(
      "{:<10}{:.3g} um along and {:.3g} um across the line at most, focus {:.3g} um, incidence {:.4g} deg, a count is "
      "{:.4g} um\n",
      "landing", quality.along_um, quality.across_um, quality.defocus_um, quality.incidence_deg,
      trajectory.resolution_mm * 1000);
  if (trajectory.options.field_grid) {
    text += fmt::format("{:<10}field grid undone; interpolation between its nodes adds {:.3g} um at most, estimated\n",
                        "grid", trajectory.field_grid_error_um);
  }
  return text;
}

Json trajectory_json(const scan::LineTrajectory& trajectory) {
  const scan::LineQuality& quality = trajectory.quality;
  const Turn turn = tightest_turn(trajectory.path);
  return {{"set_points", trajectory.forward.size()},
          {"resolution_um", rounded(trajectory.resolution_mm * 1000, 9)},
          {"scan_speed_mm_s", rounded(trajectory.scan_speed_mm_s, 9)},
          {"turn_us", rounded(turn.lasts_us, 9)},
          {"shortest_turn_us", turn.shortest_us > 0 ? Json(rounded(turn.shortest_us, 9)) : Json(nullptr)},
          {"reach_mm", rounded(trajectory.path.reach_mm(), 9)},
          {"lag_ticks", trajectory.lag_ticks},
          {"lag_remainder_ticks", json_ratio(trajectory.lag_remainder_ticks)},
          {"along_um", rounded(quality.along_um, 9)},
          {"across_um", rounded(quality.across_um, 9)},
          {"interpolation_um", rounded(quality.interpolation_um, 9)},
          {"defocus_um", rounded(quality.defocus_um, 9)},
          {"straight_um", rounded(quality.straight_um, 9)},
          {"incidence_deg", rounded(quality.incidence_deg, 9)},
          {"field_grid_error_um", rounded(trajectory.field_grid_error_um, 9)}};
}

}  // namespace gravure::cli
