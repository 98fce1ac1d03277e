#include "gravure/formats/freeform_job.hpp"

namespace gravure {

std::string freeform_starter_job() {
  return R"(# A gravure job. It runs as it is:
#
#   gravure plan    job.toml              split between stages and galvo, time, limits of all seven axes
#   gravure compile job.toml -o job.grv   surface and texture -> program
#   gravure verify  job.grv               emulates the program, puts every pulse on the surface again
#
# docs/formats/freeform.md explains every key.

[job]
title = "starter saddle"
mode  = "freeform"                # X Y Z A C and the galvo (U V) move at once along a texture on a curved surface

[laser]
seed_hz       = 82_000_000        # the seed oscillator clocks everything
pulse_divider = 41                # every 41st seed pulse is amplified: 2 MHz, a pulse slot of 0.5 us
max_pulse_on_demand_hz = 16_400_000   # fastest rate at which the gate switches single pulses

[fpga]
clock_multiplier = 2              # FPGA clock = 2 * seed

[surface]
expression    = "0.02*x*y"        # z in mm by x and y in mm; or height_field = "map.tif", or mesh = "part.stl"
max_slope_deg = 60                # steeper places are refused

[texture]
bitmap        = "texture.tif"     # 64 x 32 pixels; or hilbert_order, path = "path.csv", svg = "drawing.svg"
pitch_um      = 50                # from pixel to pixel
line_pitch_um = 50                # from line to line
run_out_um    = 300               # dark, before and behind each line
fires         = "white"           # the pixels that get a pulse, "white" or "black"; there is no default

[split]
method = "gaussian"               # how the stages' path is made
rule   = "time"                   # the smallest sigma that takes at most 0.5 % longer than the fastest; or "published"

[limits]
fod_um          = 100             # focus offset
bia_deg         = 10              # angle of incidence
displacement_mm = 5               # what the galvo reaches

[motion]
servo_us = 50                     # from set-point to set-point, a whole number of pulse slots

[axis.X]                          # limits of each axis; those left out are those of docs/texture.md
max_speed_mm_s         = 100
max_acceleration_mm_s2 = 100
max_jerk_mm_s3         = 10_000
)";
}

}  // namespace gravure
