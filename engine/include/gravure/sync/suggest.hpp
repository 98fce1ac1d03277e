#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "gravure/core/error.hpp"
#include "gravure/core/job.hpp"
#include "gravure/sync/ab_ratio.hpp"

namespace gravure {

/// How far a suggested job may be from the given one.
struct SuggestTolerances {
  std::int64_t lines_per_revolution = 20;  ///< nL may be this much more or less
  std::int64_t extra_slots = 400;          ///< a line may be this much longer, in whole microvectors
  Rational pitch_percent = Rational(1);    ///< most the line pitch may change
  Rational diameter_um = Rational(10);     ///< most the diameter may change
  std::size_t most_suggestions = 20;
};

/// What gives way when nL changes: the pitch at the given diameter, or the diameter at the given pitch.
enum class GeometryChange : std::uint8_t { none, pitch, diameter };

/// A key of the job file and what to set it to; no value: take the key out.
struct JobKeyChange {
  std::string key;  ///< "rotary.lines_per_revolution"
  std::optional<std::string> value;

  friend bool operator==(const JobKeyChange&, const JobKeyChange&) = default;
};

/// A job whose drift is exactly zero without the fractional part, and what it costs against the given one, whose line
/// is taken without extra slots.
struct Suggestion {
  std::int64_t lines_per_revolution = 0;
  std::int64_t slots = 0;  ///< np
  GeometryChange geometry = GeometryChange::none;
  Rational line_pitch_um = 0;
  Rational delta_line_pitch_um = 0;
  Rational diameter_mm = 0;
  Rational delta_diameter_um = 0;
  Rational delta_line_time_us = 0;
  Rational delta_line_time_percent = 0;
  AbPair ab;
  std::vector<JobKeyChange> keys;  ///< empty: the job as it is closes exactly
};

/// Jobs near this one whose drift is exactly zero with the plain counter, least change first; the change is
/// |delta nL| / nL + delta np / np, ties to the shorter line, then fewer lines, then the pitch giving way. Each nL is
/// offered with the pitch giving way and with the diameter giving way, where the tolerances allow; a changed diameter
/// or circumference is rounded to 1 nm. None within the tolerances is a valid answer: see suggest_outlook().
///
/// No search over m: each (np, nL) is decided by the criterion of exact_ab_pair() on odd parts and powers of two.
/// Errors: those of make_plan() for the job itself (without extra slots and fraction); out_of_range for a negative
/// tolerance or more than 100,000,000 candidates.
Result<std::vector<Suggestion>> suggest(const Job& job, std::int64_t pixels_per_line, std::int64_t revolutions,
                                        const SuggestTolerances& tolerances);

/// What else would close the seam exactly.
struct SuggestOutlook {
  /// Largest interpolation_bits below the job's for which suggest() finds something within the tolerances, and the
  /// nearest job there (its keys set rotary.interpolation_bits too).
  std::optional<int> interpolation_bits;
  std::optional<Suggestion> nearest;
  /// What fpga.fractional = true would run on with the job as it is; none if its denominator is beyond 64 bits.
  std::optional<AbFraction> fraction;
};

/// Errors: those of suggest().
Result<SuggestOutlook> suggest_outlook(const Job& job, std::int64_t pixels_per_line, std::int64_t revolutions,
                                       const SuggestTolerances& tolerances);

/// The job with the keys of the suggestion set.
Job apply(const Job& job, const Suggestion& suggestion);

}  // namespace gravure
