#pragma once

#include "axis_check.hpp"
#include "gravure/twin/verify.hpp"
#include "tally.hpp"

namespace gravure {

/// The report on everything seen, with its violations.
VerifyReport judge(const Plan& plan, const AxisChecks& axes, const Tally& tally, bool images_given);

}  // namespace gravure
