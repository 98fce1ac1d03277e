#include "gravure/twin/verify_path.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "chunk_run.hpp"
#include "gravure/core/path_expand.hpp"
#include "gravure/core/set_point_walk.hpp"
#include "gravure/core/units.hpp"
#include "gravure/kinematics/machines.hpp"
#include "path_limits.hpp"
#include "path_targets.hpp"

namespace gravure {
namespace {

constexpr double kDegPerRad = 180 / std::numbers::pi;

/// Keeps the largest and the mean square.
class Figure {
 public:
  void take(double value, std::int64_t pulse) {
    sum_ += value * value;
    ++count_;
    if (figure_.worst_pulse < 0 || value > figure_.max) {
      figure_.max = value;
      figure_.worst_pulse = pulse;
    }
  }
  PulseFigure result() const {
    PulseFigure figure = figure_;
    figure.rms = count_ > 0 ? std::sqrt(sum_ / static_cast<double>(count_)) : 0;
    return figure;
  }

 private:
  PulseFigure figure_;
  double sum_ = 0;
  std::int64_t count_ = 0;
};

/// The windows of set-points of a program, line after line.
class WindowWalk {
 public:
  explicit WindowWalk(LineSource& program) : points_(program) {}
  Result<PathWindow> window(std::int64_t line) {
    PathWindow window;
    for (std::int64_t i = 0; i < 4; ++i) {
      GRAVURE_TRY(window[static_cast<std::size_t>(i)], points_.at(line - 1 + i));
    }
    return window;
  }

 private:
  SetPointWalk points_;
};

bool bit_of(std::span<const std::byte> bits, std::int64_t at) {
  return (bits[static_cast<std::size_t>(at / 8)] & static_cast<std::byte>(0x80U >> (at % 8))) != std::byte{0};
}

class PathJudge {
 public:
  PathJudge(LineSource& program, const VerifyPathOptions& options)
      : plan_(program.header().plan),
        path_(*plan_.path),
        options_(options),
        machine_(path_machine(path_)),
        targets_(program, options.targets),
        limits_(plan_),
        counts_per_mm_(to_double(path_.along_counts_per_mm)),
        pitch_counts_(to_double(plan_.line.pixel_pitch_um * path_.along_counts_per_mm / Rational(1000))) {
    for (std::size_t axis = 0; axis < path_.axes.size(); ++axis) {
      units_per_count_[axis] = 1 / to_double(path_.axes[axis].counts_per_unit);
    }
    report_.pulses = path_.pulses;
    report_.bits_compared = options.wanted != nullptr;
    report_.points_compared = targets_.there();
  }

  Result<void> line(const PathWindow& window, std::int64_t line, std::span<const std::byte> fired) {
    limits_.take(window, line);
    const CoveredPath covered(window);
    for (std::int64_t slot = 0; slot < plan_.line.slots; ++slot) {
      if (slot % 8 == 0 && fired[static_cast<std::size_t>(slot / 8)] == std::byte{0}) {
        slot += 7;
      } else if (bit_of(fired, slot)) {
        GRAVURE_CHECK(fire(window, covered, line, slot));
      }
    }
    last_half_ = covered.covered() - covered.at(1 - half_slot());
    ++report_.lines;
    report_.ticks += plan_.line.ticks;
    return {};
  }

  PathReport finish() {
    count_missing(path_.pulses);
    report_.axes = limits_.uses();
    report_.spacing_um = spacing_.result();
    report_.focus_offset_um = focus_.result();
    report_.incidence_deg = incidence_.result();
    report_.displacement_mm = displacement_.result();
    report_.landing_um = landing_.result();
    say_violations();
    return std::move(report_);
  }

 private:
  double half_slot() const { return 0.5 / static_cast<double>(plan_.line.slots); }  ///< of the period

  Result<void> fire(const PathWindow& window, const CoveredPath& covered, std::int64_t line, std::int64_t slot) {
    ++report_.fired;
    const double share = static_cast<double>(slot) / static_cast<double>(plan_.line.slots);
    const double half = half_slot();
    const double along = static_cast<double>(window[1].along_counts) + covered.at(share);
    const auto pulse = static_cast<std::int64_t>(std::floor(along / pitch_counts_));
    const double belongs = (static_cast<double>(pulse) + 0.5) * pitch_counts_;
    // Half a slot of way, on whichever side there is more; before the first slot it is that of the period before.
    const double before = slot == 0 ? last_half_ : covered.at(share) - covered.at(share - half);
    const double way = std::max(covered.at(std::min(1.0, share + half)) - covered.at(share), before);
    constexpr double kRounding_counts = 2;
    const bool in_place = std::abs(along - belongs) <= way * 1.01 + kRounding_counts;
    if (!in_place || pulse <= last_ || pulse >= path_.pulses) {
      ++report_.misplaced;
      note_first(first_misplaced_, line, slot);
      return {};
    }
    count_missing(pulse);
    last_ = pulse;
    if (options_.wanted != nullptr && !bit_of(options_.wanted->bits, pulse)) {
      ++report_.unwanted;
      note_first(first_unwanted_, line, slot);
    }
    spacing_.take(std::abs(along - belongs) / counts_per_mm_ * kUmPerMm, pulse);
    report_.half_slot_um = std::max(report_.half_slot_um, way / counts_per_mm_ * kUmPerMm);
    return land(window, share, pulse, (line * plan_.line.slots + slot) * plan_.clock.ticks_per_slot,
                belongs / counts_per_mm_);
  }

  Result<void> land(const PathWindow& window, double share, std::int64_t pulse, std::int64_t tick, double along_mm) {
    std::array<double, kPathAxes.size()> axes{};
    for (std::size_t axis = 0; axis < path_.axes.size(); ++axis) {
      axes[axis] = axis_motion(window, axis, share).position * units_per_count_[axis];
    }
    const std::span<const double> joints(axes.data(), 5);
    const kinematics::FieldPoint field{axes[5], axes[6], axes[kFocusAxis]};
    const kinematics::Spot spot = kinematics::forward(machine_, joints, field);
    displacement_.take(std::hypot(axes[5], axes[6]), pulse);
    if (options_.landed) {
      GRAVURE_CHECK(options_.landed({pulse, tick, spot}));
    }
    GRAVURE_TRY(const std::optional<WantedPoint> wanted, targets_.at(along_mm));
    if (!wanted) {
      beyond_ = targets_.there() && beyond_ < 0 ? pulse : beyond_;
      return {};
    }
    const kinematics::Vector3 off = wanted->position_mm - spot.position_mm;
    const double along_beam = off.dot(spot.towards_head);
    focus_.take(std::abs(along_beam) * kUmPerMm, pulse);
    landing_.take((off - along_beam * spot.towards_head).norm() * kUmPerMm, pulse);
    const double cross = wanted->normal.cross(spot.towards_head).norm();
    incidence_.take(std::atan2(cross, wanted->normal.dot(spot.towards_head)) * kDegPerRad, pulse);
    return {};
  }

  void count_missing(std::int64_t next) {
    for (std::int64_t pulse = last_ + 1; options_.wanted != nullptr && pulse < next; ++pulse) {
      if (bit_of(options_.wanted->bits, pulse)) {
        first_missing_ = report_.missing == 0 ? pulse : first_missing_;
        ++report_.missing;
      }
    }
  }

  void note_first(std::string& place, std::int64_t line, std::int64_t slot) const {
    if (place.empty()) {
      place = fmt::format("line {}, slot {}", line, slot);
    }
  }

  void say_violations() {
    std::vector<std::string>& said = report_.violations;
    if (report_.misplaced > 0) {
      said.push_back(
          fmt::format("{} pulses fire where none belongs, the first in {}", report_.misplaced, first_misplaced_));
    }
    if (report_.missing > 0) {
      said.push_back(
          fmt::format("{} wanted pulses do not fire, the first is number {}", report_.missing, first_missing_));
    }
    if (report_.unwanted > 0) {
      said.push_back(
          fmt::format("{} pulses fire that are to stay dark, the first in {}", report_.unwanted, first_unwanted_));
    }
    if (beyond_ >= 0) {
      said.push_back(fmt::format("pulse {} lies beyond the wanted path", beyond_));
    }
    hold("focus offset", report_.focus_offset_um, path_.max_focus_offset_um, "um");
    hold("incidence", report_.incidence_deg, path_.max_incidence_deg, "deg");
    hold("displacement of the galvo", report_.displacement_mm, path_.max_displacement_mm, "mm");
    hold("landing", report_.landing_um, path_.max_landing_um, "um");
    const std::vector<std::string> axes = limits_.violations();
    said.insert(said.end(), axes.begin(), axes.end());
    if (!report_.points_compared) {
      report_.notes.emplace_back("the program stores no wanted points: focus, incidence and landing are not judged");
    }
    if (!report_.bits_compared) {
      report_.notes.emplace_back(
          "the bits are not compared: which pulses of the picture fire is known to the job and its picture alone, and "
          "they are not at hand");
    }
  }

  void hold(const char* what, const PulseFigure& figure, const std::optional<Rational>& limit, const char* unit) {
    constexpr double kRounding = 1e-6;  // of a limit, as for the axes: what lies on it by design is within
    if (limit && figure.max > to_double(*limit) * (1 + kRounding)) {
      report_.violations.push_back(fmt::format("{} {:.6g} {} at pulse {}, allowed {:.6g}", what, figure.max, unit,
                                               figure.worst_pulse, to_double(*limit)));
    }
  }

  const Plan& plan_;
  const PathPlan& path_;
  const VerifyPathOptions& options_;
  kinematics::Machine machine_;
  TargetWalk targets_;
  PathLimits limits_;
  double counts_per_mm_;
  double pitch_counts_;
  std::array<double, kPathAxes.size()> units_per_count_{};
  std::int64_t last_ = -1;  ///< pulse
  double last_half_ = 0;    ///< counts covered in the last half slot of the period before
  std::int64_t beyond_ = -1;
  std::int64_t first_missing_ = -1;
  std::string first_misplaced_;
  std::string first_unwanted_;
  Figure spacing_;
  Figure focus_;
  Figure incidence_;
  Figure displacement_;
  Figure landing_;
  PathReport report_;
};

}  // namespace

kinematics::Machine path_machine(const PathPlan& path) {
  const auto signs =
      path.machine == "post_processor" ? kinematics::XyzacSigns::post_processor : kinematics::XyzacSigns::texturing;
  const kinematics::Vector3 centre(to_double(path.rotary_centre_mm[0]), to_double(path.rotary_centre_mm[1]),
                                   to_double(path.rotary_centre_mm[2]));
  return kinematics::xyzac_machine(signs, centre, {});
}

Result<PathReport> verify_path(LineSource& program, const DeviceFactory& devices, const VerifyPathOptions& options) {
  const ProgramHeader& header = program.header();
  if (!header.plan.path) {
    return Error{ErrorCode::bad_argument,
                 "the program follows no path: its mode is " + std::string(mode_name(header.plan.mode))};
  }
  if (options.wanted != nullptr && options.wanted->count != header.plan.path->pulses) {
    return Error{ErrorCode::bad_argument, fmt::format("the job has {} pulses, the program {}: compile it again",
                                                      options.wanted->count, header.plan.path->pulses)};
  }
  PathJudge judge(program, options);
  WindowWalk windows(program);
  ChunkRun runner(program, devices, options.cancel);
  const std::int64_t lines = header.plan.rotary.lines_per_revolution;
  const auto bytes = static_cast<std::size_t>(header.line_bytes());
  for (std::int64_t first = 0; first < lines; first += runner.lines()) {
    GRAVURE_TRY(const std::span<const std::byte> landed, runner.run(0, first / program.lines_per_chunk(), false));
    for (std::int64_t line = first; line < first + runner.lines(); ++line) {
      GRAVURE_TRY(const PathWindow window, windows.window(line));
      GRAVURE_CHECK(judge.line(window, line, landed.subspan(static_cast<std::size_t>(line - first) * bytes, bytes)));
    }
    if (options.progress != nullptr) {
      options.progress->update(first + runner.lines(), lines);
    }
  }
  return judge.finish();
}

}  // namespace gravure
