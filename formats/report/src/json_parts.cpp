#include "json_parts.hpp"

#include <algorithm>
#include <cmath>

#include "gravure/formats/report_page.hpp"

namespace gravure {

Json json_of(const Rational& value) {
  constexpr std::size_t kReadable = 40;
  const std::string exact = to_string(value);
  return {{"value", to_double(value)}, {"exact", exact.size() <= kReadable ? Json(exact) : Json(nullptr)}};
}

double figure(double value) {
  if (value == 0 || !std::isfinite(value)) {
    return 0;
  }
  const double scale = std::pow(10.0, 9 - std::floor(std::log10(std::abs(value))));
  return std::isfinite(scale) && scale != 0 ? std::round(value * scale) / scale : value;
}

std::string sixteen_bits(const std::vector<double>& values, double most) {
  std::string bytes;
  bytes.reserve(2 * values.size());
  for (const double value : values) {
    const auto level = static_cast<unsigned>(most > 0 ? std::lround(65535 * std::min(value / most, 1.0)) : 0);
    bytes += static_cast<char>(level & 0xFFU);
    bytes += static_cast<char>(level >> 8U);
  }
  return base64(bytes);
}

Json line_json(const report::LineView& view) {
  Json gate = Json::array();
  for (const report::GateRun& run : view.gate) {
    gate.push_back(run.first_slot);
    gate.push_back(run.slots);
  }
  Json steps = Json::array();  // from edge to edge
  std::int64_t before = 0;
  for (const std::int64_t tick : view.edge_ticks) {
    steps.push_back(tick - before);
    before = tick;
  }
  Json mirrors = Json::array();
  for (const report::MirrorSample& sample : view.mirrors) {
    mirrors.push_back({sample.slot, figure(sample.u_mm), figure(sample.v_mm)});
  }
  return {{"revolution", view.revolution}, {"line", view.line},
          {"reverse", view.reverse},       {"first_slot", view.first_slot},
          {"fired", view.fired},           {"gate", gate},
          {"gate_cut", view.gate_cut},     {"ab_at_start", view.ab_state_at_start},
          {"edge_steps", steps},           {"backward", view.backward},
          {"edges_cut", view.edges_cut},   {"mirrors", mirrors},
          {"no_mirrors", view.no_mirrors}};
}

}  // namespace gravure
