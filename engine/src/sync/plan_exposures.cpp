#include "plan_exposures.hpp"

#include <string>

#include "check_job.hpp"
#include "gravure/core/exposure_map.hpp"
#include "plan_axis.hpp"

namespace gravure::sync_plan {
namespace {

/// Whole pixels that fit the scan field.
Integer field_pixels(const ScannerSettings& scanner) {
  return floor_of(*scanner.field_mm * Rational(1000) / scanner.pixel_pitch_um);
}

/// The field holds a pixel at least?
bool check_field(const ScannerSettings& scanner, Violations& violations) {
  if (field_pixels(scanner) >= 1) {
    return true;
  }
  violations.refuse(ErrorCode::out_of_range, "scanner.field_mm", number_text(*scanner.field_mm),
                    "holds no pixel of scanner.pixel_pitch_um = " + number_text(scanner.pixel_pitch_um) +
                        "; at least " + number_text(scanner.pixel_pitch_um / Rational(1000)) + " mm would");
  return false;
}

void check_window_width(const Job& job, const Integer& window, Violations& violations) {
  const Rational feed = job.carriage.feed_pixels;
  const std::string several = "a window of carriage.layers * feed_pixels = " + to_string(window) + " columns";
  if (window > kMostCount) {
    violations.refuse(ErrorCode::out_of_range, "carriage.feed_pixels", number_text(feed),
                      several + " is wider than the " + std::to_string(kMostCount) +
                          " pixels a line may have; at most " + number_text(ratio(kMostCount, job.carriage.layers)) +
                          " fit");
  } else if (job.scanner.field_mm && check_field(job.scanner, violations) && window > field_pixels(job.scanner)) {
    violations.conflict(ErrorCode::out_of_range, "carriage.feed_pixels", number_text(feed),
                        several + " does not fit scanner.field_mm = " + number_text(*job.scanner.field_mm) +
                            "; at most " + number_text(ratio(field_pixels(job.scanner), job.carriage.layers)) +
                            " fit with these layers");
  }
}

std::int64_t plan_carriage(const Job& job, std::int64_t columns, std::int64_t layers, Plan& plan,
                           Violations& violations) {
  if (!violations.sound({"carriage.feed_pixels", "carriage.layers", "carriage.encoder_pitch_um",
                         "carriage.interpolation_bits", "scanner.pixel_pitch_um", "scanner.field_mm"})) {
    return 0;
  }
  const CarriageSettings& settings = job.carriage;
  if (layers != settings.layers) {
    violations.conflict(ErrorCode::bad_argument, "carriage.layers", std::to_string(settings.layers),
                        "there are " + std::to_string(layers) + " layers in [image], and one is needed for each: set " +
                            "carriage.layers = " + std::to_string(layers) + ", or give as many images as layers");
  }
  const Integer window = ceil_of(settings.feed_pixels * Rational(settings.layers));
  check_window_width(job, window, violations);
  const Integer revolutions = ceil_of(Rational(columns) / settings.feed_pixels) + settings.layers;
  if (revolutions > kMostRevolutions) {
    violations.refuse(ErrorCode::out_of_range, "carriage.feed_pixels", number_text(settings.feed_pixels),
                      "the job takes " + to_string(revolutions) + " revolutions; at most " +
                          std::to_string(kMostRevolutions) + " fit, a feed of more than " +
                          number_text(ratio(columns, kMostRevolutions - settings.layers)) + " columns");
  }
  if (!ExposureMap::fits(settings.feed_pixels, plan.rotary.lines_per_revolution)) {
    violations.refuse(ErrorCode::out_of_range, "carriage.feed_pixels", number_text(settings.feed_pixels),
                      "over " + std::to_string(plan.rotary.lines_per_revolution) +
                          " lines is a ratio beyond 62-bit integers; give it with fewer digits");
  }
  if (!violations.sound({"carriage.feed_pixels"})) {
    return 0;
  }
  CarriagePlan carriage;
  carriage.feed_pixels = settings.feed_pixels;
  carriage.feed_um = settings.feed_pixels * job.scanner.pixel_pitch_um;
  carriage.layers = settings.layers;
  carriage.columns = columns;
  carriage.window_columns = static_cast<std::int64_t>(window);
  carriage.revolutions = static_cast<std::int64_t>(revolutions);
  carriage.travel_mm = carriage.feed_um * Rational(carriage.revolutions) / Rational(1000);
  carriage.encoder_pitch_um = settings.encoder_pitch_um;
  carriage.interpolation_bits = settings.interpolation_bits;
  carriage.edges_per_revolution =
      linear_edges(carriage.feed_um, settings.encoder_pitch_um, settings.interpolation_bits);
  plan.job.revolutions = carriage.revolutions;
  plan.carriage = std::move(carriage);
  return plan.carriage->window_columns;
}

/// Bands of equal width, so that the last one is not a sliver; it alone may hold fewer columns.
std::int64_t plan_bands(const Job& job, std::int64_t columns, std::int64_t exposures, Plan& plan,
                        Violations& violations) {
  plan.job.revolutions = exposures;
  if (!job.scanner.field_mm || !violations.sound({"scanner.pixel_pitch_um", "scanner.field_mm"}) ||
      !check_field(job.scanner, violations) || field_pixels(job.scanner) >= columns) {
    return columns;
  }
  const Integer count = ceil_of(ratio(columns, field_pixels(job.scanner)));
  if (count * exposures > kMostRevolutions) {
    violations.refuse(ErrorCode::out_of_range, "scanner.field_mm", number_text(*job.scanner.field_mm),
                      "an image of " + std::to_string(columns) + " columns has " + to_string(count) + " bands of " +
                          std::to_string(exposures) + " revolutions each; at most " + std::to_string(kMostRevolutions) +
                          " revolutions fit");
    return columns;
  }
  BandsPlan bands;
  bands.count = static_cast<std::int64_t>(count);
  bands.columns = columns;
  bands.revolutions_per_band = exposures;
  plan.job.revolutions = exposures * bands.count;
  const auto pixels = static_cast<std::int64_t>(ceil_of(ratio(columns, count)));
  bands.step_mm = job.scanner.pixel_pitch_um * Rational(pixels) / Rational(1000);
  plan.bands = bands;
  return pixels;
}

}  // namespace

std::int64_t plan_exposures(const Job& job, std::int64_t columns, std::int64_t exposures, Plan& plan,
                            Violations& violations) {
  plan.job.revolutions = exposures;
  if (!violations.sound({"image.pixels_per_line", "image.revolutions"})) {
    return columns;
  }
  return job.mode == Mode::helical ? plan_carriage(job, columns, exposures, plan, violations)
                                   : plan_bands(job, columns, exposures, plan, violations);
}

}  // namespace gravure::sync_plan
