#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "gravure/core/error.hpp"
#include "gravure/core/plan.hpp"

namespace gravure {

/// The plan as JSON, the same bytes for the same plan: indented by 2, keys in a fixed order (docs/formats/plan.md).
///
/// Integers up to 2^53 are numbers, larger ones strings of their digits, so that a reader with doubles loses nothing.
/// A ratio that is a whole number up to 2^53 is written as one, any other as its nearest double; exactly it stands as
/// {"num", "den"} under "ratios" of its section. null means never. Bytes of texts that are not UTF-8 are replaced.
std::string plan_to_json(const Plan& plan);

/// Larger texts are refused before they are parsed; a plan takes some kilobytes.
inline constexpr std::size_t kLargestPlanJson = std::size_t{1} << 20;

/// The plan that plan_to_json() wrote, every field of it. Keys may stand in any order and unknown ones are skipped;
/// whole numbers may be numbers or strings of digits. bad_file, naming the key, when one is missing or of the wrong
/// type, when a number and its exact ratio disagree, or when the figures contradict each other, so that what is
/// returned is safe to compute with: nothing is 0 that divides, ticks and drifts follow from the rest.
Result<Plan> plan_from_json(std::string_view text);

}  // namespace gravure
