#include "gravure/formats/image_stack.hpp"

#include <filesystem>

#include "gravure/formats/image_files.hpp"

namespace gravure {
namespace {

std::string place(const StackImage& image) {
  return image.path + ": page " + std::to_string(image.page) + ": ";
}

const char* samples_name(SampleType samples) {
  switch (samples) {
    case SampleType::bit:
      return "1-bit";
    case SampleType::u8:
      return "8-bit grey";
    case SampleType::u16:
      return "16-bit grey";
    case SampleType::f32:
      return "floating-point";
  }
  return "unknown";
}

Result<void> add_pages(const std::string& path, const ImageOpener& opener, std::vector<StackImage>& images) {
  GRAVURE_TRY(const std::int64_t pages, opener.count_pages(path));
  if (pages < 1) {
    return Error{ErrorCode::bad_file, path + ": holds no image"};
  }
  for (std::int64_t page = 0; page < pages; ++page) {
    GRAVURE_TRY(const auto source, opener.open(path, page));
    images.push_back({path, page, source->info()});
  }
  return {};
}

Result<void> check_alike(const std::vector<StackImage>& images) {
  const StackImage& first = images.front();
  for (const StackImage& image : images) {
    if (image.info.width != first.info.width || image.info.height != first.info.height) {
      return Error{ErrorCode::bad_file, place(image) + "is " + std::to_string(image.info.width) + " x " +
                                            std::to_string(image.info.height) + " pixels, the first layer (" +
                                            first.path + ") " + std::to_string(first.info.width) + " x " +
                                            std::to_string(first.info.height) + ": all layers must be of one size"};
    }
    if (image.info.samples != first.info.samples) {
      return Error{ErrorCode::bad_file, place(image) + "has " + samples_name(image.info.samples) +
                                            " samples, the first layer (" + first.path + ") " +
                                            samples_name(first.info.samples) + ": all layers must be of one kind"};
    }
  }
  return {};
}

/// Grey layers become bilevel by the threshold; without one nobody said what is white.
Result<void> check_threshold(const Job& job, ImageStack& stack) {
  const ImageSettings& settings = job.image;
  const StackImage& first = stack.images.front();
  const SampleType samples = first.info.samples;
  if (samples == SampleType::bit) {
    if (settings.threshold) {
      stack.warnings.push_back(job.place_of("image.threshold") +
                               "[image] threshold = " + std::to_string(*settings.threshold) +
                               ": the layers are bilevel already, so it does nothing; leave it out");
    }
    return {};
  }
  if (samples == SampleType::f32) {
    return Error{ErrorCode::bad_argument, job.place_of("image.files") + place(first) +
                                              "floating-point samples cannot be layers: save them as 1, 8 or "
                                              "16 bits, or give the image as [image] depth_map"};
  }
  const std::int64_t largest = samples == SampleType::u8 ? 255 : 65535;
  const std::string range = " (1 to " + std::to_string(largest) + "; a sample >= threshold is white; the middle is " +
                            std::to_string((largest + 1) / 2) + ")";
  if (!settings.threshold) {
    return Error{ErrorCode::bad_argument, job.place_of("image") + place(first) + samples_name(samples) +
                                              " layers need [image] threshold" + range};
  }
  if (*settings.threshold < 1 || *settings.threshold > largest) {
    return Error{ErrorCode::out_of_range, job.place_of("image.threshold") +
                                              "[image] threshold = " + std::to_string(*settings.threshold) +
                                              ": out of range for " + samples_name(samples) + " layers" + range};
  }
  return {};
}

/// The samples that mean no and every pulse must be samples of this map, and two different ones.
Result<void> check_depth_range(const Job& job, const StackImage& map) {
  const bool floats = map.info.samples == SampleType::f32;
  const Rational largest = floats ? 1 : map.info.samples == SampleType::u8 ? 255 : 65535;
  const auto check = [&](const char* key, const std::optional<Rational>& value) -> Result<void> {
    if (value && !floats && (denominator_of(*value) != 1 || *value < 0 || *value > largest)) {
      return Error{ErrorCode::out_of_range, job.place_of(std::string("image.") + key) + "[image] " + key + " = " +
                                                to_decimal_string(*value) + ": must be an integer from 0 to " +
                                                to_string(largest) + ", a sample of this " +
                                                samples_name(map.info.samples) + " map (" + map.path + ")"};
    }
    return {};
  };
  GRAVURE_CHECK(check("depth_min", job.image.depth_min));
  GRAVURE_CHECK(check("depth_max", job.image.depth_max));
  const Rational low = job.image.depth_min.value_or(0);
  if (low == job.image.depth_max.value_or(largest)) {
    return Error{ErrorCode::bad_argument, job.place_of("image.depth_min") + "[image] depth_min = depth_max = " +
                                              to_decimal_string(low) + ": a depth map needs two different ends"};
  }
  return {};
}

Result<void> check_depth_map(const Job& job, ImageStack& stack) {
  const ImageSettings& settings = job.image;
  const std::string at = job.place_of("image.depth_map");
  const StackImage& map = stack.images.front();
  if (stack.images.size() != 1) {
    return Error{ErrorCode::bad_argument, at + map.path + ": [image] depth_map has " +
                                              std::to_string(stack.images.size()) +
                                              " pages: a depth map is one page; split the file"};
  }
  if (map.info.samples == SampleType::bit) {
    return Error{ErrorCode::bad_argument,
                 at + place(map) +
                     "[image] depth_map is bilevel: a depth map has 8, 16 or floating-point bits a sample; give "
                     "a bilevel image as [image] files"};
  }
  if (!settings.levels || *settings.levels < 1) {
    return Error{ErrorCode::bad_argument,
                 job.place_of("image.levels") +
                     "[image] levels: missing or below 1: a depth map needs the number of layers it is sliced into"};
  }
  GRAVURE_CHECK(check_depth_range(job, map));
  stack.layers = *settings.levels;
  return {};
}

/// G3 and G4 spell out every run of a line: dithered pictures grow by them, and take libtiff many times longer to
/// decode than any other codec.
void warn_of_fax(ImageStack& stack) {
  const StackImage* first = nullptr;
  std::int64_t count = 0;
  for (const StackImage& image : stack.images) {
    if (image.info.fax_larger_than_raw) {
      first = first == nullptr ? &image : first;
      ++count;
    }
  }
  if (first == nullptr) {
    return;
  }
  const std::string others = count > 1 ? " (and " + std::to_string(count - 1) + " more)" : "";
  stack.warnings.push_back(place(*first) + "its G3 or G4 data are larger than the bits they stand for" + others +
                           ", as those of dithered pictures are: reading them is slow; rewrite such files with "
                           "`tiffcp -c zip` or `tiffcp -c zstd`");
}

}  // namespace

ScanSize scan_size(const ImageSettings& settings, std::int64_t width, std::int64_t height) {
  return settings.lines_along == LinesAlong::rows ? ScanSize{width, height} : ScanSize{height, width};
}

Result<ImageStack> scan_stack(const Job& job, const ImageOpener& opener) {
  ImageStack stack;
  stack.depth_map = job.image.depth_map.has_value();
  const std::vector<std::string> patterns =
      stack.depth_map ? std::vector<std::string>{*job.image.depth_map} : job.image.files;
  if (patterns.empty()) {
    return Error{ErrorCode::bad_argument,
                 job.place_of("image") + "[image] files: no image given; name files or a depth_map"};
  }
  const std::string folder = std::filesystem::path(job.path).parent_path().string();
  const Result<std::vector<std::string>> files = expand_patterns(folder, patterns);
  if (!files) {
    return Error{files.error().code,
                 job.place_of(stack.depth_map ? "image.depth_map" : "image.files") + files.error().message};
  }
  for (const std::string& path : files.value()) {
    GRAVURE_CHECK(add_pages(path, opener, stack.images));
  }
  stack.layers = static_cast<std::int64_t>(stack.images.size());
  if (stack.depth_map) {
    GRAVURE_CHECK(check_depth_map(job, stack));
    return stack;
  }
  GRAVURE_CHECK(check_alike(stack.images));
  GRAVURE_CHECK(check_threshold(job, stack));
  warn_of_fax(stack);
  return stack;
}

}  // namespace gravure
