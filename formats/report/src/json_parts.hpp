#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "gravure/core/exact.hpp"
#include "gravure/report/line_view.hpp"

/// How figures stand in the data of both pages.
namespace gravure {

using Json = nlohmann::ordered_json;

/// A figure, and what it is exactly where a person can read that: a circumference from pi has hundreds of digits.
Json json_of(const Rational& value);

/// Ten digits: what a page shows, and the same from every mathematical library.
double figure(double value);

/// What both documents begin with: report, generator, program and verdict{within_limits, violations[], notes[], lines}.
template <class Data>
Json report_head(const Data& data) {
  return {{"report", 1},
          {"generator", data.generator},
          {"program", data.program},
          {"verdict",
           {{"within_limits", data.verified.violations.empty()},
            {"violations", data.verified.violations},
            {"notes", data.verified.notes},
            {"lines", data.verified.lines}}}};
}

/// What happens in the time of one line, or of one servo period.
Json line_json(const report::LineView& view);

/// Values of 0 to `most` as 16 bits each, little-endian, in base64.
std::string sixteen_bits(const std::vector<double>& values, double most);

}  // namespace gravure
