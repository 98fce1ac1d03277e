#include "gravure/twin/verify.hpp"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <mutex>
#include <new>
#include <system_error>
#include <thread>

#include "axis_check.hpp"
#include "gravure/core/as_size.hpp"
#include "gravure/core/spin_phase.hpp"
#include "gravure/core/units.hpp"
#include "gravure/raster/count.hpp"
#include "judge.hpp"
#include "judge_budget.hpp"
#include "tally.hpp"

namespace gravure {
namespace {

constexpr std::int64_t kReportBytes = 256;  // of each revolution: its row of the seam table

/// The layers cut from one source image, and the revolutions that expose each.
struct Group {
  std::vector<std::int64_t> layers;
};

class Verifier {
 public:
  Verifier(const ProgramHeader& header, std::int64_t lines_per_chunk, const AxisChecks& axes,
           const DeviceFactory& devices, const VerifyOptions& options)
      : header_(header),
        plan_(header.plan),
        lines_per_chunk_(lines_per_chunk),
        axes_(axes),
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
    GRAVURE_TRY(const std::int64_t count, divide_budget(images));
    std::vector<std::thread> workers;
    try {
      for (std::int64_t i = 1; i < count; ++i) {
        workers.emplace_back([&] { work(programs, images); });
      }
    } catch (const std::system_error&) {  // no more threads to be had: those there are do it
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

  /// How many workers that only read the program the budget holds beside each other, of those that are wanted.
  int reading_threads() const {
    const std::int64_t fit = (options_.memory_bytes - shared_bytes()) / worker_bytes();
    return static_cast<int>(std::clamp<std::int64_t>(fit, 1, wanted_threads()));
  }

 private:
  class Worker;
  friend class Worker;

  /// What a worker holds beside what reads the images: a chunk as stored, unpacked, turned, fired, landed and as the
  /// image has it, once more while its last one is unpacked; its library and codec.
  std::int64_t worker_bytes() const {
    constexpr std::int64_t kLibrary = std::int64_t{6} << 20;
    return kLibrary + 7 * lines_per_chunk_ * header_.line_bytes();
  }
  /// What all of them hold together: the program's header and tables, and what is reported of revolutions.
  std::int64_t shared_bytes() const {
    const auto layers = static_cast<std::int64_t>(header_.layers.size());
    return options_.table_bytes + 128 * layers + (kReportBytes + 4) * plan_.job.revolutions;
  }

  int wanted_threads() const {
    return options_.threads > 0 ? options_.threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  }

  /// How many workers the budget holds; their share for images is in image_bytes_.
  Result<std::int64_t> divide_budget(const LayerLinesFactory& images) {
    std::int64_t image_bytes = 0;
    if (images) {
      GRAVURE_TRY(const std::unique_ptr<LayerLines> reader, images());
      image_bytes = reader->least_memory_bytes(lines_per_chunk_);
    }
    const std::int64_t all = options_.memory_bytes - shared_bytes();
    const std::int64_t each = worker_bytes() + image_bytes;
    if (all < each) {
      return Error{
          ErrorCode::out_of_range,
          "memory budget of " + std::to_string(options_.memory_bytes / kMiB) +
              " MiB: verifying this program needs at least " + std::to_string(whole_mib(shared_bytes() + each)) +
              " MiB, " + std::to_string(whole_mib(image_bytes)) + " of them to read its images and " +
              std::to_string(whole_mib(options_.table_bytes)) + " for the tables of its chunks: raise --memory"};
    }
    const std::int64_t tasks = std::max<std::int64_t>(1, static_cast<std::int64_t>(groups_.size()) * chunks_);
    const std::int64_t count = std::clamp<std::int64_t>(std::min<std::int64_t>(wanted_threads(), all / each), 1, tasks);
    image_bytes_ = all / count - worker_bytes();
    return count;
  }

  void work(const std::function<Result<std::unique_ptr<LineSource>>()>& programs, const LayerLinesFactory& images) {
    try {
      work_on_tickets(programs, images);
    } catch (const std::bad_alloc&) {
      fail({ErrorCode::io, "out of memory: lower --memory or --threads"});
    }
  }
  void work_on_tickets(const std::function<Result<std::unique_ptr<LineSource>>()>& programs,
                       const LayerLinesFactory& images);

  void fail(const Error& error) {
    const std::lock_guard lock(mutex_);
    if (!error_) {
      error_ = error;
    }
    stop_ = true;
  }

  /// Asked before every revolution of a chunk, and by the readers of images while they collect columns.
  Result<void> go_on() const {
    if (options_.cancel != nullptr && options_.cancel->cancelled()) {
      return Error{ErrorCode::cancelled, "stopped before everything was verified"};
    }
    if (stop_) {
      return Error{ErrorCode::cancelled, "stopped by the error of another worker"};  // which is the one that is told
    }
    return {};
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
  const AxisChecks& axes_;
  const DeviceFactory& devices_;
  const VerifyOptions& options_;
  std::vector<std::vector<std::int64_t>> revolutions_of_;
  std::vector<Group> groups_;
  std::int64_t chunks_ = 0;
  std::int64_t image_bytes_ = 0;  ///< for what reads the images, each worker
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
    see_axis(parent_.axes_.cross_scan, line, line.axis_at_start, tally_.axis);
    if (parent_.axes_.carriage) {
      see_axis(*parent_.axes_.carriage, line, line.carriage_at_start, tally_.carriage);
    }
    if (!landing_.take(line) || !in_time) {
      tally_.misplaced.add(line.ordinal, "the line came at another time or in another window than planned");
    }
  }

  Result<void> run_task(const Group& group, std::int64_t chunk) {
    for (const std::int64_t layer : group.layers) {
      if (parent_.revolutions_of_[as_size(layer)].empty()) {
        continue;
      }
      GRAVURE_CHECK(chunk_.load(*program_, {layer, chunk}));
      GRAVURE_CHECK(load_image(layer, chunk));
      for (const std::int64_t revolution : parent_.revolutions_of_[as_size(layer)]) {
        GRAVURE_CHECK(parent_.go_on());
        run_chunk(revolution);
        parent_.done(chunk_.lines());
      }
    }
    return {};
  }

  const Tally& tally() const { return tally_; }

 private:
  /// An image that cannot be read is reported, and everything else verified all the same; a disk that fails ends it.
  Result<void> load_image(std::int64_t layer, std::int64_t chunk) {
    comparable_ = false;
    if (!images_) {
      return {};
    }
    image_.resize(as_size(chunk_.lines() * header_.line_bytes()));
    const Result<bool> invert = images_->read_lines(layer, chunk_.first_line(), chunk_.lines(), image_);
    if (!invert && invert.error().code == ErrorCode::io) {
      return invert.error();
    }
    if (!invert) {
      GRAVURE_CHECK(parent_.go_on());  // stopped, not damaged
      const auto revolutions = static_cast<std::int64_t>(parent_.revolutions_of_[as_size(layer)].size());
      tally_.unread[layer].add(chunk, revolutions * chunk_.lines(), invert.error().message);
      return {};
    }
    invert_ = invert.value();
    comparable_ = true;
    return {};
  }

  void run_chunk(std::int64_t revolution) {
    first_ordinal_ = revolution * plan_.rotary.lines_per_revolution + chunk_.first_line();
    landing_.start(chunk_.lines());
    Result<void> sent = device_->configure(device_setup(plan_, revolution, chunk_.first_line()));
    if (sent) {
      see_spin_up();
      sent = chunk_.send(header_, revolution, *device_);
    }
    see_end();
    if (!sent) {
      tally_.refused.add(first_ordinal_ + landing_.lines(), sent.error().message);
      device_ = parent_.devices_(*this);  // the fault is sticky: go on with a fresh one to see what else is wrong
    }
    if (comparable_) {
      compare(revolution);
    }
  }

  void see_axis(const AxisCheck& check, const ExecutedLine& line, const AxisState& state, AxisTally& tally) {
    tally.see(check.error_edges(line.ordinal, state), line.ordinal);
    const std::int64_t expected = check.edges_in_run(line.ordinal, line.start_tick);
    if (state.edges != expected) {
      tally.wrong.add(line.ordinal, edges_text(state.edges, expected));
    }
    const std::int64_t lost_from = check.first_misplaced_line();
    if (lost_from >= 0 && line.ordinal % check.lines_per_run() >= lost_from) {
      tally_.misplaced.add(line.ordinal, std::string("the ") + check.name() + " is half a line or more away");
    }
  }

  void see_axis_end(const AxisCheck& check, const DeviceStatus& status, const AxisState& state,
                    const std::optional<AxisState>& rest, std::int64_t last_ordinal, AxisTally& tally) {
    const std::int64_t expected = check.edges_in_run(last_ordinal, status.tick);
    if (state.edges != expected) {
      tally.wrong.add(last_ordinal, "at its end " + edges_text(state.edges, expected));
    }
    if ((last_ordinal + 1) % check.lines_per_run() == 0) {
      see_rest(check, rest, last_ordinal, tally);
    }
    if (status.tick == plan_.job.ticks) {
      tally.end_edges = state.edges;
    }
  }

  /// Where the spin-down after a run has left an axis.
  static void see_rest(const AxisCheck& check, const std::optional<AxisState>& rest, std::int64_t last_ordinal,
                       AxisTally& tally) {
    const std::optional<Integer> expected = check.rest_counts(last_ordinal);
    if (rest.has_value() != expected.has_value()) {
      tally.wrong.add(last_ordinal, rest ? "after it the device spins down, the plan does not"
                                         : "after it the device does not come to rest as the plan has it");
    } else if (rest && counts_of(*rest) != *expected) {
      tally.wrong.add(last_ordinal, "after it the device is at rest " + to_string(counts_of(*rest)) +
                                        " counts from where the run began at rest, by the plan " +
                                        to_string(*expected));
    }
  }

  /// Where the schedules from rest have brought the axes at the first line of the run.
  void see_spin_up() {
    const DeviceStatus status = device_->status();
    const auto see = [&](const AxisCheck& check, const AxisState& state, AxisTally& tally) {
      if (const Integer expected = check.spun_up_counts(first_ordinal_); counts_of(state) != expected) {
        tally.wrong.add(first_ordinal_ - first_ordinal_ % check.lines_per_run(),
                        "the spin-up ends after " + to_string(counts_of(state)) + " counts, the plan's after " +
                            to_string(expected));
      }
    };
    see(parent_.axes_.cross_scan, status.axis_spun_up, tally_.axis);
    if (parent_.axes_.carriage) {
      see(*parent_.axes_.carriage, status.carriage_spun_up, tally_.carriage);
    }
  }

  /// What the device says of itself between two chunks: the time, and where the axes stand.
  void see_end() {
    const DeviceStatus status = device_->status();
    tally_.end_tick = std::max(tally_.end_tick, status.tick);
    const std::int64_t end_ordinal = first_ordinal_ + chunk_.lines();
    if (status.tick != end_ordinal * plan_.line.ticks) {
      return;  // refused or lost lines are said elsewhere
    }
    see_axis_end(parent_.axes_.cross_scan, status, status.axis, status.axis_at_rest, end_ordinal - 1, tally_.axis);
    if (parent_.axes_.carriage) {
      see_axis_end(*parent_.axes_.carriage, status, status.carriage, status.carriage_at_rest, end_ordinal - 1,
                   tally_.carriage);
    }
  }

  void compare(std::int64_t revolution) {
    const std::int64_t bytes = header_.line_bytes();
    const std::span<const std::byte> landed =
        landing_.turn_back(chunk_.first_line(), line_is_reverse(plan_, revolution, 0), invert_);
    const unsigned unused = static_cast<unsigned>(bytes * 8 - plan_.line.pixels);
    const auto mask = static_cast<std::byte>(0xFFU << unused);
    for (std::int64_t i = 0; i < chunk_.lines(); ++i) {
      const std::span<std::byte> image = std::span(image_).subspan(as_size(i * bytes), as_size(bytes));
      image.back() &= mask;
      if (i >= landing_.lines()) {  // never came
        tally_.wrong_pixels += plan_.line.pixels;
        tally_.see_wrong(first_ordinal_ + i, 0);
        continue;
      }
      const std::span<const std::byte> line = landed.subspan(as_size(i * bytes), as_size(bytes));
      if (std::memcmp(line.data(), image.data(), as_size(bytes)) != 0) {
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
  bool comparable_ = false;  // image_ holds the lines of the chunk
  bool invert_ = false;
  std::int64_t first_ordinal_ = 0;
  std::unique_ptr<LineDevice> device_;
};

void Verifier::work_on_tickets(const std::function<Result<std::unique_ptr<LineSource>>()>& programs,
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
    reader->grant_memory(lines_per_chunk_, image_bytes_);
    reader->stop_when([this] { return go_on(); });
  }
  Worker worker(*this, std::move(program).value(), std::move(reader));
  const std::int64_t tasks = static_cast<std::int64_t>(groups_.size()) * chunks_;
  for (std::int64_t ticket = next_.fetch_add(1); ticket < tasks && !stop_; ticket = next_.fetch_add(1)) {
    if (Result<void> ran = worker.run_task(groups_[as_size(ticket / chunks_)], ticket % chunks_); !ran) {
      return fail(ran.error());
    }
  }
  const std::lock_guard lock(mutex_);
  tally_.merge(worker.tally());
}

/// What the workers take for granted; a reader of files has checked it, another source may not have.
Result<void> check_header(const ProgramHeader& header) {
  const bool fits = header.layer_of_revolution.size() == as_size(header.plan.job.revolutions) &&
                    std::all_of(header.layer_of_revolution.begin(), header.layer_of_revolution.end(),
                                [&](std::uint32_t layer) { return layer < header.layers.size(); });
  if (!fits || header.plan.rotary.lines_per_revolution < 1 || header.plan.line.pixels < 1) {
    return Error{ErrorCode::bad_file, "the program's header names revolutions, layers or lines it does not have"};
  }
  return {};
}

}  // namespace

Result<VerifyReport> verify(const std::function<Result<std::unique_ptr<LineSource>>()>& programs,
                            const DeviceFactory& devices, const LayerLinesFactory& images,
                            const VerifyOptions& options) {
  GRAVURE_TRY(const std::unique_ptr<LineSource> program, programs());
  const ProgramHeader& header = program->header();
  const Plan& plan = header.plan;
  GRAVURE_CHECK(check_header(header));
  GRAVURE_TRY(const AxisChecks axes, AxisChecks::make(plan));
  Verifier verifier(header, program->lines_per_chunk(), axes, devices, options);
  GRAVURE_TRY(const Tally tally, verifier.run(programs, images));
  VerifyReport report = judge(plan, axes, tally, static_cast<bool>(images));
  const std::optional<scan::JobTrajectory> trajectory = judge_scanner(header, report);
  if (options.budget) {
    VerifyOptions judged = options;
    judged.threads = verifier.reading_threads();
    GRAVURE_CHECK(judge_budget(programs, trajectory, judged, report));
  }
  return report;
}

}  // namespace gravure
