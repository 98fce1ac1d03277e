#include "motion/motion_surroundings.hpp"

#include <cmath>

#include "gravure/core/file_output.hpp"
#include "motion/motion_options.hpp"
#include "verb.hpp"

namespace gravure::cli {
namespace {

Error in_file(const std::string& path, const Error& error) {
  return {error.code, path + ": " + error.message};
}

Result<std::vector<motion::Vector3>> points_of_blade(const SurroundingOptions& options,
                                                     const motion::Vector3& centre_mm) {
  GRAVURE_TRY(const std::string text, read_file(options.blade, kMostMotionBytes));
  const auto rails = motion::parse_blade_csv(text);
  if (!rails) {
    return in_file(options.blade, rails.error());
  }
  motion::BladeSampling sampling = options.sampling;
  sampling.centre_mm = centre_mm;
  auto points = motion::blade_points(rails.value(), sampling);
  if (!points) {
    return in_file(options.blade, points.error());
  }
  return points;
}

}  // namespace

void add_surrounding_options(CLI::App& verb, SurroundingOptions& options) {
  verb.add_option("--surface", options.surface,
                  "CSV of points x,y,z in mm on the workpiece that the tool must stay clear of");
  verb.add_option("--blade", options.blade,
                  "CSV of a ruled blade's two curves, x,y,z of the shroud's and x,y,z of the hub's in mm a line: the "
                  "tool must stay clear of its sides");
  verb.add_option("--blade-thickness-mm", options.sampling.thickness_mm, "Between the two sides of a blade")
      ->check(number_from(0, 1e4))
      ->needs("--blade");
  verb.add_option("--blade-count", options.sampling.blades, "Blades about the axis of C")
      ->check(integer_from(1, 1000))
      ->capture_default_str()
      ->needs("--blade");
  verb.add_option("--blade-spacing-mm", options.sampling.spacing_mm, "Of the points a blade is tested at")
      ->check(number_from(1e-3, 1e4))
      ->capture_default_str()
      ->needs("--blade");
  verb.add_option("--tool-radius-mm", options.shape.radius_mm, "Radius of the tool (or beam) at its tip")
      ->check(number_from(0, 1e4));
  verb.add_option("--tool-widening", options.shape.widening, "Radius gained per mm of height: a cone")
      ->check(number_from(-1e3, 1e3));
  verb.add_option("--tool-length-mm", options.shape.length_mm, "Length of the tool that is tested")
      ->check(number_from(1e-6, 1e6));
  verb.add_option("--clear-from-mm", options.shape.clear_from_mm, "Below this height contact is wanted")
      ->check(number_from(-1e6, 1e6));
  verb.add_option("--margin-mm", options.margin_mm,
                  "Added to the radius, to cover what lies between the points (0.71 of --blade-spacing-mm, else 0)")
      ->check(number_from(0, 1e4));
  verb.add_option("--c-step-deg", options.c_step_deg, "C is turned by this until the tool is free")
      ->check(number_from(1e-3, 180))
      ->capture_default_str();
  verb.add_option("--c-most-deg", options.c_most_deg, "and by no more than this")
      ->check(number_from(0, 360))
      ->capture_default_str();
  for (const char* what : {"--surface", "--blade"}) {
    verb.get_option(what)->needs("--tool-length-mm");
  }
}

void check_surrounding_options(const CLI::App& verb, const SurroundingOptions& options) {
  for (const char* name : {"--tool-radius-mm", "--tool-widening", "--tool-length-mm", "--clear-from-mm", "--margin-mm",
                           "--c-step-deg", "--c-most-deg"}) {
    if (!options.any() && verb.count(name) > 0) {
      throw CLI::RequiresError(name, "--surface or --blade");
    }
  }
}

Result<std::vector<motion::Vector3>> surrounding_points(const SurroundingOptions& options,
                                                        const motion::Vector3& centre_mm) {
  std::vector<motion::Vector3> points;
  if (!options.surface.empty()) {
    GRAVURE_TRY(const std::string text, read_file(options.surface, kMostMotionBytes));
    auto read = motion::parse_points_csv(text);
    if (!read) {
      return in_file(options.surface, read.error());
    }
    points = std::move(read).value();
  }
  if (!options.blade.empty()) {
    GRAVURE_TRY(const auto blade, points_of_blade(options, centre_mm));
    points.insert(points.end(), blade.begin(), blade.end());
  }
  return points;
}

motion::Surroundings surroundings_of(const SurroundingOptions& options, const std::vector<motion::Vector3>& points) {
  const double covering = options.blade.empty() ? 0 : options.sampling.spacing_mm / std::sqrt(2.0);
  return {points, options.shape, options.margin_mm.value_or(covering), options.c_step_deg * kDegree,
          options.c_most_deg * kDegree};
}

}  // namespace gravure::cli
