#include "gravure/twin/verify.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <mutex>
#include <thread>
#include <tuple>

#include "axis_check.hpp"
#include "gravure/raster/count.hpp"
#include "gravure/raster/place.hpp"

namespace gravure {
namespace {

std::size_t size(std::int64_t bytes) {
  return static_cast<std::size_t>(bytes);
}

std::string place(const Plan& plan, std::int64_t ordinal) {
  return "revolution " + std::to_string(ordinal / plan.rotary.lines_per_revolution) + ", line " +
         std::to_string(ordinal % plan.rotary.lines_per_revolution);
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

/// What one worker has seen; merged into one.
struct Tally {
  std::int64_t lines = 0;
  std::int64_t fired = 0;
  std::int64_t wrong_pixels = 0;
  std::int64_t first_wrong_ordinal = -1;
  std::int64_t first_wrong_column = -1;
  double worst_edges = 0;  ///< with sign
  std::int64_t worst_ordinal = -1;
  std::int64_t end_tick = 0;
  Finding refused;
  Finding misplaced;
  Finding off_axis;

  void see_axis(double edges, std::int64_t ordinal) {
    if (worst_ordinal < 0 || std::fabs(edges) > std::fabs(worst_edges) ||
        (std::fabs(edges) == std::fabs(worst_edges) && ordinal < worst_ordinal)) {
      worst_edges = edges;
      worst_ordinal = ordinal;
    }
  }
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
    if (other.worst_ordinal >= 0) {
      see_axis(other.worst_edges, other.worst_ordinal);
    }
    refused.merge(other.refused);
    misplaced.merge(other.misplaced);
    off_axis.merge(other.off_axis);
  }
};

/// The layers cut from one source image, and the revolutions that expose each.
struct Group {
  std::vector<std::int64_t> layers;
};

class Verifier {
 public:
  Verifier(const ProgramHeader& header, std::int64_t lines_per_chunk, const AxisCheck& axis,
           const DeviceFactory& devices, const VerifyOptions& options)
      : header_(header),
        plan_(header.plan),
        lines_per_chunk_(lines_per_chunk),
        axis_(axis),
        devices_(devices),
        options_(options),
        revolutions_of_(header.layers.size()) {
    for (std::size_t r = 0; r < header.layer_of_revolution.size(); ++r) {
      revolutions_of_[header.layer_of_revolution[r]].push_back(static_cast<std::int64_t>(r));
    }
    for (std::size_t layer = 0; layer < header.layers.size(); ++layer) {
      const bool same = layer > 0 && header.layers[layer].source == header.layers[layer - 1].source;
      if (!same) {
        groups_.emplace_back();
      }
      groups_.back().layers.push_back(static_cast<std::int64_t>(layer));
    }
    chunks_ = (plan_.rotary.lines_per_revolution + lines_per_chunk_ - 1) / lines_per_chunk_;
  }

  Result<Tally> run(const std::function<Result<std::unique_ptr<LineSource>>()>& programs,
                    const LayerLinesFactory& images) {
    const int wanted = options_.threads > 0 ? options_.threads : static_cast<int>(std::thread::hardware_concurrency());
    // A worker holds a chunk as stored, packed, turned, fired, landed and as the image has it, and the image's samples.
    const std::int64_t each = lines_per_chunk_ * header_.line_bytes() * 6 + (std::int64_t{40} << 20);
    const std::int64_t fit = std::max<std::int64_t>(1, options_.memory_bytes / each);
    const std::int64_t tasks = static_cast<std::int64_t>(groups_.size()) * chunks_;
    const std::int64_t count =
        std::clamp<std::int64_t>(std::min<std::int64_t>(wanted, fit), 1, std::max<std::int64_t>(1, tasks));
    std::vector<std::thread> workers;
    for (std::int64_t i = 1; i < count; ++i) {
      workers.emplace_back([&] { work(programs, images); });
    }
    work(programs, images);
    for (std::thread& worker : workers) {
      worker.join();
    }
    if (error_) {
      return *error_;
    }
    return tally_;
  }

 private:
  class Worker;
  friend class Worker;

  void work(const std::function<Result<std::unique_ptr<LineSource>>()>& programs, const LayerLinesFactory& images);

  void fail(const Error& error) {
    const std::lock_guard lock(mutex_);
    if (!error_) {
      error_ = error;
    }
    stop_ = true;
  }

  void done(std::int64_t lines) {
    const std::lock_guard lock(mutex_);
    lines_done_ += lines;
    if (options_.progress != nullptr) {
      options_.progress->update(lines_done_, plan_.job.revolutions * plan_.rotary.lines_per_revolution);
    }
  }

  const ProgramHeader& header_;
  const Plan& plan_;
  const std::int64_t lines_per_chunk_;
  const AxisCheck& axis_;
  const DeviceFactory& devices_;
  const VerifyOptions& options_;
  std::vector<std::vector<std::int64_t>> revolutions_of_;
  std::vector<Group> groups_;
  std::int64_t chunks_ = 0;
  std::atomic<std::int64_t> next_{0};
  std::atomic<bool> stop_{false};
  std::mutex mutex_;
  std::int64_t lines_done_ = 0;
  std::optional<Error> error_;
  Tally tally_;
};

/// One worker: a device, the pins it watches, and its own readers.
class Verifier::Worker final : public PinObserver {
 public:
  Worker(Verifier& parent, std::unique_ptr<LineSource> program, std::unique_ptr<LayerLines> images)
      : parent_(parent),
        header_(parent.header_),
        plan_(parent.plan_),
        program_(std::move(program)),
        images_(std::move(images)),
        landing_(plan_),
        device_(parent.devices_(*this)) {}

  void on_line(const ExecutedLine& line) override {
    ++tally_.lines;
    tally_.fired += raster::popcount(line.fired);
    const std::int64_t ordinal = first_ordinal_ + landing_.lines();
    const bool in_time = line.ordinal == ordinal && line.start_tick == ordinal * plan_.line.ticks;
    const double edges = parent_.axis_.error_edges(line.ordinal, line.axis_at_start);
    tally_.see_axis(edges, line.ordinal);
    // Beside its drift the axis may be late by the step it is about to make: one edge, and with a prescaler one more.
    const double drift_edges = to_double_drift(line.ordinal);
    if (edges > drift_edges + kRounding || edges < drift_edges - 2.0 - kRounding) {
      tally_.off_axis.add(line.ordinal, std::to_string(edges) +
                                            " A-B edges from where it should be, the drift explains " +
                                            std::to_string(drift_edges));
    }
    const std::int64_t lost_from = parent_.axis_.first_misplaced_line();
    if (lost_from >= 0 && line.ordinal >= lost_from) {
      tally_.misplaced.add(line.ordinal, "the axis is half a line or more away");
    }
    if (!landing_.take(line) || !in_time) {
      tally_.misplaced.add(line.ordinal, "the line came at another time or in another window than planned");
    }
  }

  Result<void> run_task(const Group& group, std::int64_t chunk) {
    for (const std::int64_t layer : group.layers) {
      if (parent_.revolutions_of_[size(layer)].empty()) {
        continue;
      }
      GRAVURE_CHECK(chunk_.load(*program_, {layer, chunk}));
      GRAVURE_CHECK(load_image(layer));
      for (const std::int64_t revolution : parent_.revolutions_of_[size(layer)]) {
        if (parent_.options_.cancel != nullptr && parent_.options_.cancel->cancelled()) {
          return Error{ErrorCode::cancelled, "stopped before everything was verified"};
        }
        run_chunk(revolution);
        parent_.done(chunk_.lines());
      }
    }
    return {};
  }

  const Tally& tally() const { return tally_; }

 private:
  static constexpr double kRounding = 1e-6;  // edges; far above double's error here, far below anything that shows

  double to_double_drift(std::int64_t ordinal) const { return drift_per_line_edges_ * static_cast<double>(ordinal); }

  Result<void> load_image(std::int64_t layer) {
    if (!images_) {
      return {};
    }
    image_.resize(size(chunk_.lines() * header_.line_bytes()));
    GRAVURE_TRY(invert_, images_->read_lines(layer, chunk_.first_line(), chunk_.lines(), image_));
    return {};
  }

  void run_chunk(std::int64_t revolution) {
    first_ordinal_ = revolution * plan_.rotary.lines_per_revolution + chunk_.first_line();
    landing_.start(chunk_.lines());
    Result<void> sent = device_->configure(device_setup(plan_, revolution, chunk_.first_line()));
    if (sent) {
      sent = chunk_.send(header_, revolution, *device_);
    }
    tally_.end_tick = std::max(tally_.end_tick, device_->status().tick);
    if (!sent) {
      tally_.refused.add(first_ordinal_ + landing_.lines(), sent.error().message);
      device_ = parent_.devices_(*this);  // the fault is sticky: go on with a fresh one to see what else is wrong
    }
    if (images_) {
      compare(revolution);
    }
  }

  void compare(std::int64_t revolution) {
    const std::int64_t bytes = header_.line_bytes();
    const std::span<const std::byte> landed =
        landing_.turn_back(chunk_.first_line(), line_is_reverse(plan_, revolution, 0), invert_);
    const unsigned unused = static_cast<unsigned>(bytes * 8 - plan_.line.pixels);
    const auto mask = static_cast<std::byte>(0xFFU << unused);
    for (std::int64_t i = 0; i < chunk_.lines(); ++i) {
      const std::span<std::byte> image = std::span(image_).subspan(size(i * bytes), size(bytes));
      image.back() &= mask;
      if (i >= landing_.lines()) {  // never came
        tally_.wrong_pixels += plan_.line.pixels;
        tally_.see_wrong(first_ordinal_ + i, 0);
        continue;
      }
      const std::span<const std::byte> line = landed.subspan(size(i * bytes), size(bytes));
      if (std::memcmp(line.data(), image.data(), size(bytes)) != 0) {
        tally_.wrong_pixels += raster::count_differences(line, image);
        tally_.see_wrong(first_ordinal_ + i, raster::first_difference(line, image));
      }
    }
  }

  Verifier& parent_;
  const ProgramHeader& header_;
  const Plan& plan_;
  std::unique_ptr<LineSource> program_;
  std::unique_ptr<LayerLines> images_;
  ProgramChunk chunk_;
  Landing landing_;
  Tally tally_;
  std::vector<std::byte> image_;
  bool invert_ = false;
  std::int64_t first_ordinal_ = 0;
  const double drift_per_line_edges_ = to_double(
      Rational(parent_.axis_.drift_per_line() * plan_.rotary.edges_per_revolution / plan_.rotary.lines_per_revolution));
  std::unique_ptr<DeviceLink> device_;
};

void Verifier::work(const std::function<Result<std::unique_ptr<LineSource>>()>& programs,
                    const LayerLinesFactory& images) {
  Result<std::unique_ptr<LineSource>> program = programs();
  if (!program) {
    return fail(program.error());
  }
  std::unique_ptr<LayerLines> reader;
  if (images) {
    Result<std::unique_ptr<LayerLines>> made = images();
    if (!made) {
      return fail(made.error());
    }
    reader = std::move(made).value();
  }
  Worker worker(*this, std::move(program).value(), std::move(reader));
  const std::int64_t tasks = static_cast<std::int64_t>(groups_.size()) * chunks_;
  for (std::int64_t ticket = next_.fetch_add(1); ticket < tasks && !stop_; ticket = next_.fetch_add(1)) {
    if (Result<void> ran = worker.run_task(groups_[size(ticket / chunks_)], ticket % chunks_); !ran) {
      return fail(ran.error());
    }
  }
  const std::lock_guard lock(mutex_);
  tally_.merge(worker.tally());
}

/// The seam after every revolution: the drift of the registers the device ran with, exact.
void fill_seam(const Plan& plan, const AxisCheck& axis, VerifyReport& report) {
  const Rational per_revolution = axis.drift_per_line() * plan.rotary.lines_per_revolution;
  report.seam.reserve(size(report.revolutions));
  for (std::int64_t r = 0; r < report.revolutions; ++r) {
    SeamRow row;
    row.revolution = r;
    row.drift_lines = per_revolution * (r + 1);
    row.drift_um = to_double(Rational(row.drift_lines * plan.rotary.line_pitch_um));
    report.seam.push_back(std::move(row));
  }
  // It grows line by line, so the end of the last line is the worst place.
  report.seam_end_um = report.seam.empty() ? 0.0 : report.seam.back().drift_um;
  report.seam_max_um = std::fabs(report.seam_end_um);
  report.seam_worst_revolution = std::max<std::int64_t>(0, report.revolutions - 1);
  report.seam_worst_line = plan.rotary.lines_per_revolution - 1;
  report.seam_limit_um = to_double(plan.ab.seam_limit_um);
}

void judge(const Plan& plan, const AxisCheck& axis, const Tally& tally, VerifyReport& report) {
  const auto say = [&](const std::string& what) { report.violations.push_back(what); };
  if (tally.refused.count > 0) {
    say("the device refused " + place(plan, tally.refused.ordinal) + ": " + tally.refused.detail);
  }
  const std::int64_t lines = plan.job.revolutions * plan.rotary.lines_per_revolution;
  if (tally.lines != lines) {
    say(std::to_string(lines - tally.lines) + " of " + std::to_string(lines) + " lines were never executed");
  }
  if (tally.misplaced.count > 0) {
    say(std::to_string(tally.misplaced.count) + " lines in the wrong place, the first at " +
        place(plan, tally.misplaced.ordinal) + ": " + tally.misplaced.detail);
  }
  if (tally.off_axis.count > 0) {
    say("the axis stands wrong at " + std::to_string(tally.off_axis.count) + " line starts, the first at " +
        place(plan, tally.off_axis.ordinal) + ": " + tally.off_axis.detail);
  }
  if (!report.images_compared) {
    say("the images were not found, so nothing proves that the program shows them: give --images DIR");
  } else if (report.wrong_pixels > 0) {
    say(std::to_string(report.wrong_pixels) + " landed pixels differ from the images, the first at " +
        place(plan, tally.first_wrong_ordinal) + ", column " + std::to_string(tally.first_wrong_column));
  }
  const Rational limit_lines = plan.ab.seam_limit_um / plan.rotary.line_pitch_um;
  if (abs(Rational(axis.drift_per_line() * lines)) > limit_lines) {
    say("seam error of " + std::to_string(report.seam_max_um) +
        " um at the end of the job exceeds limits.seam_um = " + to_decimal_string(plan.ab.seam_limit_um) +
        ": set fpga.fractional, raise scanner.max_extra_slots, or see `gravure suggest`");
  }
}

}  // namespace

Result<VerifyReport> verify(const std::function<Result<std::unique_ptr<LineSource>>()>& programs,
                            const DeviceFactory& devices, const LayerLinesFactory& images,
                            const VerifyOptions& options) {
  GRAVURE_TRY(const std::unique_ptr<LineSource> program, programs());
  const ProgramHeader& header = program->header();
  const Plan& plan = header.plan;
  GRAVURE_TRY(const AxisCheck axis, AxisCheck::make(plan));
  Verifier verifier(header, program->lines_per_chunk(), axis, devices, options);
  GRAVURE_TRY(const Tally tally, verifier.run(programs, images));

  VerifyReport report;
  report.revolutions = plan.job.revolutions;
  report.lines = tally.lines;
  report.fired_pixels = tally.fired;
  report.pixels = plan.job.revolutions * plan.rotary.lines_per_revolution * plan.line.pixels;
  report.images_compared = static_cast<bool>(images);
  report.wrong_pixels = tally.wrong_pixels;
  if (tally.first_wrong_ordinal >= 0) {
    report.first_wrong_pixel =
        PixelPlace{tally.first_wrong_ordinal / plan.rotary.lines_per_revolution,
                   tally.first_wrong_ordinal % plan.rotary.lines_per_revolution, tally.first_wrong_column};
  }
  report.ticks = tally.end_tick;
  report.ab_step_um = axis.step_um();
  if (tally.worst_ordinal >= 0) {
    report.axis_error_max_um = std::fabs(tally.worst_edges) * axis.step_um();
    report.axis_worst_revolution = tally.worst_ordinal / plan.rotary.lines_per_revolution;
    report.axis_worst_line = tally.worst_ordinal % plan.rotary.lines_per_revolution;
  }
  fill_seam(plan, axis, report);
  judge(plan, axis, tally, report);
  return report;
}

}  // namespace gravure
