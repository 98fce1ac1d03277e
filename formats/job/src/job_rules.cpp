#include "src/job_rules.hpp"

#include <algorithm>

namespace gravure::job_file {
namespace {

std::string full_name(const Section& section, const Entry& entry) {
  return "[" + section.name + "] " + one_line(entry.key) + " = " + entry.value.shown;
}

std::string elsewhere(const Entry& entry) {
  return one_line(entry.key) + " = " + entry.value.shown + " (line " + std::to_string(entry.at.line) + ")";
}

/// The later of two keys is the one to blame.
void contradict(const Section& section, const Entry& a, const Entry& b, const std::string& remedy,
                Violations& violations) {
  const Entry& later = a.at < b.at ? b : a;
  const Entry& earlier = a.at < b.at ? a : b;
  violations.add(later.at, full_name(section, later) + ": contradicts " + elsewhere(earlier) + "; " + remedy);
}

void exactly_one(const Section& section, std::string_view first, std::string_view second, Violations& violations) {
  const Entry* a = section.find(first);
  const Entry* b = section.find(second);
  const std::string either = std::string(first) + " or " + std::string(second);
  if (a == nullptr && b == nullptr) {
    violations.add(section.at, "[" + section.name + "] " + either + " is missing: give one of them");
  } else if (a != nullptr && b != nullptr) {
    contradict(section, *a, *b, "give either " + either, violations);
  }
}

void check_image_kind(const Section& image, Violations& violations) {
  const Entry* files = image.find("files");
  const Entry* depth_map = image.find("depth_map");
  if (files != nullptr && depth_map != nullptr) {
    contradict(image, *files, *depth_map, "give either files or depth_map", violations);
  }
  if (files == nullptr && depth_map == nullptr && image.find("pixels_per_line") == nullptr) {
    violations.add(image.at,
                   "[image] files or depth_map is missing: give one of them (pixels_per_line alone is enough to plan)");
  }
  if (depth_map != nullptr && image.find("levels") == nullptr) {
    violations.add(depth_map->at, full_name(image, *depth_map) + ": needs levels, the number of layers to slice into");
  }
}

/// Which end is deep may be either; that they differ is all a job must say. The default of depth_max depends on the
/// map.
void check_depth_ends(const Section& image, const Job& job, Violations& violations) {
  const Entry* low = image.find("depth_min");
  const Entry* high = image.find("depth_max");
  if (high != nullptr && low == nullptr && job.image.depth_max == Rational(0)) {
    violations.add(high->at, full_name(image, *high) + ": must differ from depth_min, which is 0 where not given");
  }
  if (job.image.depth_min && job.image.depth_min == job.image.depth_max) {
    contradict(image, *low, *high, "depth_min and depth_max must differ", violations);
  }
}

void check_depth_keys(const Section& image, const Job& job, Violations& violations) {
  const Entry* depth_map = image.find("depth_map");
  const Entry* threshold = image.find("threshold");
  if (depth_map != nullptr && threshold != nullptr) {
    contradict(image, *depth_map, *threshold, "a depth map is sliced into levels, never thresholded", violations);
  }
  for (const char* key : {"levels", "depth_min", "depth_max"}) {
    const Entry* entry = image.find(key);
    if (entry != nullptr && depth_map == nullptr) {
      violations.add(entry->at, full_name(image, *entry) + ": has a meaning only with depth_map");
    }
  }
  check_depth_ends(image, job, violations);
}

/// In a helical job the carriage decides which layer is exposed when, and how many turns that takes.
void check_helical(const Document& document, const Section& image, const Job& job, Violations& violations) {
  for (const char* key : {"revolutions", "order"}) {
    if (const Entry* entry = image.find(key)) {
      violations.add(entry->at, full_name(image, *entry) +
                                    ": has no meaning with mode = \"helical\", where [carriage] feed_pixels and layers "
                                    "decide what each turn exposes; take it out");
    }
  }
  const Section* carriage = document.find("carriage");
  const Entry* layers = carriage != nullptr && carriage->is_table ? carriage->find("layers") : nullptr;
  const Entry* levels = image.find("levels");
  if (layers != nullptr && levels != nullptr && job.image.levels && *job.image.levels != job.carriage.layers) {
    violations.add(levels->at, full_name(image, *levels) + ": contradicts [carriage] " + elsewhere(*layers) +
                                   "; every level is a layer of the pass, so give both the same number");
  }
}

void check_layer_count(const Section& image, const Job& job, Violations& violations) {
  const bool in_sequence = job.image.order == LayerOrder::sequence;
  if (in_sequence && job.image.levels && job.image.revolutions && *job.image.levels != *job.image.revolutions) {
    contradict(
        image, *image.find("levels"), *image.find("revolutions"),
        "order = \"sequence\" needs one layer per revolution; say order = \"cycle\" or \"hold\", or make them equal",
        violations);
  }
}

void check_servo(const Document& document, const Job& job, Violations& violations) {
  const Section* servo = document.find("twin.servo");
  if (servo != nullptr && servo->is_table && job.twin.servo.enabled && servo->find("bandwidth_hz") == nullptr) {
    violations.add(servo->at,
                   "[twin.servo] bandwidth_hz is missing: give the natural frequency of the axis in Hz, or "
                   "take out enabled = true");
  }
}

}  // namespace

void check_rules(const Document& document, const Job& job, std::optional<Mode> mode, Violations& violations) {
  const Section* rotary = document.find("rotary");
  if (rotary != nullptr && rotary->is_table && mode != Mode::flat) {
    exactly_one(*rotary, "diameter_mm", "circumference_mm", violations);
    exactly_one(*rotary, "line_pitch_um", "lines_per_revolution", violations);
  }
  check_servo(document, job, violations);
  const Section* image = document.find("image");
  if (image != nullptr && image->is_table) {
    check_image_kind(*image, violations);
    check_depth_keys(*image, job, violations);
    if (mode == Mode::helical) {
      check_helical(document, *image, job, violations);
    } else {
      check_layer_count(*image, job, violations);
    }
  }
}

std::string_view choices_of(std::string_view section) {
  if (section == "rotary") {
    return ", diameter_mm or circumference_mm, line_pitch_um or lines_per_revolution";
  }
  return section == "image" ? ", files or depth_map" : "";
}

}  // namespace gravure::job_file
