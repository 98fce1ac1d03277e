#pragma once

#include <cstdint>

#include "gravure/core/exact.hpp"
#include "gravure/core/plan.hpp"

namespace gravure {

/// Where the window of a helical line starts.
struct HelicalWindow {
  std::int64_t first_column = 0;  ///< of its first pixel; negative in the run-in
  Rational fraction = 0;          ///< of a column, 0 <= fraction < 1: the scanner adds it, so that the grid stays put
};

/// The window of line `line` of revolution `revolution`, both from 0, of a plan with a carriage: column and fraction of
/// h * (revolution - L + line / nL), exact.
HelicalWindow helical_window(const Plan& plan, std::int64_t revolution, std::int64_t line);

/// Pixels first_pixel .. of the marking window that expose columns first_column .. of an image.
struct Stretch {
  std::int64_t layer = 0;  ///< helical mode: of the image stack. Else 0: the revolution has one layer
  std::int64_t first_pixel = 0;
  std::int64_t first_column = 0;
  std::int64_t columns = 0;  ///< 0: none of them lies in the image
};

/// Which pixels of the images each line of a plan exposes, in every mode. What no stretch covers stays dark.
class ExposureMap {
 public:
  /// The plan is one make_plan() made or plan_from_json() let through.
  explicit ExposureMap(const Plan& plan);

  /// Are the positions of `lines` lines a revolution within what the map computes with? h = num/den of at most 62 bits,
  /// divided by the lines.
  static bool fits(const Rational& feed_pixels, std::int64_t lines);

  /// Every line exposes one whole line of its image, in the image's order: rotary mode without bands.
  bool whole_images() const noexcept { return whole_images_; }
  std::int64_t stretches() const noexcept { return layers_; }  ///< of each line
  std::int64_t columns() const noexcept { return columns_; }   ///< of the images
  std::int64_t lines() const noexcept { return lines_; }       ///< of a revolution and of the images
  /// Which line of the image: the same, but backwards in every other pass of a flat job.
  std::int64_t image_line(std::int64_t revolution, std::int64_t line) const noexcept;
  bool runs_backwards(std::int64_t revolution) const noexcept;
  /// Stretch 0 <= index < stretches() of a line, cut to the columns of the image.
  Stretch stretch(std::int64_t revolution, std::int64_t line, std::int64_t index) const noexcept;
  /// helical: floor(h * steps / nL); steps may be negative.
  std::int64_t column_after(std::int64_t steps) const noexcept;

 private:
  std::int64_t lines_;
  std::int64_t columns_;
  std::int64_t pixels_;
  std::int64_t layers_ = 1;
  std::int64_t revolutions_per_band_;
  bool helical_ = false;
  bool to_and_fro_;
  bool whole_images_;
  std::int64_t num_ = 0;  ///< h / nL in lowest terms
  std::int64_t den_ = 1;
};

}  // namespace gravure
