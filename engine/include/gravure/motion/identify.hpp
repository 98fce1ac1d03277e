#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "gravure/motion/vibration.hpp"

namespace gravure::motion {

/// A measured acceleration over time.
struct Recording {
  std::vector<double> time_s;
  std::vector<double> acceleration_mm_s2;
};

/// Two columns, time in s and acceleration in mm/s^2, separated by comma, semicolon, tab or blanks. A first line that
/// does not start with a number is a heading; lines that start with # are comments. bad_file names the line that is
/// anything else; at most 10 million samples.
Result<Recording> parse_recording_csv(std::string_view text);

enum class RecordingOf : std::uint8_t {
  step,      ///< the axis begins to accelerate evenly at start_s and goes on doing so
  run_down,  ///< the axis is at rest (or moves evenly) from start_s on and what it carries rings down
};

struct IdentifyRequest {
  Recording recording;
  RecordingOf of = RecordingOf::run_down;
  double start_s = 0;       ///< samples before are not used
  std::uint32_t modes = 0;  ///< 1 to 4; 0 lets the data choose
  /// What excited the run-down, up to start_s (as input_of() gives it): turns amplitudes into participations.
  std::vector<InputJump> input;
  double max_f_sd_percent = 2;  ///< refuse beyond: the data cannot tell
  double max_zeta_sd = 0.02;    ///< likewise
};

/// A mode with one standard deviation of each number.
struct IdentifiedMode {
  Mode mode;
  double f_sd_hz = 0;
  double zeta_sd = 0;
  double participation_sd = 0;
  /// Two modes of half this amplitude each, at equal damping, show as two in such a record, with such noise, from this
  /// distance on; closer ones look like this one, with these uncertainties. Infinite where none would show.
  double resolution_hz = 0;
};

struct Identification {
  std::vector<IdentifiedMode> modes;  ///< by frequency
  /// Shares of the whole motion; otherwise (a run-down with no input known) of the sum of amplitudes at start_s.
  bool participation_is_absolute = false;
  double offset_mm_s2 = 0;  ///< the step's size, or the sensor's offset
  double noise_sd_mm_s2 = 0;
  std::uint64_t samples = 0;
  double record_s = 0;   ///< length of what was fitted: 1 / record_s is the classical resolution
  double sample_hz = 0;  ///< what vibrates above half of it appears below, folded
  /// What this record cannot tell: modes that may be two, modes that may be folded; with the value and what to do.
  std::vector<std::string> warnings;
};

/// Poles by ESPRIT on strided Hankel matrices, then least squares on sum exp(-s t) (A cos w t + B sin w t) + offset;
/// the number of modes by the Bayesian information criterion; uncertainties from the Jacobian at the optimum, which
/// assumes white noise. Refuses with bad_file data that cannot tell: too few, uneven or not finite samples; nothing but
/// noise; a vibration that grows; modes above 0.45 of the sample rate, less certain than the request allows, or closer
/// to each other than their uncertainty; a record shorter than two periods; amplitudes that do not fit the stated
/// input. Warns where a mode's resolution is coarser than a quarter of its bandwidth 2 zeta f (a closer pair beats by
/// a quarter of a radian at most before it has decayed to 1/e, so that it may as well be one), where a mode is above a
/// fifth of the sample rate (one at the sample rate less f, folded, is then within four times f), and where what is
/// left alternates from sample to sample as a vibration close to half the sample rate does.
Result<Identification> identify(const IdentifyRequest& request);

}  // namespace gravure::motion
