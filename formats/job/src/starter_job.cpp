#include <initializer_list>

#include "gravure/formats/job_file.hpp"

namespace gravure {
namespace {

// The parts of the starter jobs, in the order in which they stand.

constexpr std::string_view kHead = R"(# A gravure job. It runs as it is:
#
#   gravure plan    job.toml              clock tree, line, A-B signal, drift, time
#   gravure compile job.toml -o job.grv   images -> program
#   gravure verify  job.grv               emulates the program and compares it with the images
#
# docs/formats/job.md explains every key. Decimal numbers are exact: 0.1 is one tenth.

)";

constexpr std::string_view kRotaryJob = R"([job]
title = "starter roller"
mode  = "rotary"                  # the workpiece turns, the scanner sweeps lines along its axis

)";

constexpr std::string_view kHelicalJob = R"([job]
title = "starter roller, helical"
mode  = "helical"                 # the workpiece turns while a carriage moves the scanner along it

)";

constexpr std::string_view kFlatJob = R"([job]
title = "starter panel"
mode  = "flat"                    # a stage moves the workpiece to and fro under the lines

)";

constexpr std::string_view kMachine = R"([laser]
seed_hz       = 82_000_000        # the seed oscillator clocks everything
pulse_divider = 41                # every 41st seed pulse is amplified: 2 MHz
max_pulse_on_demand_hz = 16_400_000   # fastest rate at which the gate switches single pulses

[fpga]
clock_multiplier = 2              # FPGA clock = 2 * seed
counter_bits     = 32             # width of the A-B counter
fractional       = false          # true where the counter has the second accumulator: then the axis never drifts
max_prescaler    = 4_294_967_295  # the counter may add its increment on every m-th clock, up to this m

[scanner]
pixel_pitch_um        = 8.0       # between two pulses of a line: 2 MHz * 8 um = 16 m/s
slots_per_microvector = 16        # one scanner set-point every 16 pulse slots
turn_slots            = 1984      # least number of dark slots in which the scanner turns round
max_extra_slots       = 0         # dark slots the planner may add to a line to improve the seam
bidirectional         = true      # every other line runs back
bidirectional_offset_ticks = 0    # FPGA ticks by which lines running back are later; may be negative
)";

constexpr std::string_view kScanner =
    R"(field_mm              = 20.0      # the square that the scanner reaches; a wider image is cut in bands
max_speed_mm_s         = 20_000   # what it can follow; without these three lines and turns are not checked
max_acceleration_mm_s2 = 40_000_000
max_jerk_mm_s3         = 4_000_000_000_000
)";

constexpr std::string_view kField =
    R"(field_mm              = 0.3       # what the scanner reaches: the 0.512 mm of the images become two bands
)";

constexpr std::string_view kRotary = R"(
[rotary]
diameter_mm          = 5.0        # or circumference_mm
lines_per_revolution = 1968       # or line_pitch_um; 5 mm * pi / 1968 = 7.98 um
encoder_lines        = 10_000
interpolation_bits   = 5          # the drive counts 2^5 A-B periods for one encoder line
gear                 = [1, 1]     # encoder turns : workpiece turns
max_ab_hz            = 2_000_000  # fastest A-B signal the drive accepts

)";

constexpr std::string_view kCarriage = R"([carriage]
feed_pixels        = 16           # columns the carriage advances in a turn; any decimal number
layers             = 2            # layers exposed in one pass: a line exposes 2 * 16 columns
encoder_pitch_um   = 20.0         # travel of one encoder line
interpolation_bits = 8            # the drive counts 2^8 A-B periods for one encoder line
max_ab_hz          = 2_000_000    # fastest A-B signal the drive accepts

)";

constexpr std::string_view kStage = R"(
[stage]
lines              = 1968         # of a pass
line_pitch_um      = 8.0
encoder_pitch_um   = 20.0         # travel of one encoder line
interpolation_bits = 8            # the drive counts 2^8 A-B periods for one encoder line
max_ab_hz          = 2_000_000    # fastest A-B signal the drive accepts

)";

constexpr std::string_view kRotaryImage = R"([image]
files       = ["layers/*.tif"]    # 64 pixels wide, 1968 high: one row a line, one image a revolution
fires       = "white"             # the pixels that get a pulse, "white" or "black"; there is no default
lines_along = "rows"              # "columns": an image column is a line
order       = "sequence"          # layer r on revolution r; or "cycle", "hold" (repeat the last)
# revolutions = 2                 # default: one per layer

)";

constexpr std::string_view kHelicalImage = R"([image]
files       = ["layers/*.tif"]    # the unrolled surface: 64 columns, 1968 rows; one image a layer, the first comes first
fires       = "white"             # the pixels that get a pulse, "white" or "black"; there is no default
lines_along = "rows"              # "columns": an image column is a line

)";

constexpr std::string_view kFlatImage = R"([image]
files       = ["layers/*.tif"]    # 64 pixels wide, 1968 high: one row a line, one image a pass of each band
fires       = "white"             # the pixels that get a pulse, "white" or "black"; there is no default
lines_along = "rows"              # "columns": an image column is a line
order       = "sequence"          # layer p on pass p of a band; or "cycle", "hold" (repeat the last)
# revolutions = 2                 # passes of a band; default: one per layer

)";

constexpr std::string_view kLimits = R"([limits]
seam_um = 0.5                     # how far the end of a revolution may be from the start of the next
)";

std::string joined(std::initializer_list<std::string_view> parts) {
  std::string text;
  for (const std::string_view part : parts) {
    text += part;
  }
  return text;
}

}  // namespace

std::string starter_job(Mode mode) {
  switch (mode) {
    case Mode::rotary:
      return joined({kHead, kRotaryJob, kMachine, kScanner, kRotary, kRotaryImage, kLimits});
    case Mode::helical:
      return joined({kHead, kHelicalJob, kMachine, kScanner, kRotary, kCarriage, kHelicalImage, kLimits});
    case Mode::flat:
      return joined({kHead, kFlatJob, kMachine, kField, kStage, kFlatImage, kLimits});
    case Mode::freeform:  // other files, other readers
    case Mode::zones:
      break;
  }
  return {};
}

}  // namespace gravure
