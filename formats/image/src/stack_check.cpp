#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "gravure/formats/image_stack.hpp"

namespace gravure {
namespace {

constexpr double kSizeTolerance = 1e-3;  // of the size tag against the job

const char* lines_along_name(LinesAlong along) {
  return along == LinesAlong::rows ? "rows" : "columns";
}

/// What one could change on the job's side so that `lines` lines close the circumference.
std::string fitting_lines(const Plan& plan, const Job& job, std::int64_t lines) {
  if (plan.mode == Mode::flat) {
    return fmt::format("\n  [stage] lines = {}", lines);
  }
  const double circumference_um = to_double(plan.rotary.circumference_um);
  const double pitch_um = to_double(job.rotary.line_pitch_um.value_or(plan.rotary.line_pitch_um));
  const auto count = static_cast<double>(lines);
  const double fitting_circumference_mm = count * pitch_um / 1000;
  const double fitting_diameter_mm = fitting_circumference_mm / to_double(pi());
  return fmt::format(
      "\n  [rotary] lines_per_revolution = {} (or line_pitch_um = {:.8g}) at this {}"
      "\n  [rotary] {} = {:.8g} at line_pitch_um = {:.8g}",
      lines, circumference_um / count, job.rotary.circumference_mm ? "circumference" : "diameter",
      job.rotary.circumference_mm ? "circumference_mm" : "diameter_mm",
      job.rotary.circumference_mm ? fitting_circumference_mm : fitting_diameter_mm, pitch_um);
}

Error misfit(const Plan& plan, const Job& job, const StackImage& image, const ScanSize& have) {
  const ScanSize want{image_columns(plan), plan.rotary.lines_per_revolution};
  const ScanSize wanted_image = scan_size(job.image, want.pixels_per_line, want.lines);  // its own inverse
  std::string message = fmt::format(
      "{}: page {}: {} x {} pixels read with lines_along = \"{}\" are {} lines of {} pixels, but the job has {} lines "
      "a {} of {} pixels. What fits:\n  an image of {} x {} pixels",
      image.path, image.page, image.info.width, image.info.height, lines_along_name(job.image.lines_along), have.lines,
      have.pixels_per_line, want.lines, plan.mode == Mode::flat ? "pass" : "revolution", want.pixels_per_line,
      wanted_image.pixels_per_line, wanted_image.lines);
  if (have.lines == want.pixels_per_line && have.pixels_per_line == want.lines) {
    const bool rows = job.image.lines_along == LinesAlong::rows;
    message += fmt::format("\n  [image] lines_along = \"{}\"", rows ? "columns" : "rows");
    return {ErrorCode::bad_file, message};
  }
  if (have.lines != want.lines) {
    message += fitting_lines(plan, job, have.lines);
  }
  if (have.pixels_per_line != want.pixels_per_line) {
    message += fmt::format("\n  [image] pixels_per_line = {}", have.pixels_per_line);
  }
  return {ErrorCode::bad_file, message};
}

/// A warning when the tag of one direction gives another size than the job.
std::optional<std::string> size_warning(const StackImage& image, const char* direction, std::int64_t pixels,
                                        const std::optional<double>& dots_per_mm, double job_mm) {
  if (!dots_per_mm) {
    return std::nullopt;
  }
  const double tag_mm = static_cast<double>(pixels) / *dots_per_mm;
  if (std::abs(tag_mm - job_mm) <= kSizeTolerance * job_mm) {
    return std::nullopt;
  }
  return fmt::format(
      "{}: page {}: its size tag ({:.6g} dots per mm) makes it {:.6g} mm {}, the job makes it {:.6g} mm: the job is "
      "what is cut; correct the tag or the job",
      image.path, image.page, *dots_per_mm, tag_mm, direction, job_mm);
}

/// The first image that contradicts the job in a direction speaks for all of them.
std::vector<std::string> size_warnings(const Plan& plan, const Job& job, const ImageStack& stack) {
  const bool rows = job.image.lines_along == LinesAlong::rows;
  const std::int64_t columns = image_columns(plan);
  const double along_mm = static_cast<double>(columns) * to_double(plan.line.pixel_pitch_um) / 1000;
  const double around_mm = to_double(plan.rotary.circumference_um) / 1000;
  std::optional<std::string> along;
  std::optional<std::string> around;
  for (const StackImage& image : stack.images) {
    const ImageInfo& info = image.info;
    const auto& along_dots = rows ? info.x_dots_per_mm : info.y_dots_per_mm;
    const auto& around_dots = rows ? info.y_dots_per_mm : info.x_dots_per_mm;
    if (!along) {
      along = size_warning(image, "along the line", columns, along_dots, along_mm);
    }
    if (!around) {
      around = size_warning(image, plan.mode == Mode::flat ? "along the stage" : "round the workpiece",
                            plan.rotary.lines_per_revolution, around_dots, around_mm);
    }
  }
  std::vector<std::string> warnings;
  for (const auto& warning : {along, around}) {
    if (warning) {
      warnings.push_back(*warning);
    }
  }
  return warnings;
}

Result<void> check_revolutions(const Plan& plan, const Job& job, const ImageStack& stack,
                               std::vector<std::string>& warnings) {
  if (plan.carriage) {
    return {};  // the planner has counted the layers
  }
  const std::int64_t revolutions = revolutions_per_band(plan);
  if (job.image.order == LayerOrder::sequence && revolutions != stack.layers) {
    return Error{
        ErrorCode::bad_argument,
        job.place_of("image.revolutions") +
            fmt::format("[image] revolutions = {} but there are {} layers: order = \"sequence\" cuts layer r on "
                        "revolution r; set revolutions = {}, or order = \"cycle\" or \"hold\" to repeat layers",
                        revolutions, stack.layers, stack.layers)};
  }
  if (revolutions < stack.layers) {
    warnings.push_back(job.place_of("image.revolutions") +
                       fmt::format("[image] revolutions = {}: the last {} of {} layers are never cut", revolutions,
                                   stack.layers - revolutions, stack.layers));
  }
  return {};
}

}  // namespace

Result<std::vector<std::string>> check_stack(const Plan& plan, const Job& job, const ImageStack& stack) {
  for (const StackImage& image : stack.images) {
    const ScanSize have = scan_size(job.image, image.info.width, image.info.height);
    if (have.lines != plan.rotary.lines_per_revolution || have.pixels_per_line != image_columns(plan)) {
      return misfit(plan, job, image, have);
    }
  }
  std::vector<std::string> warnings = size_warnings(plan, job, stack);
  GRAVURE_CHECK(check_revolutions(plan, job, stack, warnings));
  return warnings;
}

}  // namespace gravure
