#include <cmath>

#include "gravure/formats/zones_job.hpp"

namespace gravure {
namespace {

constexpr std::string_view kJob = R"(# A gravure job of zones. It runs as it is:
#
#   gravure zones compile job.toml -o job.grv --plot zones.svg
#   gravure verify job.grv                     emulates the program: incidence, field, focus, spacing, axes
#   gravure run job.grv --device emulated
#
# docs/formats/zones_job.md explains every key. Decimal numbers are exact: 0.1 is one tenth.

[job]
title = "starter ridge"
mode  = "zones"                   # lines on a part that looks to many sides

[contours]
file = "contours.json"            # on the CAD, or as `gravure register --contours-out` laid them on a scan
# transform = "t.json"            # where the part is: what `gravure register -o t.json` found

[zones]
method            = "cover"       # the fewest zones; "kmeans" is the published way
max_incidence_deg = 5             # between a contour's direction and its zone's
layer_mm          = 0.1           # thickness of a layer at most; or let [beam] fluence_share decide

[laser]
seed_hz       = 82_000_000        # the seed oscillator clocks everything
pulse_divider = 41                # every 41st seed pulse is amplified: 2 MHz

[marking]
pulse_pitch_um  = 5               # between two pulses along a contour
mark_speed_mm_s = 200             # of the spot, at most
servo_us        = 50              # period of the set-points: a whole number of pulse slots

[machine]
field_mm = 60                     # side of the scan field; file = "machine.toml" describes another machine

[limits]
landing_um = 1                    # `verify` fails where a pulse lands further from its contour
)";

/// To a nanometre: the same text from every compiler.
double to_nm(double mm) {
  return std::round(mm * 1e6) / 1e6 + 0.0;
}

}  // namespace

std::string starter_zones_job() {
  return std::string(kJob);
}

std::vector<Contour> starter_contours() {
  constexpr int kLines = 12;
  constexpr double kTurn_rad = 1.2 / 57.295779513082323;
  constexpr double kRadius_mm = 40;
  std::vector<Contour> contours;
  for (int i = 0; i < kLines; ++i) {
    Contour line;
    line.id = i + 1;
    line.direction = {0, to_nm(std::sin(i * kTurn_rad)), to_nm(std::cos(i * kTurn_rad))};
    for (int k = -4; k <= 4; ++k) {
      const double x = 0.5 * k;
      const double height = kRadius_mm - x * x / 20;
      line.points_mm.push_back({x, to_nm(height * std::sin(i * kTurn_rad)), to_nm(height * std::cos(i * kTurn_rad))});
    }
    contours.push_back(line);
  }
  return contours;
}

}  // namespace gravure
