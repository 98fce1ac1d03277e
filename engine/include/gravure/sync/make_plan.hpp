#pragma once

#include <cstdint>
#include <optional>

#include "gravure/core/error.hpp"
#include "gravure/core/job.hpp"
#include "gravure/core/plan.hpp"

namespace gravure {

/// The plan of a job: what the axis, the scanner and the gate do, in FPGA ticks, and how far the seam drifts.
///
/// Line: np = pixels + turn_slots rounded up to whole microvectors; with max_extra_slots the np within that many more
/// slots whose drift is smallest (exact comparison, ties to the shorter line). The forward marking window starts at
/// floor((np - pixels)/2), the reverse one at its mirror image plus the whole slots of the bidirectional offset.
/// Lines per revolution: as given, or circumference / pitch to the nearest integer.
/// A-B: X from [B] eq. 6 with the gear on the encoder; best_ab_pair() under eq. 2 and max_ab_hz, or exact_fraction()
/// where the counter has the second accumulator. Publication [B] fixes m = 1 and rounds; the best pair is never worse.
/// Drift: positive when the axis leads. With rel = (incr/m)/X - 1 and tau = seam_um / line pitch, both in lines:
/// lines_until_limit = ceil(tau/|rel|), revolutions_until_limit = ceil(lines_until_limit / nL) (during that revolution,
/// counted from 1, the limit is reached), bound_lines_until_limit = floor(2 incr tau), from [B] eq. 10.
///
/// Flat mode: the stage is the axis and a pass is a revolution; each pass starts where the one before ended.
/// Bands: an image of more columns than scanner.field_mm holds gets as few bands as fit, equally wide but for the last.
/// Helical mode: window and revolutions as CarriagePlan says; the carriage's channel is solved like the other one, and
/// of all lengths of line the one with the smallest largest drift in um counts.
///
/// Scanner: where scanner.field_mm is given, what the job says of the scanner is taken over as it is; whether lines and
/// turns keep its limits is plan_trajectory()'s to say (scan).
///
/// `columns`: pixels of a whole image line. `exposures`: rotary and flat, revolutions (passes) of each band; helical,
/// the layers there are, which must be carriage.layers.
///
/// The job's values are checked alone and against each other. Every violation is one line of the error, said once:
/// "section.key = value: what is wrong; what would fit". The code is that of the first: out_of_range for a value
/// outside its range or out of reach, bad_argument for values that contradict each other.
/// What is allowed but worth knowing (drift above the limit within the job, a pitch changed by rounding, ...) is in
/// Plan::warnings. All tick counts fit std::int64_t.
Result<Plan> make_plan(const Job& job, std::int64_t columns, std::int64_t exposures);

/// Which layer revolution `revolution` (from 0) exposes. layers >= 1; with LayerOrder::sequence revolution < layers, as
/// resolve_revolutions() guarantees.
std::int64_t layer_of_revolution(LayerOrder order, std::int64_t layers, std::int64_t revolution);

/// How many revolutions each band of the job has, or how many layers a helical job: as given, else one for each layer.
/// `layers` is empty while the images have not been looked at; a depth map then counts its levels. bad_argument when
/// neither is known, when there is no layer, or when LayerOrder::sequence has another number of revolutions than layers
/// (both are named).
Result<std::int64_t> resolve_revolutions(const Job& job, std::optional<std::int64_t> layers);

}  // namespace gravure
