#include "gravure/pipeline/compare_path.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>

#include "gravure/core/set_point_walk.hpp"
#include "gravure/pipeline/path_slots.hpp"

namespace gravure {
namespace {

constexpr std::int64_t kRowsAtOnce = 4096;  // rows read at a time
constexpr double kSameLength = 1e-9;        // mm or rad
constexpr double kSameDirection = 1e-11;    // of a unit vector

/// How many differ, and the first of them.
struct Difference {
  std::int64_t count = 0;
  std::string first;

  void add(const std::function<std::string()>& where) {
    if (count++ == 0) {
      first = where();
    }
  }
};

std::string counted(std::int64_t count, const char* what) {
  return std::to_string(count) + " " + what + (count == 1 ? " differs" : "s differ");
}

class PathComparison {
 public:
  PathComparison(LineSource& program, CancelToken* cancel, Progress* progress)
      : program_(program),
        plan_(program.header().plan),
        lines_(plan_.rotary.lines_per_revolution),
        cancel_(cancel),
        progress_(progress),
        along_counts_per_mm_(to_double(plan_.path->along_counts_per_mm)) {
    for (std::size_t axis = 0; axis < plan_.path->axes.size(); ++axis) {
      counts_per_unit_[axis] = to_double(plan_.path->axes[axis].counts_per_unit);
    }
  }

  Result<void> targets(std::span<const PathTarget> wanted) {
    if (static_cast<std::int64_t>(wanted.size()) != plan_.path->targets) {
      said_.push_back("the program stores " + std::to_string(plan_.path->targets) + " wanted points, the job has " +
                      std::to_string(wanted.size()));
      return {};
    }
    Difference differing;
    std::vector<PathTarget> stored;
    for (std::size_t first = 0; first < wanted.size(); first += kRowsAtOnce) {
      stored.resize(std::min<std::size_t>(kRowsAtOnce, wanted.size() - first));
      GRAVURE_CHECK(program_.read_targets(static_cast<std::int64_t>(first), stored));
      for (std::size_t i = 0; i < stored.size(); ++i) {
        if (!is_same(stored[i], wanted[first + i])) {
          differing.add([&] { return std::to_string(first + i); });
        }
      }
    }
    if (differing.count > 0) {
      said_.push_back(counted(differing.count, "wanted point") + " from those of the job, the first is number " +
                      differing.first);
    }
    return {};
  }

  /// Are they the same?
  Result<bool> set_points(const PathMotion& motion) {
    const std::int64_t count = set_points_of(plan_);
    if (motion.instants() != count) {
      said_.push_back("the program stores " + std::to_string(count) + " set-points, the job leads to " +
                      std::to_string(motion.instants()));
      return false;
    }
    Difference differing;
    std::vector<PathSetPoint> stored;
    std::vector<PathInstant> wanted;
    for (std::int64_t first = 0; first < count; first += kRowsAtOnce) {
      const auto size = static_cast<std::size_t>(std::min(kRowsAtOnce, count - first));
      stored.resize(size);
      wanted.resize(size);
      GRAVURE_CHECK(program_.read_set_points(first, stored));
      GRAVURE_CHECK(motion.read(first, wanted));
      for (std::size_t i = 0; i < size; ++i) {
        if (const std::optional<std::string> axis = differing_axis(stored[i], wanted[i])) {
          differing.add([&] { return std::to_string(first + static_cast<std::int64_t>(i)) + " (" + *axis + ")"; });
        }
      }
      GRAVURE_CHECK(go_on(first / 2));
    }
    if (differing.count > 0) {
      said_.push_back(counted(differing.count, "set-point") + " from those the job leads to, the first is number " +
                      differing.first);
    }
    return differing.count == 0;
  }

  Result<void> pulses(const PathPulses& wanted) {
    if (wanted.count != plan_.path->pulses) {
      said_.push_back("the program has " + std::to_string(plan_.path->pulses) + " pulses, the job leads to " +
                      std::to_string(wanted.count));
      return {};
    }
    PathSlots slots(plan_, wanted);
    SetPointWalk walk(program_);
    PathWindow window{};
    std::vector<std::byte> expected(static_cast<std::size_t>(program_.header().line_bytes()));
    Difference differing;
    for (std::int64_t line = 0; line < lines_; ++line) {
      for (std::int64_t i = 0; i < 4; ++i) {
        GRAVURE_TRY(window[static_cast<std::size_t>(i)], walk.at(line - 1 + i));
      }
      std::fill(expected.begin(), expected.end(), std::byte{0});
      GRAVURE_CHECK(slots.place(window, expected));
      GRAVURE_CHECK(compare_line(line, expected, differing));
      if (line % kRowsAtOnce == 0) {
        GRAVURE_CHECK(go_on(lines_ / 2 + line / 2));
      }
    }
    if (differing.count > 0) {
      said_.push_back(counted(differing.count, "slot") + " from what the job fires, the first is " + differing.first);
    }
    return slots.finish();
  }

  std::vector<std::string> take() { return std::move(said_); }

 private:
  static bool is_same(const PathTarget& a, const PathTarget& b) {
    bool same = std::abs(a.along_mm - b.along_mm) <= kSameLength;
    for (std::size_t i = 0; i < 3; ++i) {
      same = same && std::abs(a.position_mm[i] - b.position_mm[i]) <= kSameLength &&
             std::abs(a.normal[i] - b.normal[i]) <= kSameDirection;
    }
    return same;
  }

  std::optional<std::string> differing_axis(const PathSetPoint& stored, const PathInstant& wanted) const {
    for (std::size_t axis = 0; axis < plan_.path->axes.size(); ++axis) {
      const double position = static_cast<double>(stored.counts[axis]) / counts_per_unit_[axis];
      if (!(std::abs(position - wanted.axes[axis]) <= kSameLength)) {
        return std::string(kPathAxes[axis]);
      }
    }
    const double along_mm = static_cast<double>(stored.along_counts) / along_counts_per_mm_;
    // Both are rounded: two counts at most, should a length lie between two.
    const double same_mm = std::max(kSameLength, 2 / along_counts_per_mm_);
    return std::abs(along_mm - wanted.along_mm) <= same_mm ? std::nullopt
                                                           : std::optional<std::string>("the path covered");
  }

  Result<void> compare_line(std::int64_t line, std::span<const std::byte> expected, Difference& differing) {
    const std::int64_t chunk = line / program_.lines_per_chunk();
    if (chunk != chunk_) {
      const std::int64_t lines = std::min(program_.lines_per_chunk(), lines_ - chunk * program_.lines_per_chunk());
      bits_.resize(static_cast<std::size_t>(lines) * expected.size());
      GRAVURE_TRY(const StoredChunk stored, program_.fetch({0, chunk}));
      GRAVURE_CHECK(program_.decode(stored, bits_));
      chunk_ = chunk;
    }
    const auto offset = static_cast<std::size_t>(line % program_.lines_per_chunk()) * expected.size();
    const auto found = std::span(bits_).subspan(offset, expected.size());
    if (std::equal(expected.begin(), expected.end(), found.begin())) {
      return {};
    }
    for (std::int64_t slot = 0; slot < plan_.line.slots; ++slot) {
      const auto byte = static_cast<std::size_t>(slot / 8);
      if (((expected[byte] ^ found[byte]) & static_cast<std::byte>(0x80U >> (slot % 8))) != std::byte{0}) {
        differing.add([&] { return "slot " + std::to_string(slot) + " of line " + std::to_string(line); });
      }
    }
    return {};
  }

  Result<void> go_on(std::int64_t done) {
    if (cancel_ != nullptr && cancel_->cancelled()) {
      return Error{ErrorCode::cancelled, "stopped before the program was compared"};
    }
    if (progress_ != nullptr) {
      progress_->update(done, lines_);
    }
    return {};
  }

  LineSource& program_;
  const Plan& plan_;
  std::int64_t lines_;
  CancelToken* cancel_;
  Progress* progress_;
  std::array<double, kPathAxes.size()> counts_per_unit_{};
  double along_counts_per_mm_;
  std::int64_t chunk_ = -1;
  std::vector<std::byte> bits_;
  std::vector<std::string> said_;
};

}  // namespace

Result<std::vector<std::string>> compare_path(LineSource& program, const PathMotion& motion, const PathPulses& pulses,
                                              std::span<const PathTarget> targets, CancelToken* cancel,
                                              Progress* progress) {
  if (!program.header().plan.path) {
    return Error{ErrorCode::bad_argument, "the program follows no path"};
  }
  PathComparison comparison(program, cancel, progress);
  GRAVURE_CHECK(comparison.targets(targets));
  GRAVURE_TRY(const bool same, comparison.set_points(motion));
  if (same) {
    GRAVURE_CHECK(comparison.pulses(pulses));
  }
  return comparison.take();
}

}  // namespace gravure
