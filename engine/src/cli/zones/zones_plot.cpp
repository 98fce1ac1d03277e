#include "zones/zones_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>

#include "verb.hpp"

namespace gravure::cli {
namespace {

using zones::Vector3;

constexpr double kSide = 420;
constexpr double kPlotMargin = 40;
constexpr double kTop = 50;
constexpr double kRow = 16;
/// Different also to most people who see colours differently.
constexpr std::array<const char*, 8> kZoneColours{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                  "#e69f00", "#56b4e9", "#000000", "#999933"};

const char* colour_of(std::size_t zone) {
  return kZoneColours[zone % kZoneColours.size()];
}

/// From the part to pixels, with one axis to the right and z up.
struct View {
  int right;
  Vector3 least;
  double scale;
  double left;
  std::string at(const Vector3& point) const {
    return fmt::format("{:.1f},{:.1f}", left + (point[right] - least[right]) * scale,
                       kTop + kSide - (point.z() - least.z()) * scale);
  }
};

std::string draw(const zones::ZonePlan& plan, const View& view, const char* name) {
  std::string svg = fmt::format(
      "<rect x=\"{0}\" y=\"{1}\" width=\"{2}\" height=\"{2}\" fill=\"none\" stroke=\"#999\"/>\n"
      "<text x=\"{0}\" y=\"{3}\">{4}</text>\n",
      view.left, kTop, kSide, kTop - 8, name);
  for (std::size_t z = 0; z < plan.zones.size(); ++z) {
    const zones::PlannedZone& zone = plan.zones[z];
    for (const std::size_t i : zone.zone.pieces) {
      svg += "<polyline points=\"";
      for (const Vector3& point : plan.pieces[i].points_mm) {
        svg += view.at(point) + " ";
      }
      svg += fmt::format("\" fill=\"none\" stroke=\"{}\"/>\n", colour_of(z));
    }
    constexpr double kArrow = 40;  // pixels
    const std::string from = view.at(zone.frame.origin_mm);
    const std::string to = view.at(zone.frame.origin_mm + kArrow / view.scale * zone.frame.z);
    svg += fmt::format("<polyline points=\"{} {}\" stroke=\"{}\" stroke-width=\"2\" stroke-dasharray=\"3 2\"/>\n", from,
                       to, colour_of(z));
    const std::size_t comma = to.find(',');
    svg += fmt::format("<text x=\"{}\" y=\"{}\" fill=\"{}\">{}</text>\n", to.substr(0, comma), to.substr(comma + 1),
                       colour_of(z), z);
  }
  return svg;
}

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    safe += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
  }
  return safe;
}

}  // namespace

std::string zones_to_svg(const zones::ZonePlan& plan, const std::string& title) {
  Vector3 least = plan.pieces[0].points_mm[0];
  Vector3 most = least;
  for (const zones::Piece& piece : plan.pieces) {
    for (const Vector3& point : piece.points_mm) {
      least = least.cwiseMin(point);
      most = most.cwiseMax(point);
    }
  }
  const double range = std::max((most - least).maxCoeff(), 1e-6);
  const double scale = kSide / (1.2 * range);
  const Vector3 corner = (least + most) / 2 - Vector3::Constant(0.6 * range);
  const double width = 2 * kSide + 3 * kPlotMargin;
  const double height = kTop + kSide + 30 + kRow * static_cast<double>(plan.zones.size() + 1);
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" "
      "font-family=\"sans-serif\" font-size=\"11\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
      "<text x=\"{2}\" y=\"22\" font-size=\"14\">{3}: {4} zones, at least {5}</text>\n",
      width, height, kPlotMargin, escaped(title), plan.zones.size(), plan.lower_bound);
  svg += draw(plan, {0, corner, scale, kPlotMargin}, "x to the right, z up");
  svg += draw(plan, {1, corner, scale, 2 * kPlotMargin + kSide}, "y to the right, z up");
  double line = kTop + kSide + 24;
  for (std::size_t z = 0; z < plan.zones.size(); ++z) {
    const zones::PlannedZone& zone = plan.zones[z];
    svg += fmt::format(
        "<text x=\"{}\" y=\"{}\" fill=\"{}\">zone {}: {} contours, incidence {:.2f} deg, {}</text>\n", kPlotMargin,
        line, colour_of(z), z, zone.zone.pieces.size(), zone.zone.max_incidence_rad * kDegreesPerRad,
        zone.layer_thickness_mm > 0 ? fmt::format("{} layers of {:.3f} mm", zone.layers.size(), zone.layer_thickness_mm)
                                    : "flat");
    line += kRow;
  }
  return svg + "</svg>\n";
}

}  // namespace gravure::cli
