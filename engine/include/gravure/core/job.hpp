#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gravure/core/exact.hpp"

namespace gravure {

/// What the user wants, as the job file says it: values checked one by one, not yet against each other (make_plan
/// does). docs/formats/job.md explains every field; names and units are those of the file.

enum class Mode : std::uint8_t { rotary, helical, flat, freeform, zones };
/// "rotary", "helical", "flat", "freeform", "zones", as the job file says it.
std::string_view mode_name(Mode mode);

/// Seven axes follow a path; nothing turns with the lines, which are servo periods (PathPlan).
constexpr bool follows_path(Mode mode) {
  return mode == Mode::freeform || mode == Mode::zones;
}

struct LaserSettings {
  std::int64_t seed_hz = 0;
  std::int64_t pulse_divider = 1;           ///< k: every k-th seed pulse is amplified
  std::int64_t max_pulse_on_demand_hz = 0;  ///< fastest rate at which the gate can switch single pulses
  // What a pulse removes: for the expected relief alone. Where one of the four is absent it is told in pulses.
  std::optional<Rational> spot_um = {};          ///< diameter 2 w0 in focus, to 1/e^2 of the intensity
  std::optional<Rational> fluence_j_cm2 = {};    ///< in the centre of the spot
  std::optional<Rational> threshold_j_cm2 = {};  ///< of ablation
  std::optional<Rational> penetration_nm = {};   ///< depth a pulse gains when the fluence grows by a factor e
};

struct FpgaSettings {
  std::int64_t clock_multiplier = 1;  ///< j: FPGA clock = j * seed
  int counter_bits = 32;              ///< n, 8..64
  bool fractional = false;            ///< the counter has the second accumulator
  std::uint64_t max_prescaler = 4'294'967'295U;
};

struct ScannerSettings {
  Rational pixel_pitch_um = 0;
  std::int64_t slots_per_microvector = 1;
  std::int64_t turn_slots = 0;       ///< least run-out + run-in between two lines
  std::int64_t max_extra_slots = 0;  ///< slots the planner may add to a line to improve the seam
  bool bidirectional = true;
  std::int64_t bidirectional_offset_ticks = 0;  ///< delay of right-to-left lines in FPGA ticks
  std::optional<Rational> field_mm;             ///< longest line the scanner can mark; wider images get bands
  int resolution_bits = 20;                     ///< set-points are integers of so many bits over the field
  Rational lag_us = 0;                          ///< the mirrors follow their set-points so much later
  bool compensate_lag = true;                   ///< set-points are sent early by the lag
  std::optional<Rational> max_speed_mm_s;       ///< of each mirror; absent limits are not checked
  std::optional<Rational> max_acceleration_mm_s2;
  std::optional<Rational> max_jerk_mm_s3;
  bool cross_scan_correction = true;      ///< V follows the moving surface
  Rational offset_deg = 0;                ///< where round the circumference the lines lie, 0 at the top
  Rational tilt_deg_per_mm = 0;           ///< f-theta lens: tilt of the beam a mm of distance from the centre
  std::optional<std::string> field_grid;  ///< file of the scanner's distortion, relative to the job file
  std::string field_grid_text;            ///< what that file says; filled in by whoever reads it
};

/// The machine file that describes scan head and joints where the job leaves them out.
struct MachineSettings {
  std::optional<std::string> file;  ///< relative to the job file
};

/// What an axis can do; absent limits are not checked. Degrees for rotary axes, mm for linear ones.
struct AxisLimits {
  std::optional<Rational> max_speed;
  std::optional<Rational> max_acceleration;
  std::optional<Rational> max_jerk;
};

struct RotarySettings {
  std::optional<Rational> diameter_mm;  ///< exactly one of diameter and circumference
  std::optional<Rational> circumference_mm;
  std::optional<Rational> line_pitch_um;  ///< exactly one of pitch and lines per revolution
  std::optional<std::int64_t> lines_per_revolution;
  std::int64_t encoder_lines = 0;
  int interpolation_bits = 0;           ///< q
  std::int64_t gear_encoder_turns = 1;  ///< encoder turns : workpiece turns
  std::int64_t gear_workpiece_turns = 1;
  std::int64_t max_ab_hz = 0;
  Rational start_angle_deg = 0;  ///< of line 0 from the encoder index
  AxisLimits limits;             ///< all three given: the axis is spun up and down under them
};

/// Helical mode: the axis that carries the scanner along the workpiece, by the second A-B channel.
struct CarriageSettings {
  Rational feed_pixels = 0;       ///< h: columns the carriage advances in a revolution
  std::int64_t layers = 0;        ///< L: layers of the stack exposed in one pass
  Rational encoder_pitch_um = 0;  ///< travel of one encoder line
  int interpolation_bits = 0;     ///< q
  std::int64_t max_ab_hz = 0;
  AxisLimits limits;
};

/// Flat mode: the stage that carries the workpiece across the lines, by the first A-B channel.
struct StageSettings {
  std::int64_t lines = 0;  ///< lines of a pass
  Rational line_pitch_um = 0;
  Rational encoder_pitch_um = 0;  ///< travel of one encoder line
  int interpolation_bits = 0;     ///< q
  std::int64_t max_ab_hz = 0;
  AxisLimits limits;
};

enum class Fires : std::uint8_t { white, black };
enum class LinesAlong : std::uint8_t { rows, columns };
enum class LayerOrder : std::uint8_t { sequence, cycle, hold };

struct ImageSettings {
  std::vector<std::string> files;        ///< patterns, relative to the job file
  std::optional<std::string> depth_map;  ///< instead of files: one grey image, sliced into `levels` layers
  std::optional<std::int64_t> levels;
  std::optional<Rational> depth_min;      ///< sample value that gets no pulse (float maps; default 0)
  std::optional<Rational> depth_max;      ///< sample value that gets every pulse (default 1, or the integer maximum)
  std::optional<std::int64_t> threshold;  ///< grey layers: a sample >= threshold is white
  Fires fires = Fires::white;
  LinesAlong lines_along = LinesAlong::rows;
  std::optional<std::int64_t> revolutions;  ///< default: one per layer
  LayerOrder order = LayerOrder::sequence;
  std::optional<std::int64_t> pixels_per_line;  ///< lets a job be planned without its images
};

/// Step and repeat: the images are tiles, laid side by side.
struct RepeatSettings {
  std::int64_t around = 1;     ///< tiles across the lines: round the circumference, along the stage
  std::int64_t along = 1;      ///< tiles along a line
  bool mirror_around = false;  ///< every other tile round the circumference is turned over, top to bottom
  bool mirror_along = false;   ///< every other tile along a line is turned over, left to right
};

struct Limits {
  Rational seam_um = 0;
  std::optional<Rational> landing_um;  ///< largest landing error of a pulse; absent: not judged
  std::optional<Rational> defocus_um;
};

/// The terms of the twin's error budget. A term that is off adds nothing to the landing of a pulse.
struct TwinSettings {
  struct Servo {  ///< the axis follows its A-B signal as a second-order system
    bool enabled = false;
    Rational bandwidth_hz = 0;
    Rational damping = ratio(7, 10);
  };
  struct RunOut {  ///< the workpiece turns about an axis beside its own
    bool enabled = false;
    Rational eccentricity_um = 0;
    Rational angle_deg = 0;  ///< of the high spot, from line 0
  };
  struct Thermal {  ///< the workpiece has grown since it was measured
    bool enabled = false;
    Rational temperature_change_k = 0;
    Rational expansion_um_per_m_k = 0;
  };
  bool drift = true;
  bool ab_step = true;
  bool galvo_resolution = true;
  bool microvectors = true;
  bool cross_scan = true;
  bool lag = true;
  bool defocus = true;
  Servo servo;
  RunOut run_out;
  Thermal thermal;
};

/// A place in a text file; both count from 1, columns in characters.
struct TextPlace {
  std::uint32_t line = 0;
  std::uint32_t column = 0;
  bool operator<(const TextPlace& other) const {
    return line != other.line ? line < other.line : column < other.column;
  }
};

struct Job {
  std::string title;
  Mode mode = Mode::rotary;
  LaserSettings laser;
  FpgaSettings fpga;
  ScannerSettings scanner;
  RotarySettings rotary;      ///< rotary and helical
  CarriageSettings carriage;  ///< helical
  StageSettings stage;        ///< flat
  ImageSettings image;
  RepeatSettings repeat;
  Limits limits;
  TwinSettings twin;
  MachineSettings machine;

  std::string path;  ///< the job file; image patterns are relative to its folder
  std::string text;  ///< its bytes, stored in the program
  /// Where each section ("rotary") and each key ("rotary.gear") stands in the file; empty for a job made otherwise.
  std::map<std::string, TextPlace, std::less<>> places;

  /// "job.toml:12:8: ", how a message about `key` begins. A key that was left out stands where its section does; ""
  /// where nothing is known.
  std::string place_of(std::string_view key) const;
};

}  // namespace gravure
