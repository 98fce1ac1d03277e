#pragma once

#include <cstdint>

#include "gravure/core/job.hpp"
#include "gravure/core/plan.hpp"

namespace gravure::sync_plan {

/// A positive integer as 2^twos * odd.
struct OddPart {
  std::uint64_t odd = 1;
  int twos = 0;
};
OddPart odd_part(std::uint64_t value);

/// Decides for one line length and many lines per revolution after another whether an exact pair exists, in some tens
/// of nanoseconds.
///
/// X = 2^n N / (C np nL) with N = 2^q nenc gear_encoder and C = j k gear_workpiece. In lowest terms its numerator must
/// be at most 2^(n-2) and its denominator at most max_prescaler. Both are decided on odd parts, whose common factors
/// are taken out one side after the other, and on the number of twos.
class ExactCriterion {
 public:
  ExactCriterion(const Job& job, const Plan& plan);

  /// The following calls of fits() are about lines of np slots.
  void set_slots(std::int64_t slots);
  bool fits(std::int64_t lines_per_revolution) const;

 private:
  int counter_bits_;
  OddPart wanted_;                 ///< N; the odd part without what it shares with C
  int fixed_twos_ = 0;             ///< twos of C
  std::uint64_t most_den_ = 0;     ///< max_prescaler / (odd part of C without what it shares with N)
  std::uint64_t least_steps_ = 0;  ///< np nL below it need more than max_ab_hz

  std::uint64_t slots_ = 0;
  std::uint64_t left_ = 1;       ///< odd part of N without what it shares with C and np
  std::uint64_t slots_odd_ = 1;  ///< odd part of np without what it shares with N
  int slots_twos_ = 0;
};

}  // namespace gravure::sync_plan
