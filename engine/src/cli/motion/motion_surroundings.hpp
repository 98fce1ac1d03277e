#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "gravure/motion/blade_points.hpp"
#include "gravure/motion/smooth_tool_path.hpp"

namespace gravure::cli {

/// What the tool (or the cone of a beam) must stay clear of, as it stands on the command line.
struct SurroundingOptions {
  std::string surface;  ///< a file of points; empty for none
  std::string blade;    ///< a file of rails; empty for none
  motion::BladeSampling sampling;
  motion::ToolShape shape;
  std::optional<double> margin_mm;
  double c_step_deg = 1.5;
  double c_most_deg = 30;

  bool any() const noexcept { return !surface.empty() || !blade.empty(); }
};

void add_surrounding_options(CLI::App& verb, SurroundingOptions& options);
/// Throws CLI::RequiresError where the tool is given but nothing to stay clear of.
void check_surrounding_options(const CLI::App& verb, const SurroundingOptions& options);

/// The points of both files; none where none was given. Blades stand about the axis of C through `centre_mm`.
Result<std::vector<motion::Vector3>> surrounding_points(const SurroundingOptions& options,
                                                        const motion::Vector3& centre_mm);

/// With the given margin, or the one that covers the gaps between the points of a blade.
motion::Surroundings surroundings_of(const SurroundingOptions& options, const std::vector<motion::Vector3>& points);

}  // namespace gravure::cli
