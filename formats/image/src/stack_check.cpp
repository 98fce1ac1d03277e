#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "gravure/formats/image_stack.hpp"

namespace gravure {
namespace {

constexpr double kSizeTolerance = 1e-3;              // of the size tag against the job
constexpr std::int64_t kMostTiles = 1'000'000;       // of [repeat]
constexpr std::int64_t kMostPixels = 1'000'000'000;  // of a line

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

bool repeats(const Job& job) {
  return job.repeat.around > 1 || job.repeat.along > 1;
}

/// An image of `tile` lines and pixels as often as [repeat] lays it.
ScanSize laid_out(const Job& job, const ScanSize& tile) {
  return {tile.pixels_per_line * job.repeat.along, tile.lines * job.repeat.around};
}

bool fits(const ScanSize& laid, const ScanSize& want) {
  return laid.lines == want.lines && laid.pixels_per_line == want.pixels_per_line;
}

/// The numbers of tiles round the workpiece next to `around` that divide its lines, the one below first.
std::vector<std::int64_t> dividing_tiles(std::int64_t lines, std::int64_t around) {
  std::vector<std::int64_t> found;
  std::int64_t below = std::min(around, lines);
  while (lines % below != 0) {
    --below;
  }
  found.push_back(below);
  std::int64_t above = around;
  while (above < lines && lines % above != 0) {
    ++above;
  }
  if (above > below && above <= kMostTiles && lines % above == 0) {
    found.push_back(above);
  }
  return found;
}

/// Sizes of images that the job's lines and pixels are a whole number of.
std::string fitting_images(const Job& job, const ScanSize& want) {
  std::string text;
  const std::int64_t pixels = want.pixels_per_line / job.repeat.along;
  for (const std::int64_t around : dividing_tiles(want.lines, job.repeat.around)) {
    const ScanSize image = scan_size(job.image, pixels, want.lines / around);  // its own inverse
    text += fmt::format("\n  an image of {} x {} pixels", image.pixels_per_line, image.lines);
    text += around == job.repeat.around ? "" : fmt::format(" with [repeat] around = {}", around);
  }
  return text;
}

Error misfit(const Plan& plan, const Job& job, const StackImage& image, const ScanSize& have) {
  const ScanSize want{image_columns(plan), plan.rotary.lines_per_revolution};
  const ScanSize laid = laid_out(job, have);
  std::string message = repeats(job) ? job.place_of("repeat.around") : "";
  message += fmt::format("{}: page {}: {} x {} pixels read with lines_along = \"{}\" are {} lines of {} pixels",
                         image.path, image.page, image.info.width, image.info.height,
                         lines_along_name(job.image.lines_along), have.lines, have.pixels_per_line);
  if (repeats(job)) {
    message += fmt::format(", and [repeat] around = {}, along = {} makes them {} lines of {}", job.repeat.around,
                           job.repeat.along, laid.lines, laid.pixels_per_line);
  }
  message += fmt::format(", but the job has {} lines a {} of {} pixels. What fits:", want.lines,
                         plan.mode == Mode::flat ? "pass" : "revolution", want.pixels_per_line) +
             fitting_images(job, want);
  if (fits(laid_out(job, {have.lines, have.pixels_per_line}), want)) {
    const bool rows = job.image.lines_along == LinesAlong::rows;
    message += fmt::format("\n  [image] lines_along = \"{}\"", rows ? "columns" : "rows");
    return {ErrorCode::bad_file, message};
  }
  if (laid.lines != want.lines) {
    const std::int64_t around = want.lines / have.lines;
    message += around >= 1 && around <= kMostTiles && want.lines % have.lines == 0
                   ? fmt::format("\n  [repeat] around = {}", around)
                   : "";
    message += fitting_lines(plan, job, laid.lines);
  }
  if (laid.pixels_per_line != want.pixels_per_line) {
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
  const std::int64_t columns = image_columns(plan) / job.repeat.along;
  const double along_mm = static_cast<double>(columns) * to_double(plan.line.pixel_pitch_um) / 1000;
  const double around_mm = to_double(plan.rotary.circumference_um) / 1000 / static_cast<double>(job.repeat.around);
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
                            plan.rotary.lines_per_revolution / job.repeat.around, around_dots, around_mm);
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

Result<std::int64_t> picture_columns(const Job& job, std::int64_t columns) {
  const std::int64_t along = job.repeat.along;
  if (along > 1 && columns > kMostPixels / along) {
    return Error{
        ErrorCode::out_of_range,
        job.place_of("repeat.along") +
            fmt::format("[repeat] along = {}: so many images of {} pixels a line are more than the {} a line may have; "
                        "at most {} fit",
                        along, columns, kMostPixels, std::max<std::int64_t>(1, kMostPixels / columns))};
  }
  return columns * along;
}

Result<std::vector<std::string>> check_stack(const Plan& plan, const Job& job, const ImageStack& stack) {
  for (const StackImage& image : stack.images) {
    const ScanSize have = scan_size(job.image, image.info.width, image.info.height);
    if (!fits(laid_out(job, have), {image_columns(plan), plan.rotary.lines_per_revolution})) {
      return misfit(plan, job, image, have);
    }
  }
  std::vector<std::string> warnings = size_warnings(plan, job, stack);
  GRAVURE_CHECK(check_revolutions(plan, job, stack, warnings));
  return warnings;
}

}  // namespace gravure
