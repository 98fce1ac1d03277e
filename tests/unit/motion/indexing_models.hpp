#pragma once

#include <vector>

#include "gravure/motion/plan_profile.hpp"
#include "gravure/motion/settling.hpp"

namespace gravure::motion::test {

/// Two-mode models fitted to the positioning times [C1] publishes (a plausibility fit, not a validation).
inline std::vector<Mode> fit_a() {
  const FrequencyAndDamping modes[] = {{40.570, 0.2081}, {92.397, 0.0308}};
  return chain_modes(modes).value();
}
inline std::vector<Mode> fit_b() {
  const FrequencyAndDamping modes[] = {{36.206, 0.2249}, {86.748, 0.0331}};
  return chain_modes(modes).value();
}

inline constexpr Band kPublishedBand{BandOf::acceleration, 840};

inline SFactorRequest indexing(double v, double a_up, double a_down, double s_factor) {
  return {{20, v, a_up, a_down, 0, 0}, s_factor, 250};
}

inline double positioning_ms(const std::vector<Mode>& modes, const SFactorRequest& request) {
  return settle(modes, input_of(plan_profile(request).value()), kPublishedBand).value().positioning_time_s * 1e3;
}

}  // namespace gravure::motion::test
