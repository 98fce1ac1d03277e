#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gravure/core/program.hpp"
#include "gravure/core/progress.hpp"
#include "gravure/scan/line_trajectory.hpp"

namespace gravure {

/// What can keep a pulse from its target; docs/error_budget.md has the formula of each.
enum class ErrorTerm : std::uint8_t {
  drift,
  ab_step,
  galvo_resolution,
  microvectors,
  cross_scan,
  lag,
  defocus,
  servo,
  run_out,
  thermal,
};
inline constexpr std::size_t kErrorTerms = 10;
inline constexpr std::array<ErrorTerm, kErrorTerms> kAllErrorTerms = {
    ErrorTerm::drift,      ErrorTerm::ab_step, ErrorTerm::galvo_resolution, ErrorTerm::microvectors,
    ErrorTerm::cross_scan, ErrorTerm::lag,     ErrorTerm::defocus,          ErrorTerm::servo,
    ErrorTerm::run_out,    ErrorTerm::thermal};
/// As the job file has it: "ab_step".
std::string_view term_name(ErrorTerm term) noexcept;

/// Where a pulse of the job is; all from 0.
struct PulsePlace {
  std::int64_t revolution = 0;
  std::int64_t line = 0;
  std::int64_t slot = 0;
};

/// How far pulses land from their targets on the surface, in um.
struct ErrorBudget {
  /// No pulse of the job misses its target by more: a bound, from every line in closed form.
  double max_um = 0;
  double rms_um = 0;            ///< of the fired pulses that were simulated
  double simulated_max_um = 0;  ///< the largest of them
  PulsePlace worst;             ///< where that was
  std::int64_t simulated_pulses = 0;
  std::vector<std::int64_t> simulated_revolutions;
  /// Largest distance of the surface from focus, all terms that lift it together; none where the scanner is not known
  /// or the term is off.
  std::optional<double> defocus_max_um;
  /// The bound with this term alone, by ErrorTerm; 0 where it is off (for the scanner's also below 1e-9, the arithmetic
  /// of the geometry), none where it cannot be known. For defocus the distance of the surface from focus by the
  /// geometry of the line: no part of max_um.
  std::array<std::optional<double>, kErrorTerms> budget_um;
  std::array<bool, kErrorTerms> enabled = {};  ///< by ErrorTerm: was it asked for?
  std::vector<std::string> notes;
};

struct ErrorBudgetRequest {
  TwinSettings twin;
  const scan::LineTrajectory* trajectory = nullptr;  ///< none: the terms of the scanner cannot be known
  const scan::LineTrajectory* back = nullptr;        ///< of the passes in which the stage of a flat job comes back
  std::int64_t most_pulses = 200'000'000;            ///< about so many are simulated, one revolution in part at least
  int threads = 0;                                   ///< 0: one for each processor
  const CancelToken* cancel = nullptr;
};

/// Bounds the landing error of all pulses of a program line by line, and simulates every fired pulse of its first,
/// its last and its worst revolution and some between. Fails where the program cannot be read or its registers are
/// none, and on cancellation.
Result<ErrorBudget> error_budget(const std::function<Result<std::unique_ptr<LineSource>>()>& programs,
                                 const ErrorBudgetRequest& request);

}  // namespace gravure
