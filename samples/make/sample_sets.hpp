#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "gravure/core/error.hpp"

namespace gravure::samples {

/// What can be made: "roller", "stent", "helical_roller", "panel", "saddle", "small", "formats".
struct SampleSet {
  std::string_view name;
  std::string_view about;
  Result<void> (*make)(const std::string& folder);
};
const std::vector<SampleSet>& sample_sets();

}  // namespace gravure::samples
