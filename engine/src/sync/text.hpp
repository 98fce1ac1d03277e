#pragma once

#include <string>

#include "gravure/core/exact.hpp"

namespace gravure::sync_plan {

/// A number for messages: its exact decimals where they are short, else nine significant digits.
std::string number_text(const Rational& value);

}  // namespace gravure::sync_plan
