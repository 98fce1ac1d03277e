#include "gravure/formats/svg.hpp"

#include <fmt/format.h>
#include <libxml/parser.h>
#include <libxml/tree.h>

// No colours are read here, and svgpp's parsers of them build a table of names whenever a program starts.
#define SVGPP_USE_EXTERNAL_COLOR_PARSER
#define SVGPP_USE_EXTERNAL_PAINT_PARSER
#include <boost/mpl/set.hpp>
#include <svgpp/policy/xml/libxml2.hpp>
#include <svgpp/svgpp.hpp>

#include <cmath>
#include <exception>
#include <memory>
#include <utility>

#include "flatten.hpp"

namespace gravure {
namespace {

using Eigen::Vector2d;

constexpr std::size_t kMostPoints = 50'000'000;
constexpr double kMmPerUnit = 25.4 / 96;

/// What the parser tells of a drawing. Elements nest: each takes its place from the one around it.
class Drawing {
 public:
  explicit Drawing(double tolerance_mm) : tolerance_mm_(tolerance_mm) {
    SvgPlace page;
    page << kMmPerUnit, 0, 0, 0, -kMmPerUnit, 0;
    places_.push_back(page);
  }
  std::vector<SvgStroke> strokes() && {
    end_stroke();
    return std::move(strokes_);
  }
  bool is_too_long() const noexcept { return points_ > kMostPoints; }

  // What svgpp calls, by these names.
  void on_enter_element(svgpp::tag::element::any /*element*/) { places_.push_back(places_.back()); }
  void on_exit_element() { places_.pop_back(); }
  template <class Number>
  void transform_matrix(const boost::array<Number, 6>& m) {
    Eigen::Matrix3d turn;
    turn << m[0], m[2], m[4], m[1], m[3], m[5], 0, 0, 1;
    places_.back() = places_.back() * turn;
  }
  void set_viewport(double /*x*/, double /*y*/, double /*width*/, double /*height*/) {}
  void set_viewbox_size(double /*width*/, double /*height*/) {}
  void disable_rendering() {}
  void path_move_to(double x, double y, svgpp::tag::coordinate::absolute /*kind*/) {
    end_stroke();
    at_ = first_ = {x, y};
    flattener().line(at_);
  }
  void path_line_to(double x, double y, svgpp::tag::coordinate::absolute /*kind*/) { go({x, y}); }
  void path_cubic_bezier_to(double x1, double y1, double x2, double y2, double x, double y,
                            svgpp::tag::coordinate::absolute /*kind*/) {
    flattener().cubic(at_, {x1, y1}, {x2, y2}, {x, y});
    arrive({x, y});
  }
  /// The same curve as a cubic one.
  void path_quadratic_bezier_to(double x1, double y1, double x, double y, svgpp::tag::coordinate::absolute /*kind*/) {
    const Vector2d middle(x1, y1);
    const Vector2d to(x, y);
    flattener().cubic(at_, (at_ + 2 * middle) / 3, (to + 2 * middle) / 3, to);
    arrive(to);
  }
  void path_elliptical_arc_to(double rx, double ry, double turn_deg, bool large, bool sweep, double x, double y,
                              svgpp::tag::coordinate::absolute /*kind*/) {
    flattener().arc(at_, {{rx, ry}, turn_deg, large, sweep}, {x, y});
    arrive({x, y});
  }
  void path_close_subpath() { go(first_); }
  void path_exit() { end_stroke(); }

 private:
  Flattener flattener() {
    if (points_ + stroke_.size() > kMostPoints) {
      throw svgpp::exception_base();  // caught in parse_svg(): no more is kept
    }
    return {places_.back(), tolerance_mm_, stroke_};
  }
  void go(const Vector2d& to) {
    flattener().line(to);
    arrive(to);
  }
  void arrive(const Vector2d& to) { at_ = to; }
  void end_stroke() {
    points_ += stroke_.size();
    if (stroke_.size() > 1) {
      strokes_.push_back(std::move(stroke_));
    }
    stroke_.clear();
  }

  double tolerance_mm_;
  std::vector<SvgPlace> places_;
  std::vector<SvgStroke> strokes_;
  SvgStroke stroke_;
  std::size_t points_ = 0;
  Vector2d at_ = Vector2d::Zero();
  Vector2d first_ = Vector2d::Zero();
};

using Elements = boost::mpl::set<svgpp::tag::element::svg, svgpp::tag::element::g, svgpp::tag::element::path,
                                 svgpp::tag::element::line, svgpp::tag::element::polyline, svgpp::tag::element::polygon,
                                 svgpp::tag::element::rect, svgpp::tag::element::circle, svgpp::tag::element::ellipse>;

using Attributes = boost::mpl::fold<
    boost::mpl::joint_view<svgpp::traits::shapes_attributes_by_element, svgpp::traits::viewport_attributes>,
    boost::mpl::set<svgpp::tag::attribute::transform>, boost::mpl::insert<boost::mpl::_1, boost::mpl::_2>>::type;

using Traversal =
    svgpp::document_traversal<svgpp::processed_elements<Elements>, svgpp::processed_attributes<Attributes>,
                              svgpp::viewport_policy<svgpp::policy::viewport::as_transform>>;

struct FreeDocument {
  void operator()(xmlDoc* document) const noexcept { xmlFreeDoc(document); }
};

Error no_svg(const std::string& name, const std::string& why) {
  return {ErrorCode::bad_file, name + ": " + why};
}

Result<void> check(const std::vector<SvgStroke>& strokes, const std::string& name) {
  constexpr double kMost_mm = 1e6;
  for (const SvgStroke& stroke : strokes) {
    for (const auto& [x, y] : stroke) {
      if (!(std::abs(x) <= kMost_mm && std::abs(y) <= kMost_mm)) {
        return no_svg(name, fmt::format("a point at x = {} mm, y = {} mm; at most {} mm are taken", x, y, kMost_mm));
      }
    }
  }
  return strokes.empty() ? no_svg(name, "no stroke: paths and shapes inside svg and g are read") : Result<void>();
}

}  // namespace

Result<std::vector<SvgStroke>> parse_svg(std::string_view text, const std::string& name, double tolerance_mm) {
  if (!(tolerance_mm > 0)) {
    return Error{ErrorCode::out_of_range,
                 fmt::format("{}: tolerance of {} mm for its curves: must be above 0", name, tolerance_mm)};
  }
  constexpr std::size_t kMostBytes = std::size_t{1} << 30;
  if (text.size() > kMostBytes) {
    return no_svg(name, fmt::format("{} bytes, at most {} are taken", text.size(), kMostBytes));
  }
  const std::unique_ptr<xmlDoc, FreeDocument> document(
      xmlReadMemory(text.data(), static_cast<int>(text.size()), nullptr, nullptr,
                    XML_PARSE_NONET | XML_PARSE_NOERROR | XML_PARSE_NOWARNING | XML_PARSE_NODICT));
  if (!document) {
    const xmlError* const problem = xmlGetLastError();
    return no_svg(name, fmt::format("line {}: is no XML", problem != nullptr ? problem->line : 0));
  }
  Drawing drawing(tolerance_mm);
  try {
    xmlNode* root = xmlDocGetRootElement(document.get());
    if (root == nullptr || !Traversal::load_document(root, drawing)) {
      return no_svg(name, "its outermost element is not svg");
    }
  } catch (const std::exception&) {
    if (drawing.is_too_long()) {
      return Error{ErrorCode::out_of_range,
                   fmt::format("{}: more than {} points; allow a coarser tolerance", name, kMostPoints)};
    }
    return no_svg(name, "is no SVG, or has attributes that make no sense");
  }
  std::vector<SvgStroke> strokes = std::move(drawing).strokes();
  GRAVURE_CHECK(check(strokes, name));
  return strokes;
}

}  // namespace gravure
