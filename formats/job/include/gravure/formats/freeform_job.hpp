#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gravure/core/error.hpp"
#include "gravure/core/job.hpp"
#include "gravure/core/path_motion.hpp"
#include "gravure/formats/job_keys.hpp"

namespace gravure {

/// What a freeform job says (docs/formats/freeform.md explains every key). Numbers are geometry: doubles, to 15 digits.
/// Choices are the words of the file.

/// The surface and the texture on it. Exactly one of surface, height_field and mesh is given, and one of hilbert_order,
/// path, svg and bitmap.
struct TextureSettings {
  std::string folder;   ///< names of files are relative to it; empty: to where the program runs
  std::string surface;  ///< z in mm by x and y in mm
  std::string height_field;
  std::optional<double> pixel_um;
  std::optional<double> pixel_y_um;
  std::vector<double> height_mm;  ///< of the smallest and of the largest sample; empty: not given
  std::string mesh;
  double max_slope_deg = 80;
  int hilbert_order = 0;
  double size_mm = 40;
  std::string path;
  std::string svg;
  double tolerance_um = 1;
  std::string bitmap;
  std::optional<double> pitch_um;
  std::optional<double> line_pitch_um;
  double run_out_um = 500;
  std::string fires;
  std::optional<std::int64_t> threshold;
  std::optional<double> step_um;
};
inline constexpr std::int64_t kMostHilbertOrder = 10;

/// How the path is split between stages and galvo, and what both are allowed.
struct SplitSettings {
  std::string method = "gaussian";
  bool focus_axis = false;         ///< an axis takes up the focus offset: no limit for it but focus_mm
  std::optional<double> focus_mm;  ///< what that axis reaches from its middle
  std::optional<double> sigma_um;
  std::string rule = "time";  ///< for sigma where it is not given
  double time_share_percent = 0.5;
  double cut = 8;
  double fod_um = 100;
  double bia_deg = 10;
  double displacement_mm = 5;
  std::optional<double> landing_um;
};
inline constexpr std::array<std::string_view, 5> kSplitMethods = {"gaussian", "savitzky-golay", "fft", "adaptive",
                                                                  "optimal"};
inline constexpr std::array<std::string_view, 2> kSigmaRules = {"time", "published"};

/// How the machine stands and how the workpiece lies in it.
struct AxesSettings {
  std::string branch = "positive";
  std::string signs = "texturing";
  std::vector<double> origin_mm = {0, 0, 0};
  std::vector<double> tilt_deg = {0, 0};
};
inline constexpr std::array<std::string_view, 2> kBranches = {"positive", "negative"};
inline constexpr std::array<std::string_view, 2> kSigns = {"texturing", "post-processor"};

/// Limits of an axis, mm or rad a s, s^2 and s^3; those left out are of [A] table 1, which has none for W.
struct GivenBounds {
  std::optional<double> speed;
  std::optional<double> acceleration;
  std::optional<double> jerk;
};
/// The position loop of an axis; what is left out is assumed.
struct GivenServo {
  std::optional<double> natural_hz;
  std::optional<double> damping;
};
struct MotionSettings {
  std::string stops;  ///< empty: at the points of a Hilbert curve, else at corners
  double servo_us = 50;
  std::array<GivenBounds, kPathAxes.size()> limits;
  std::array<GivenServo, kPathAxes.size()> servos;
};
inline constexpr std::array<std::string_view, 2> kStops = {"points", "corners"};

struct FreeformJob {
  Job job;  ///< title, mode, laser, FPGA clock, file, text and places; nothing else of it
  TextureSettings texture;
  SplitSettings split;
  AxesSettings axes;
  MotionSettings motion;
};

/// Reads a job of mode "freeform". Fails as read_job().
Result<FreeformJob> read_freeform_job(const std::string& path);

/// The job that `text` describes; `path` is only named, and its folder is that of the job's files. Violations as those
/// of parse_job().
Result<FreeformJob> parse_freeform_job(std::string_view text, const std::string& path);

/// Every key the reader knows, in the order of docs/formats/freeform.md.
std::vector<JobKey> freeform_job_keys();

/// The mode that a job names, "freeform" and "zones" included; none where the file cannot be read, is no TOML or names
/// none. Nothing else of it is looked at.
std::optional<Mode> mode_of_job(const std::string& path);
std::optional<Mode> mode_of_job_text(std::string_view text);

/// A commented job that runs as it is when `texture.tif` beside it is a bilevel image of kStarterTexturePixels x
/// kStarterTextureLines pixels.
std::string freeform_starter_job();
inline constexpr int kStarterTexturePixels = 64;
inline constexpr int kStarterTextureLines = 32;

}  // namespace gravure
