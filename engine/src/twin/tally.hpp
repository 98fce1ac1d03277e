#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include "gravure/core/plan.hpp"

namespace gravure {

inline std::string place(const Plan& plan, std::int64_t ordinal) {
  return "revolution " + std::to_string(ordinal / plan.rotary.lines_per_revolution) + ", line " +
         std::to_string(ordinal % plan.rotary.lines_per_revolution);
}

inline std::string edges_text(std::int64_t edges, std::int64_t expected) {
  return std::to_string(edges) + " A-B edges since the run began, the program's registers give " +
         std::to_string(expected);
}

/// The first of its kind, by place in the job, so that the report does not depend on the number of workers.
struct Finding {
  std::int64_t count = 0;
  std::int64_t ordinal = -1;
  std::string detail;

  void add(std::int64_t at, std::string what, std::int64_t how_many = 1) {
    if (ordinal < 0 || at < ordinal) {
      ordinal = at;
      detail = std::move(what);
    }
    count += how_many;
  }
  void merge(const Finding& other) {
    if (other.count > 0) {
      add(other.ordinal, other.detail, other.count);
    }
  }
};

/// A layer whose image could not be read, at least in part.
struct UnreadLayer {
  std::int64_t lines = 0;   ///< of all revolutions, not compared
  std::int64_t chunk = -1;  ///< the first one
  std::string why;          ///< as the reader said it there

  void add(std::int64_t at, std::int64_t how_many, const std::string& what) {
    if (chunk < 0 || at < chunk) {
      chunk = at;
      why = what;
    }
    lines += how_many;
  }
};

/// What was seen of one axis.
struct AxisTally {
  double worst_edges = 0;  ///< with sign
  std::int64_t worst_ordinal = -1;
  std::optional<std::int64_t> end_edges;  ///< where the device says it stands at the end of the job
  Finding wrong;                          ///< not where its registers put it

  void see(double edges, std::int64_t ordinal) {
    if (worst_ordinal < 0 || std::fabs(edges) > std::fabs(worst_edges) ||
        (std::fabs(edges) == std::fabs(worst_edges) && ordinal < worst_ordinal)) {
      worst_edges = edges;
      worst_ordinal = ordinal;
    }
  }
  void merge(const AxisTally& other) {
    end_edges = other.end_edges ? other.end_edges : end_edges;
    if (other.worst_ordinal >= 0) {
      see(other.worst_edges, other.worst_ordinal);
    }
    wrong.merge(other.wrong);
  }
};

/// What one worker has seen; merged into one.
struct Tally {
  std::int64_t lines = 0;
  std::int64_t fired = 0;
  std::int64_t wrong_pixels = 0;
  std::int64_t first_wrong_ordinal = -1;
  std::int64_t first_wrong_column = -1;
  std::int64_t end_tick = 0;
  AxisTally axis;
  AxisTally carriage;
  Finding refused;
  Finding misplaced;
  std::map<std::int64_t, UnreadLayer> unread;  ///< by layer

  void see_wrong(std::int64_t ordinal, std::int64_t column) {
    if (first_wrong_ordinal < 0 || std::tie(ordinal, column) < std::tie(first_wrong_ordinal, first_wrong_column)) {
      first_wrong_ordinal = ordinal;
      first_wrong_column = column;
    }
  }
  void merge(const Tally& other) {
    lines += other.lines;
    fired += other.fired;
    wrong_pixels += other.wrong_pixels;
    end_tick = std::max(end_tick, other.end_tick);
    if (other.first_wrong_ordinal >= 0) {
      see_wrong(other.first_wrong_ordinal, other.first_wrong_column);
    }
    axis.merge(other.axis);
    carriage.merge(other.carriage);
    refused.merge(other.refused);
    misplaced.merge(other.misplaced);
    for (const auto& [layer, found] : other.unread) {
      unread[layer].add(found.chunk, found.lines, found.why);
    }
  }
};

}  // namespace gravure
