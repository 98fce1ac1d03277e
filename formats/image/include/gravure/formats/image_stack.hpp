#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gravure/core/error.hpp"
#include "gravure/core/image_source.hpp"
#include "gravure/core/job.hpp"
#include "gravure/core/plan.hpp"

namespace gravure {

/// One page of one file.
struct StackImage {
  std::string path;
  std::int64_t page = 0;
  ImageInfo info;
};

/// The images of a job: layers in order, or the one depth map that is sliced into them.
struct ImageStack {
  std::vector<StackImage> images;  ///< never empty; exactly one for a depth map
  bool depth_map = false;
  std::int64_t layers = 0;  ///< bilevel layers it gives: images.size(), or the levels of the depth map
  std::vector<std::string> warnings;

  std::int64_t width() const { return images.front().info.width; }
  std::int64_t height() const { return images.front().info.height; }
};

/// Pixels of one scan line and lines of one revolution in such an image.
struct ScanSize {
  std::int64_t pixels_per_line = 0;
  std::int64_t lines = 0;
};
ScanSize scan_size(const ImageSettings& settings, std::int64_t width, std::int64_t height);

/// Pixels of a line of the picture that [repeat] lays of images with `columns` pixels a line. out_of_range, naming what
/// fits, where they are more than a line may have (1,000,000,000).
Result<std::int64_t> picture_columns(const Job& job, std::int64_t columns);

/// Finds the job's images and reads their headers only: files in natural order, the pages of a multi-page file in
/// order. Fails with bad_file when a pattern matches nothing, a header is bad, two layers differ in size or sample
/// type; bad_argument when grey layers lack a threshold (the message suggests one) or have one out of range, and when
/// a depth map is bilevel, has several pages or no `levels`. Warns of a threshold that does nothing, and of G3 and G4
/// data larger than the bits they stand for.
Result<ImageStack> scan_stack(const Job& job, const ImageOpener& opener);

/// Do the images, as often as [repeat] lays them, fit the plan? Pixels per line and lines per revolution must be equal,
/// else bad_file with the numbers that would fit (image size; lines per revolution, pitch, diameter; lines_along; tiles
/// around). In order "sequence" there must be
/// one layer a revolution, else bad_argument. Returns warnings: size tags that contradict the job by more than 0.1 %
/// (both sizes in mm), layers that no revolution uses.
Result<std::vector<std::string>> check_stack(const Plan& plan, const Job& job, const ImageStack& stack);

}  // namespace gravure
