#include "gravure/pipeline/compile_path.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace gravure {
namespace {

constexpr std::int64_t kInstants = 4096;  // instants read at a time

Error misfit(const std::string& message) {
  return {ErrorCode::bad_argument, message};
}

Result<void> check_inputs(const Plan& plan, const PathMotion& motion, const PathPulses& pulses,
                          std::span<const PathTarget> targets) {
  if (!plan.path) {
    return misfit("the plan has no path");
  }
  if (set_points_of(plan) != motion.instants()) {
    return misfit("the motion has " + std::to_string(motion.instants()) + " instants, the plan " +
                  std::to_string(set_points_of(plan)));
  }
  const auto bits = static_cast<std::int64_t>(pulses.bits.size()) * 8;
  if (pulses.count != plan.path->pulses || bits < pulses.count) {
    return misfit("there are " + std::to_string(pulses.count) + " pulses and bits for " + std::to_string(bits) +
                  ", the plan has " + std::to_string(plan.path->pulses));
  }
  const double pitch_mm = to_double(plan.line.pixel_pitch_um) / 1000;
  if (std::abs(pulses.pitch_mm - pitch_mm) > 1e-9 * pitch_mm) {
    return misfit("pulses every " + std::to_string(pulses.pitch_mm) + " mm, the plan says " + std::to_string(pitch_mm));
  }
  if (static_cast<std::int64_t>(targets.size()) != plan.path->targets) {
    return misfit("there are " + std::to_string(targets.size()) + " wanted points, the plan has " +
                  std::to_string(plan.path->targets));
  }
  for (std::size_t i = 1; i < targets.size(); ++i) {
    if (!(targets[i].along_mm >= targets[i - 1].along_mm)) {
      return misfit("wanted point " + std::to_string(i) + " lies before the one before it on the path");
    }
  }
  return {};
}

/// Instants of a motion as set-points, in order.
class SetPointReader {
 public:
  SetPointReader(const Plan& plan, const PathMotion& motion)
      : motion_(motion), along_counts_per_mm_(to_double(plan.path->along_counts_per_mm)) {
    for (std::size_t axis = 0; axis < plan.path->axes.size(); ++axis) {
      counts_per_unit_[axis] = to_double(plan.path->axes[axis].counts_per_unit);
    }
  }

  /// The next up to kInstants set-points; none at the end.
  Result<std::span<const PathSetPoint>> next() {
    const std::int64_t count = std::min(kInstants, motion_.instants() - done_);
    instants_.resize(static_cast<std::size_t>(count));
    points_.resize(static_cast<std::size_t>(count));
    if (count > 0) {
      GRAVURE_CHECK(motion_.read(done_, instants_));
    }
    for (std::size_t i = 0; i < instants_.size(); ++i) {
      GRAVURE_TRY(points_[i], set_point(instants_[i], done_ + static_cast<std::int64_t>(i)));
    }
    done_ += count;
    return std::span<const PathSetPoint>(points_);
  }

 private:
  Result<PathSetPoint> set_point(const PathInstant& instant, std::int64_t number) {
    PathSetPoint point;
    for (std::size_t axis = 0; axis < counts_per_unit_.size(); ++axis) {
      GRAVURE_TRY(point.counts[axis],
                  counts(instant.axes[axis] * counts_per_unit_[axis], std::string(kPathAxes[axis]), number));
    }
    GRAVURE_TRY(point.along_counts, counts(instant.along_mm * along_counts_per_mm_, "the path covered", number));
    if (point.along_counts < along_) {
      return misfit("instant " + std::to_string(number) + " of the motion: the path covered shrinks to " +
                    std::to_string(instant.along_mm) + " mm");
    }
    along_ = point.along_counts;
    return point;
  }

  static Result<std::int64_t> counts(double value, const std::string& what, std::int64_t number) {
    constexpr double kMost = 4.6e18;  // below 2^62
    if (!(std::abs(value) <= kMost)) {
      return misfit("instant " + std::to_string(number) + " of the motion: " + what + " is " + std::to_string(value) +
                    " counts: must be a number of at most 2^62");
    }
    return std::llround(value);
  }

  const PathMotion& motion_;
  std::array<double, kPathAxes.size()> counts_per_unit_{};  ///< 0 where there is no W
  double along_counts_per_mm_;
  std::int64_t along_ = 0;
  std::int64_t done_ = 0;
  std::vector<PathInstant> instants_;
  std::vector<PathSetPoint> points_;
};

/// Lines of a program on their way into a sink, a chunk at a time.
class LineChunks {
 public:
  LineChunks(const ProgramHeader& header, LineSink& sink)
      : line_bytes_(static_cast<std::size_t>(header.line_bytes())),
        lines_(header.plan.rotary.lines_per_revolution),
        sink_(sink) {}

  std::span<std::byte> next_line() {
    bytes_.resize(bytes_.size() + line_bytes_);
    return std::span(bytes_).last(line_bytes_);
  }
  Result<void> end_line() {
    ++done_;
    if (done_ % sink_.lines_per_chunk() != 0 && done_ != lines_) {
      return {};
    }
    GRAVURE_TRY(const StoredChunk chunk, sink_.encode({0, (done_ - 1) / sink_.lines_per_chunk()}, bytes_));
    fired_ += chunk.fired_pixels;
    bytes_.clear();
    return sink_.put(chunk);
  }
  std::int64_t fired() const noexcept { return fired_; }

 private:
  std::size_t line_bytes_;
  std::int64_t lines_;
  LineSink& sink_;
  std::vector<std::byte> bytes_;
  std::int64_t done_ = 0;
  std::int64_t fired_ = 0;
};

class PathCompiler {
 public:
  PathCompiler(ProgramHeader header, const PathMotion& motion, const PathPulses& pulses, LineSink& sink)
      : header_(std::move(header)),
        sink_(sink),
        set_points_(header_.plan, motion),
        slots_(header_.plan, pulses),
        chunks_(header_, sink) {}

  Result<void> run(CancelToken* cancel, Progress* progress) {
    const std::int64_t lines = header_.plan.rotary.lines_per_revolution;
    while (true) {
      if (cancel != nullptr && cancel->cancelled()) {
        return Error{ErrorCode::cancelled, "stopped before the program was complete; nothing was written"};
      }
      GRAVURE_TRY(const auto block, set_points_.next());
      if (block.empty()) {
        break;
      }
      GRAVURE_CHECK(sink_.put_set_points(block));
      for (const PathSetPoint& point : block) {
        GRAVURE_CHECK(take(point));
      }
      if (progress != nullptr) {
        progress->update(std::max<std::int64_t>(0, taken_ - 1), lines);
      }
    }
    GRAVURE_CHECK(line_between(window_[3]));
    return slots_.finish();
  }

  Result<CompiledPath> finish() {
    header_.layers = {StoredLayer{false, chunks_.fired(), 0, 0}};
    header_.layer_of_revolution = {0};
    header_.format_version = format_version_of(header_.plan);
    GRAVURE_CHECK(sink_.finish(header_));
    const PathSpacing spacing = slots_.spacing();
    return CompiledPath{std::move(header_), spacing};
  }

 private:
  /// The period between two set-points is known with the one after them.
  Result<void> take(const PathSetPoint& point) {
    ++taken_;
    if (taken_ == 1) {
      window_.fill(point);
      return {};
    }
    if (taken_ == 2) {
      window_[3] = point;
      return {};
    }
    return line_between(point);
  }

  Result<void> line_between(const PathSetPoint& after) {
    window_ = {window_[1], window_[2], window_[3], after};
    GRAVURE_CHECK(slots_.place(window_, chunks_.next_line()));
    return chunks_.end_line();
  }

  ProgramHeader header_;
  LineSink& sink_;
  SetPointReader set_points_;
  PathSlots slots_;
  LineChunks chunks_;
  PathWindow window_{};  ///< before, begin, end of the line that comes next stand at 1, 2, 3
  std::int64_t taken_ = 0;
};

}  // namespace

Result<CompiledPath> compile_path(ProgramHeader header, const PathMotion& motion, const PathPulses& pulses,
                                  std::span<const PathTarget> targets, LineSink& sink, CancelToken* cancel,
                                  Progress* progress) {
  GRAVURE_CHECK(check_inputs(header.plan, motion, pulses, targets));
  PathCompiler compiler(std::move(header), motion, pulses, sink);
  for (std::size_t at = 0; at < targets.size(); at += kInstants) {
    GRAVURE_CHECK(sink.put_targets(targets.subspan(at, std::min<std::size_t>(kInstants, targets.size() - at))));
  }
  GRAVURE_CHECK(compiler.run(cancel, progress));
  return compiler.finish();
}

}  // namespace gravure
