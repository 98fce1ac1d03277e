#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "gravure/formats/motion_json.hpp"

namespace gravure::formats {
namespace {

constexpr double kWidth = 800;
constexpr double kPanel = 140;
constexpr double kLeft = 90;
constexpr double kTop = 40;

/// Text inside an SVG element.
std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    safe += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
  }
  return safe;
}

struct Range {
  double low = 0;
  double high = 1;
  double share(double value) const noexcept { return (value - low) / (high - low); }
};

Range range_of(const std::vector<double>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return *high > *low ? Range{*low, *high} : Range{*low - 0.5, *low + 0.5};
}

/// The curve in pixels, without points that a straight line passes within a tenth of a pixel.
std::string polyline(const Curve& curve, const Range& x, const Range& y, double top, double height) {
  constexpr double kOff = 0.1;
  const auto at = [&](std::size_t i) {
    return std::pair(kLeft + x.share(curve.x[i]) * (kWidth - kLeft - 10), top + height - y.share(curve.y[i]) * height);
  };
  auto kept = at(0);
  auto before = kept;
  std::string points = fmt::format("{:.1f},{:.1f} ", kept.first, kept.second);
  // Slopes of lines from the kept point that pass near enough to all points since.
  double least = -1e9;
  double most = 1e9;
  for (std::size_t i = 1; i < curve.x.size(); ++i) {
    const auto here = at(i);
    const double slope = (here.second - kept.second) / (here.first - kept.first);
    if (i > 1 && !(slope >= least && slope <= most)) {
      kept = before;
      points += fmt::format("{:.1f},{:.1f} ", kept.first, kept.second);
      least = -1e9;
      most = 1e9;
    }
    const double length = here.first - kept.first;
    if (length > 0) {
      least = std::max(least, (here.second - kOff - kept.second) / length);
      most = std::min(most, (here.second + kOff - kept.second) / length);
    }
    before = here;
  }
  return points + fmt::format("{:.1f},{:.1f}", before.first, before.second);
}

std::string dashed_line(double x1, double y1, double x2, double y2) {
  return fmt::format(
      "<line x1=\"{:.2f}\" y1=\"{:.2f}\" x2=\"{:.2f}\" y2=\"{:.2f}\" stroke=\"#c33\" stroke-dasharray=\"4 3\"/>\n", x1,
      y1, x2, y2);
}

/// The dashed lines of a curve that lie inside its panel.
std::string dashed_lines(const Curve& curve, const Range& x, const Range& y, double top, double height) {
  const double right = kWidth - 10;
  std::string svg;
  for (const double level : {curve.band, -curve.band}) {
    if (curve.band > 0 && y.share(level) > 0 && y.share(level) < 1) {
      const double at = top + height - y.share(level) * height;
      svg += dashed_line(kLeft, at, right, at);
    }
  }
  for (const double mark : curve.marks) {
    if (x.share(mark) > 0 && x.share(mark) < 1) {
      const double at = kLeft + x.share(mark) * (right - kLeft);
      svg += dashed_line(at, top, at, top + height);
    }
  }
  return svg;
}

std::string panel(const Curve& curve, const Range& x, double top) {
  const Range y = range_of(curve.y);
  const double height = kPanel - 30;
  const std::string points = polyline(curve, x, y, top, height);
  std::string svg = fmt::format(
      "<rect x=\"{0}\" y=\"{1}\" width=\"{2}\" height=\"{3}\" fill=\"none\" stroke=\"#999\"/>\n"
      "<polyline points=\"{4}\" fill=\"none\" stroke=\"#1f5fa8\" stroke-width=\"1.2\"/>\n",
      kLeft, top, kWidth - kLeft - 10, height, points);
  svg += dashed_lines(curve, x, y, top, height);
  svg += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"end\">{:.4g}</text>\n", kLeft - 4, top + 10, y.high);
  svg += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"end\">{:.4g}</text>\n", kLeft - 4, top + height, y.low);
  svg += fmt::format("<text x=\"{}\" y=\"{}\">{}</text>\n", kLeft + 6, top + 14, escaped(curve.name));
  return svg;
}

constexpr const char* kSampleColumns = "time_s,position_mm,velocity_mm_s,acceleration_mm_s2,jerk_mm_s3";

std::string sample_row(const motion::Sample& sample) {
  const motion::State& s = sample.state;
  return fmt::format("{:.12g},{:.12g},{:.12g},{:.12g},{:.12g}\n", sample.time_s, s.position_mm, s.velocity_mm_s,
                     s.acceleration_mm_s2, s.jerk_mm_s3);
}

}  // namespace

std::string samples_to_csv(const std::vector<motion::Sample>& samples) {
  std::string csv = std::string(kSampleColumns) + "\n";
  for (const motion::Sample& sample : samples) {
    csv += sample_row(sample);
  }
  return csv;
}

std::string samples_to_csv(const std::vector<std::vector<motion::Sample>>& axes) {
  std::string csv = fmt::format("axis,{}\n", kSampleColumns);
  for (std::size_t axis = 0; axis < axes.size(); ++axis) {
    for (const motion::Sample& sample : axes[axis]) {
      csv += fmt::format("{},{}", axis, sample_row(sample));
    }
  }
  return csv;
}

std::string curves_to_svg(const std::string& title, const std::string& x_name, const std::vector<Curve>& curves) {
  std::vector<double> all_x;
  std::size_t shown = 0;
  for (const Curve& curve : curves) {
    if (curve.x.size() >= 2) {
      all_x.insert(all_x.end(), curve.x.begin(), curve.x.end());
      ++shown;
    }
  }
  const double height = kTop + kPanel * static_cast<double>(shown) + 10;
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" "
      "font-family=\"sans-serif\" font-size=\"11\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
      "<text x=\"{2}\" y=\"22\" font-size=\"14\">{3}</text>\n",
      kWidth, height, kLeft, escaped(title));
  if (shown > 0) {
    const Range x = range_of(all_x);
    double top = kTop;
    for (const Curve& curve : curves) {
      if (curve.x.size() >= 2) {
        svg += panel(curve, x, top);
        top += kPanel;
      }
    }
    svg += fmt::format("<text x=\"{}\" y=\"{}\">{:.4g}</text>\n", kLeft, top - 14, x.low);
    svg += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"end\">{:.4g} {}</text>\n", kWidth - 10, top - 14, x.high,
                       escaped(x_name));
  }
  return svg + "</svg>\n";
}

}  // namespace gravure::formats
