#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "gravure/core/layer_lines.hpp"
#include "gravure/core/progress.hpp"
#include "gravure/twin/error_budget.hpp"
#include "gravure/twin/exposure.hpp"

namespace gravure {

/// The seam between a revolution and the next: how far the axis is from where the line is marked. Positive: it leads.
struct SeamRow {
  std::int64_t revolution = 0;  ///< this revolution has just ended
  Rational drift_lines = 0;     ///< accumulated since the first line of the job
  double drift_um = 0;
};

struct PixelPlace {
  std::int64_t revolution = 0;
  std::int64_t line = 0;
  std::int64_t column = 0;  ///< pixel of the line
};

/// The second A-B channel of a helical job: as for the axis below, along the workpiece.
struct CarriageReport {
  double ab_step_um = 0;    ///< one A-B edge
  double error_max_um = 0;  ///< of the line starts, edges against ideal motion
  std::int64_t worst_revolution = 0;
  std::int64_t worst_line = 0;
  double drift_um_per_revolution = 0;
  double seam_end_um = 0;  ///< drift over the job, with sign
  std::optional<double> seam_end_measured_um;
};

struct VerifyReport {
  std::int64_t revolutions = 0;
  std::int64_t lines = 0;         ///< executed by the device
  std::int64_t fired_pixels = 0;  ///< what the gate let through
  std::int64_t pixels = 0;
  bool images_compared = false;       ///< every line of every revolution
  std::int64_t uncompared_lines = 0;  ///< of all revolutions: their images could not be read
  std::int64_t wrong_pixels = 0;      ///< landed != image
  std::optional<PixelPlace> first_wrong_pixel;

  std::vector<SeamRow> seam;  ///< one for each revolution
  double seam_max_um = 0;     ///< largest of all lines, without sign
  std::int64_t seam_worst_revolution = 0;
  std::int64_t seam_worst_line = 0;
  double seam_end_um = 0;  ///< accumulated over the job, with sign
  double seam_limit_um = 0;
  /// The same end as the device tells it after the last line: its edges against the ideal turning, at most the lag of
  /// one step away from seam_end_um. None if no device came to the end of the job.
  std::optional<double> seam_end_measured_um;

  /// The axis at the line starts as the A-B edges put it, against the ideal turning: drift and whole steps together.
  double axis_error_max_um = 0;
  std::int64_t axis_worst_revolution = 0;
  std::int64_t axis_worst_line = 0;
  double ab_step_um = 0;  ///< one A-B edge on the surface

  std::optional<CarriageReport> carriage;  ///< helical jobs
  std::optional<ErrorBudget> error;        ///< where one was asked for

  std::int64_t ticks = 0;               ///< the device took
  std::vector<std::string> violations;  ///< each once; empty: within limits
  std::vector<std::string> notes;
};

/// Asks for an error budget, and what it is judged by; limits that are absent are not.
struct BudgetOptions {
  TwinSettings twin;
  std::optional<Rational> landing_um;
  std::optional<Rational> defocus_um;
};

struct VerifyOptions {
  std::int64_t memory_bytes = std::int64_t{256} << 20;
  std::int64_t table_bytes = 0;  ///< of them for what the readers of the program hold together
  int threads = 0;               ///< 0: one for each processor
  CancelToken* cancel = nullptr;
  Progress* progress = nullptr;
  std::optional<BudgetOptions> budget = {};
};

/// Runs every line of every revolution through devices made by `devices`, puts what the gate let through back to pixels
/// and compares it with `images` (none: said as a violation), and the axis at each line start with the plan's turning.
/// The wanted turning comes from the plan's geometry (lines, slots, encoder, gear), not from its A-B solution.
/// The set-points that a program stores are held against its plan's, each. With `budget`, the landing of the pulses is
/// bounded and sampled as error_budget() does and judged by its limits. Violations are reported, not errors; errors are
/// an unreadable program, a memory budget too small for one worker (out of range, naming what is needed) and
/// cancellation. An image that cannot be read is a violation, too, and all others are still compared. `programs` gives
/// each worker a reader of the program; fewer run where memory does not suffice.
Result<VerifyReport> verify(const std::function<Result<std::unique_ptr<LineSource>>()>& programs,
                            const DeviceFactory& devices, const LayerLinesFactory& images,
                            const VerifyOptions& options);

}  // namespace gravure
