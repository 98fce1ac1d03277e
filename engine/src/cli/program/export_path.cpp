#include "program/export_path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include "folder_output.hpp"
#include "gravure/core/file_output.hpp"
#include "gravure/core/set_point_walk.hpp"
#include "gravure/formats/grv.hpp"
#include "gravure/formats/nc_program.hpp"
#include "gravure/scan/xy2_100.hpp"
#include "program/path_program.hpp"
#include "text_output.hpp"

namespace gravure::cli {
namespace {

using AxisPlaces = std::array<double, kPathAxes.size()>;  // W is 0 where there is none
constexpr double kWritten = 0.6e-9;                       // half of the last digit written, and the reader's rounding
constexpr int kFrameBits = 20;

/// The axes that NC programs move; U and V are the galvo's.
std::span<const std::size_t> nc_axes(const PathPlan& path) {
  static constexpr std::array<std::size_t, nc::kMostStages> kAxes{0, 1, 2, 3, 4, kFocusAxis};
  return std::span(kAxes).first(path.has_focus_axis() ? nc::kMostStages : nc::kStages);
}

std::string table_head(const PathPlan& path) {
  std::string head = "t_s";
  for (std::size_t axis = 0; axis < path.axes.size(); ++axis) {
    head += fmt::format(",{}_{}", kPathAxes[axis], axis_turns(axis) ? "deg" : "mm");
  }
  return head + ",along_mm\n";
}

/// The set-points of a program in mm and degrees.
class Places {
 public:
  explicit Places(LineSource& program) : points_(program) {
    const PathPlan& path = *program.header().plan.path;
    for (std::size_t axis = 0; axis < path.axes.size(); ++axis) {
      units_[axis] = (axis_turns(axis) ? 180 / std::numbers::pi : 1) / to_double(path.axes[axis].counts_per_unit);
    }
    along_unit_ = 1 / to_double(path.along_counts_per_mm);
  }
  std::int64_t total() const noexcept { return points_.total(); }
  Result<AxisPlaces> at(std::int64_t index) {
    GRAVURE_TRY(const PathSetPoint point, points_.at(index));
    AxisPlaces places{};
    for (std::size_t axis = 0; axis < places.size(); ++axis) {
      places[axis] = static_cast<double>(point.counts[axis]) * units_[axis];
    }
    return places;
  }
  Result<double> along_mm(std::int64_t index) {
    GRAVURE_TRY(const PathSetPoint point, points_.at(index));
    return static_cast<double>(point.along_counts) * along_unit_;
  }

 private:
  SetPointWalk points_;
  AxisPlaces units_{};
  double along_unit_ = 0;
};

nc::StagePlace stages_of(const AxisPlaces& places) {
  nc::StagePlace stages{};
  std::copy_n(places.begin(), nc::kStages, stages.begin());
  stages[nc::kStages] = places[kFocusAxis];
  return stages;
}

/// How an exported file stands to the program.
struct Deviation {
  nc::StagePlace most{};  ///< between blocks, at the servo's instants: mm and degrees
};

class Exporter {
 public:
  Exporter(LineSource& program, std::int64_t periods_per_block, const FolderOutput& folder)
      : plan_(program.header().plan),
        places_(program),
        step_(periods_per_block),
        period_s_(1 / to_double(plan_.line.rate_hz)),
        stages_(nc_axes(*plan_.path).size()),
        folder_(folder) {}

  std::int64_t blocks() const { return (places_.total() - 2) / step_ + 1; }
  /// The field of the galvo, where the plan has one.
  std::optional<double> field_mm() const {
    const PathAxisPlan& u = plan_.path->axes[5];
    const PathAxisPlan& v = plan_.path->axes[6];
    const bool known =
        u.least && u.most && v.least && v.most && *u.most == -*u.least && *v.most == *u.most && *v.least == *u.least;
    return known ? std::optional(2 * to_double(*u.most)) : std::nullopt;
  }

  Result<void> write_stages() {
    GRAVURE_TRY(TextOutput g_code, TextOutput::create(folder_.file("stages.ngc").string()));
    GRAVURE_TRY(TextOutput pvt, TextOutput::create(folder_.file("stages.pvt").string()));
    GRAVURE_TRY(const AxisPlaces start, places_.at(0));
    g_code.text() += nc::g_code_start(stages_of(start), plan_.title, stages_);
    pvt.text() += nc::pvt_start(stages_of(start), plan_.title, stages_);
    for (std::int64_t number = 0; number < blocks(); ++number) {
      GRAVURE_TRY(const nc::StageBlock block, this->block(number));
      nc::append_g_code(block, g_code.text(), stages_);
      nc::append_pvt(block, pvt.text(), stages_);
      if (!g_code.flush(false) || !pvt.flush(false)) {
        break;
      }
      GRAVURE_CHECK(check_not_stopped());
    }
    g_code.text() += nc::g_code_end();
    pvt.text() += nc::pvt_end();
    GRAVURE_CHECK(g_code.commit());
    return pvt.commit();
  }

  Result<void> write_axes() {
    GRAVURE_TRY(TextOutput table, TextOutput::create(folder_.file("axes.csv").string()));
    table.text() += table_head(*plan_.path);
    for (std::int64_t i = 0; i < places_.total(); ++i) {
      GRAVURE_TRY(const AxisPlaces places, places_.at(i));
      GRAVURE_TRY(const double along, places_.along_mm(i));
      table.text() += fmt::format("{:.9f}", static_cast<double>(i) * period_s_);
      for (std::size_t axis = 0; axis < plan_.path->axes.size(); ++axis) {
        table.text() += fmt::format(",{:.9f}", rounded(places[axis], 9));
      }
      table.text() += fmt::format(",{:.9f}\n", along);
      if (!table.flush(false)) {
        break;
      }
      GRAVURE_CHECK(check_not_stopped());
    }
    return table.commit();
  }

  Result<void> write_galvo(double field_mm) {
    GRAVURE_TRY(TextOutput output, TextOutput::create(folder_.file("galvo.gxy2").string()));
    output.text() += scan::encode_stream_start(scan::FrameForm::bits20, static_cast<std::uint64_t>(places_.total()));
    for (std::int64_t i = 0; i < places_.total(); ++i) {
      GRAVURE_TRY(const auto counts, galvo_counts(i, field_mm));
      const auto frames = scan::frames_of({{0, 0, counts[0], counts[1]}}, kFrameBits, scan::FrameForm::bits20);
      if (!frames) {
        return Error{frames.error().code, fmt::format("period {}: {}", i, frames.error().message)};
      }
      scan::append_frames(scan::FrameForm::bits20, frames.value(), output.text());
      if (!output.flush(false)) {
        break;
      }
      GRAVURE_CHECK(check_not_stopped());
    }
    return output.commit();
  }

  /// Reads both NC programs and holds them against the set-points.
  Result<Deviation> check_g_code() {
    GRAVURE_TRY(const std::string text, read_file(folder_.file("stages.ngc").string(), nc::kMostProgramBytes));
    GRAVURE_TRY(const nc::StageProgram program, nc::parse_g_code(text));
    return deviation(program, false);
  }
  Result<Deviation> check_pvt() {
    GRAVURE_TRY(const std::string text, read_file(folder_.file("stages.pvt").string(), nc::kMostProgramBytes));
    GRAVURE_TRY(const nc::StageProgram program, nc::parse_pvt(text));
    return deviation(program, true);
  }

  Result<void> check_galvo(double field_mm) {
    GRAVURE_TRY(const std::string bytes, read_file(folder_.file("galvo.gxy2").string(), std::size_t{1} << 33U));
    GRAVURE_TRY(const scan::FrameStream stream, scan::decode_stream(bytes));
    if (static_cast<std::int64_t>(stream.frames.size()) != places_.total()) {
      return differs("galvo.gxy2", static_cast<std::int64_t>(stream.frames.size()));
    }
    for (std::int64_t i = 0; i < places_.total(); ++i) {
      GRAVURE_TRY(const auto counts, galvo_counts(i, field_mm));
      const scan::FramePosition& frame = stream.frames[static_cast<std::size_t>(i)];
      if (frame.u_count != counts[0] || frame.v_count != counts[1]) {
        return differs("galvo.gxy2", i);
      }
    }
    return {};
  }

  /// Line by line: of hours there are gigabytes.
  Result<void> check_axes() {
    std::ifstream table(folder_.file("axes.csv"));
    std::string line;
    if (!std::getline(table, line) || line + "\n" != table_head(*plan_.path)) {
      return differs("axes.csv", 0);
    }
    for (std::int64_t i = 0; i < places_.total(); ++i) {
      GRAVURE_TRY(const AxisPlaces places, places_.at(i));
      if (!std::getline(table, line) || !says(line, places)) {
        return differs("axes.csv", i);
      }
    }
    return !std::getline(table, line) ? Result<void>() : differs("axes.csv", places_.total());
  }

 private:
  /// Does a line of the table have these places behind its time?
  bool says(std::string_view line, const AxisPlaces& places) const {
    const std::size_t axes = plan_.path->axes.size();
    std::array<double, kPathAxes.size() + 2> numbers{};
    const std::span<double> row = std::span(numbers).first(axes + 2);
    for (double& value : row) {
      const auto [end, failed] = std::from_chars(line.data(), line.data() + line.size(), value);
      const auto taken = static_cast<std::size_t>(end - line.data());
      const bool last = &value == &row.back();
      if (failed != std::errc() || (last ? taken != line.size() : taken >= line.size() || line[taken] != ',')) {
        return false;
      }
      line.remove_prefix(last ? taken : taken + 1);
    }
    for (std::size_t axis = 0; axis < axes; ++axis) {
      if (!(std::abs(row[axis + 1] - places[axis]) <= kWritten)) {
        return false;
      }
    }
    return true;
  }

  static Error differs(const std::string& file, std::int64_t place) {
    return {ErrorCode::io,
            fmt::format("{}: what was written reads back differently at {}: nothing is kept; is the disk "
                        "sound?",
                        file, place)};
  }

  std::int64_t end_of(std::int64_t block) const { return std::min((block + 1) * step_, places_.total() - 1); }

  Result<nc::StageBlock> block(std::int64_t number) {
    const std::int64_t end = end_of(number);
    nc::StageBlock block;
    block.duration_s = static_cast<double>(end - number * step_) * period_s_;
    GRAVURE_TRY(const AxisPlaces places, places_.at(end));
    GRAVURE_TRY(const AxisPlaces before, places_.at(end - 1));
    GRAVURE_TRY(const AxisPlaces after, places_.at(end + 1));
    block.place = stages_of(places);
    const nc::StagePlace from = stages_of(before);
    const nc::StagePlace to = stages_of(after);
    for (std::size_t i = 0; i < stages_; ++i) {
      block.speed[i] = end == places_.total() - 1 ? 0 : (to[i] - from[i]) / (2 * period_s_);
    }
    return block;
  }

  Result<std::array<std::int32_t, 2>> galvo_counts(std::int64_t index, double field_mm) {
    GRAVURE_TRY(const AxisPlaces places, places_.at(index));
    const auto count = [field_mm](double place) {
      return static_cast<std::int32_t>(std::lround(place / field_mm * (1 << kFrameBits)));
    };
    return std::array{count(places[5]), count(places[6])};
  }

  Result<Deviation> deviation(const nc::StageProgram& program, bool cubic) {
    const char* file = cubic ? "stages.pvt" : "stages.ngc";
    Deviation deviation;
    if (program.stages != stages_ || static_cast<std::int64_t>(program.blocks.size()) != blocks()) {
      return differs(file, static_cast<std::int64_t>(program.blocks.size()));
    }
    nc::StagePlace from = program.start;
    nc::StagePlace from_speed{};
    for (std::int64_t number = 0; number < blocks(); ++number) {
      const nc::StageBlock& read = program.blocks[static_cast<std::size_t>(number)];
      GRAVURE_TRY(const nc::StageBlock intended, block(number));
      const bool on_time = std::abs(read.duration_s - intended.duration_s) <= 1e-9 * intended.duration_s + 1e-12;
      for (std::size_t i = 0; i < stages_; ++i) {
        if (!on_time || !(std::abs(read.place[i] - intended.place[i]) <= kWritten) ||
            (cubic && !(std::abs(read.speed[i] - intended.speed[i]) <= kWritten))) {
          return differs(file, number);
        }
      }
      const std::int64_t periods = end_of(number) - number * step_;
      for (std::int64_t i = 0; i <= periods; ++i) {
        const double share = static_cast<double>(i) / static_cast<double>(periods);
        const nc::StagePlace moved =
            cubic ? nc::cubic_between(from, from_speed, read, share) : nc::straight_between(from, read, share);
        GRAVURE_TRY(const AxisPlaces places, places_.at(number * step_ + i));
        const nc::StagePlace wanted = stages_of(places);
        for (std::size_t axis = 0; axis < stages_; ++axis) {
          deviation.most[axis] = std::max(deviation.most[axis], std::abs(moved[axis] - wanted[axis]));
        }
      }
      from = read.place;
      from_speed = read.speed;
    }
    return deviation;
  }

  const Plan& plan_;
  Places places_;
  std::int64_t step_;
  double period_s_;
  std::size_t stages_;  ///< of NC programs
  const FolderOutput& folder_;
};

Json json_of(const Deviation& deviation, const PathPlan& path) {
  Json json = Json::object();
  for (std::size_t i = 0; i < nc_axes(path).size(); ++i) {
    const std::size_t axis = nc_axes(path)[i];
    json[std::string(kPathAxes[axis]) + (axis_turns(axis) ? "_deg" : "_mm")] = deviation.most[i];
  }
  return json;
}

std::string text_of(const char* name, const Deviation& deviation, const PathPlan& path) {
  const std::string focus =
      path.has_focus_axis() ? fmt::format(" {} {:.3g}", kPathAxes[kFocusAxis], deviation.most[nc::kStages]) : "";
  return fmt::format("{:<12}off at most X {:.3g} Y {:.3g} Z {:.3g}{} mm, A {:.3g} C {:.3g} deg between blocks\n", name,
                     deviation.most[0], deviation.most[1], deviation.most[2], focus, deviation.most[3],
                     deviation.most[4]);
}

/// Refuses, before anything is written, what the disk has no room for; says what takes long.
Result<void> check_room(const std::string& folder, std::int64_t set_points, std::int64_t blocks) {
  constexpr double kBytesPerSetPoint = 125;  // a line of axes.csv and two frames
  constexpr double kBytesPerBlock = 210;     // of both NC programs
  constexpr double kGigabyte = 1e9;
  const double gigabytes =
      (kBytesPerSetPoint * static_cast<double>(set_points) + kBytesPerBlock * static_cast<double>(blocks)) / kGigabyte;
  std::error_code failed;
  const std::filesystem::path parent = std::filesystem::absolute(folder, failed).parent_path();
  const auto space = std::filesystem::space(parent, failed);
  if (!failed && static_cast<double>(space.available) / kGigabyte < gigabytes) {
    return Error{ErrorCode::io,
                 fmt::format("{}: {} set-points take some {:.3g} GB, the disk has {:.3g} GB free; make "
                             "room, or give a folder elsewhere",
                             folder, set_points, gigabytes, static_cast<double>(space.available) / kGigabyte)};
  }
  if (gigabytes >= 1) {
    warn(fmt::format("{}: {} set-points take some {:.3g} GB", folder, set_points, gigabytes));
  }
  return {};
}

}  // namespace

Result<int> export_path(const std::string& path, const std::string& folder_path, double block_ms,
                        const Command& command) {
  GRAVURE_TRY(const std::unique_ptr<LineSource> program, open_grv(path));
  const Plan& plan = program->header().plan;
  if (!plan.path) {
    return Error{ErrorCode::bad_argument,
                 path + ": follows no path, its mode is " + std::string(mode_name(plan.mode)) + ": use --xy2-100"};
  }
  const double periods = block_ms / 1000 * to_double(plan.line.rate_hz);
  const auto per_block = static_cast<std::int64_t>(std::llround(periods));
  if (per_block < 1 || std::abs(periods - static_cast<double>(per_block)) > 1e-6) {
    return Error{ErrorCode::bad_argument, fmt::format("--block-ms {}: must be a whole number of servo periods of {} ms",
                                                      block_ms, 1000 / to_double(plan.line.rate_hz))};
  }
  GRAVURE_CHECK(check_room(folder_path, set_points_of(plan), (set_points_of(plan) - 2) / per_block + 1));
  cancel_token();  // before there is a folder
  GRAVURE_TRY(FolderOutput folder, FolderOutput::create(folder_path));
  Exporter exporter(*program, per_block, folder);
  const std::optional<double> field = exporter.field_mm();
  GRAVURE_CHECK(exporter.write_stages());
  GRAVURE_CHECK(exporter.write_axes());
  GRAVURE_TRY(const Deviation straight, exporter.check_g_code());
  GRAVURE_TRY(const Deviation cubic, exporter.check_pvt());
  GRAVURE_CHECK(exporter.check_axes());
  if (field) {
    GRAVURE_CHECK(exporter.write_galvo(*field));
    GRAVURE_CHECK(exporter.check_galvo(*field));
  }
  GRAVURE_CHECK(folder.commit());
  if (command.json) {
    print_json({{"blocks", exporter.blocks()},
                {"block_ms", block_ms},
                {"set_points", set_points_of(plan)},
                {"galvo_field_mm", field ? Json(*field) : Json(nullptr)},
                {"g_code_off", json_of(straight, *plan.path)},
                {"pvt_off", json_of(cubic, *plan.path)}});
    return kDone;
  }
  print(fmt::format("{}: {} blocks of {} ms, {} set-points; all read back and compared\n", folder_path,
                    exporter.blocks(), block_ms, set_points_of(plan)) +
        text_of("stages.ngc", straight, *plan.path) + text_of("stages.pvt", cubic, *plan.path) +
        (field ? fmt::format("galvo.gxy2  20 bits over {} mm\n", *field)
               : "galvo.gxy2  not written: the plan gives U and V no field\n"));
  return kDone;
}

}  // namespace gravure::cli
