#include "gravure/formats/job_file.hpp"

namespace gravure {
namespace {

constexpr std::string_view kRotary = R"(# A gravure job. It runs as it is:
#
#   gravure plan    job.toml              clock tree, line, A-B signal, drift, time
#   gravure compile job.toml -o job.grv   images -> program
#   gravure verify  job.grv               emulates the program and compares it with the images
#
# docs/formats/job.md explains every key. Decimal numbers are exact: 0.1 is one tenth.

[job]
title = "starter roller"
mode  = "rotary"                  # the workpiece turns, the scanner sweeps lines along its axis

[laser]
seed_hz       = 82_000_000        # the seed oscillator clocks everything
pulse_divider = 41                # every 41st seed pulse is amplified: 2 MHz
max_pulse_on_demand_hz = 16_400_000   # fastest rate at which the gate switches single pulses

[fpga]
clock_multiplier = 2              # FPGA clock = 2 * seed
counter_bits     = 32             # width of the A-B counter
fractional       = false          # true where the counter has the second accumulator: then nothing drifts, ever
max_prescaler    = 4_294_967_295  # the counter may add its increment on every m-th clock, up to this m

[scanner]
pixel_pitch_um        = 8.0       # between two pulses of a line: 2 MHz * 8 um = 16 m/s
slots_per_microvector = 16        # one scanner set-point every 16 pulse slots
turn_slots            = 1984      # least number of dark slots in which the scanner turns round
max_extra_slots       = 0         # dark slots the planner may add to a line to improve the seam
bidirectional         = true      # every other line runs back
bidirectional_offset_ticks = 0    # FPGA ticks by which lines running back are later; may be negative

[rotary]
diameter_mm          = 5.0        # or circumference_mm
lines_per_revolution = 1968       # or line_pitch_um; 5 mm * pi / 1968 = 7.98 um
encoder_lines        = 10_000
interpolation_bits   = 5          # the drive counts 2^5 A-B periods for one encoder line
gear                 = [1, 1]     # encoder turns : workpiece turns
max_ab_hz            = 2_000_000  # fastest A-B signal the drive accepts

[image]
files       = ["layers/*.tif"]    # 64 pixels wide, 1968 high: one row a line, one image a revolution
fires       = "white"             # the pixels that get a pulse, "white" or "black"; there is no default
lines_along = "rows"              # "columns": an image column is a line
order       = "sequence"          # layer r on revolution r; or "cycle", "hold" (repeat the last)
# revolutions = 2                 # default: one per layer

[limits]
seam_um = 0.5                     # how far the end of a revolution may be from the start of the next
)";

}  // namespace

std::string_view starter_job(Mode mode) {
  switch (mode) {
    case Mode::rotary:
      return kRotary;
  }
  return {};
}

}  // namespace gravure
