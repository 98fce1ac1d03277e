#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gravure/core/contour.hpp"
#include "gravure/core/error.hpp"
#include "gravure/core/exact.hpp"
#include "gravure/core/job.hpp"
#include "gravure/formats/job_keys.hpp"

namespace gravure {

/// The beam before its lens, and what it does to the material.
struct ZonesBeam {
  Rational wavelength_um = 0;
  Rational m_squared = 1;
  Rational diameter_mm = 0;
  Rational focal_length_mm = 0;
  std::optional<Rational> fluence_share;  ///< of the peak, that a layer's edges still have: it decides how thick one is
  std::optional<Rational> average_power_w;  ///< with threshold_j_cm2 or not at all: then line widths are known
  std::optional<Rational> threshold_j_cm2;
};

/// A job of mode "zones" as its file says it, docs/formats/zones_job.md. Files are named from the job's folder.
struct ZonesJob {
  Job job;  ///< title, mode, laser, FPGA clock, file, text and places; nothing else of it
  std::string contours;
  std::string transform;  ///< empty: contours lie where they are
  bool by_kmeans = false;
  std::size_t clusters = 0;  ///< of k-means; 0: the fewest that meet the limits
  bool normalised = true;
  std::uint64_t seed = 1;
  Rational max_incidence_deg = 0;
  std::optional<Rational> layer_mm;  ///< either this or beam->fluence_share
  std::optional<ZonesBeam> beam;
  Rational servo_us = 50;
  Rational pulse_pitch_um = 0;
  Rational mark_speed_mm_s = 0;
  std::optional<Rational> jump_speed_mm_s;  ///< none: as fast as the head can
  std::string machine;                      ///< empty: the example machine of zones/plan_zones.hpp
  std::optional<Rational> field_mm;         ///< in place of the machine's
  std::optional<Rational> max_landing_um;
};

/// Reads a job of mode "zones". Fails as read_job().
Result<ZonesJob> read_zones_job(const std::string& path);

/// The job that `text` describes; `path` is only named, in errors. Violations as those of parse_job().
Result<ZonesJob> parse_zones_job(std::string_view text, const std::string& path);

/// Every key the reader knows, in the order of docs/formats/zones_job.md.
std::vector<JobKey> zones_job_keys();

/// A commented job that compiles as it is beside a file contours.json of starter_contours().
std::string starter_zones_job();
/// Twelve lines on a ridge that turns by 13.2 degrees from the first to the last, 4 mm long, 0.2 mm lower at their
/// ends.
std::vector<Contour> starter_contours();

}  // namespace gravure
