#include "gravure/pipeline/compile.hpp"

#include <algorithm>
#include <atomic>
#include <memory>
#include <mutex>
#include <new>
#include <numeric>
#include <string>
#include <system_error>
#include <thread>

#include "column_spill.hpp"
#include "gravure/core/units.hpp"
#include "gravure/pipeline/stored_order.hpp"
#include "gravure/pipeline/window_reader.hpp"
#include "gravure/raster/place.hpp"
#include "ordered_writer.hpp"

namespace gravure {
namespace {

/// What one worker does at a stretch: some chunks, of one layer or of several.
struct Task {
  std::int64_t first_layer;
  std::int64_t layers;
  std::int64_t first_chunk;
  std::int64_t chunks;
};

struct Geometry {
  std::int64_t layers;
  std::int64_t lines;
  std::int64_t line_bytes;
  std::int64_t lines_per_chunk;
  std::int64_t chunks_per_layer() const { return (lines + lines_per_chunk - 1) / lines_per_chunk; }
  std::int64_t lines_of(std::int64_t chunk) const { return std::min(lines_per_chunk, lines - chunk * lines_per_chunk); }
};

struct Budget {
  int threads;
  std::int64_t panel_bytes;
  std::int64_t ahead_bytes;
};

/// Chunks of rows, of a file that reads in any order, which a worker takes together. The strip that lies across two
/// such groups is decoded by two workers, so groups are large beside strips; but there are enough of them for all
/// workers to end together, and what waits for its turn in the writer has room there.
std::int64_t chunks_at_once(const LayerStack& stack, const Geometry& geometry, const Budget& budget) {
  constexpr std::int64_t kGroupsAWorker = 4;
  constexpr std::int64_t kStrips = 8;  // decoded for each one that is decoded twice
  if (budget.threads == 1) {
    return 1;
  }
  const auto parts_of = [](std::int64_t whole, std::int64_t part) { return (whole + part - 1) / part; };
  const std::int64_t groups_a_layer =
      std::max<std::int64_t>(1, kGroupsAWorker * budget.threads / std::max<std::int64_t>(1, geometry.layers));
  const std::int64_t many = kStrips * parts_of(stack.rows_per_block, geometry.lines_per_chunk);
  const std::int64_t waiting = budget.ahead_bytes / (budget.threads * geometry.lines_per_chunk * geometry.line_bytes);
  return std::max<std::int64_t>(1, std::min({parts_of(geometry.chunks_per_layer(), groups_a_layer), many, waiting}));
}

/// Layers are walked as interleaves_layers() says: those of one map, and helical revolutions, share their decoding.
/// Files that only read forwards, and panels of columns, keep as many chunks together as one pass over the file yields.
/// The order in which chunks are written follows from the images alone, never from the budget or the number of workers.
class TaskList {
 public:
  TaskList(const ProgramHeader& header, const LayerStack& stack, const Geometry& geometry, const Budget& budget)
      : geometry_(geometry), by_chunks_(interleaves_layers(header)) {
    const std::int64_t all = geometry.chunks_per_layer();
    const std::int64_t lines_per_pass = LayerReader::lines_per_pass(stack, budget.panel_bytes);
    // A panel starts at a whole byte, up to 7 lines before the first one asked for.
    const std::int64_t fit = stack.lines_along == LinesAlong::columns ? lines_per_pass - 7 : lines_per_pass;
    const std::int64_t least = stack.lines_along == LinesAlong::rows ? chunks_at_once(stack, geometry, budget) : 1;
    group_ = lines_per_pass >= geometry.lines
                 ? all
                 : std::clamp<std::int64_t>(std::max(least, fit / geometry.lines_per_chunk), 1, all);
    group_ = by_chunks_ ? 1 : group_;
    groups_ = (all + group_ - 1) / group_;
  }
  std::int64_t size() const { return by_chunks_ ? groups_ : groups_ * geometry_.layers; }
  Task at(std::int64_t ticket) const {
    const std::int64_t group = by_chunks_ ? ticket : ticket % groups_;
    const std::int64_t first = group * group_;
    const std::int64_t chunks = std::min(group_, geometry_.chunks_per_layer() - first);
    return by_chunks_ ? Task{0, geometry_.layers, first, chunks} : Task{ticket / groups_, 1, first, chunks};
  }

 private:
  Geometry geometry_;
  bool by_chunks_;
  std::int64_t group_;
  std::int64_t groups_;
};

/// Everything one worker holds beside its panel and what waits in the writer.
std::int64_t worker_bytes(const ReaderNeeds& needs, std::int64_t lines_per_chunk) {
  constexpr std::int64_t kCodec = 3 * kMiB;  // what packs a chunk, and the thread itself
  return 4 * lines_per_chunk * needs.line_bytes + kCodec + needs.fixed_bytes;  // as read, placed, packed twice
}

/// What a worker must have: its panel is three quarters of what it has to spare.
std::int64_t least_worker_bytes(const ReaderNeeds& needs, std::int64_t lines_per_chunk) {
  return worker_bytes(needs, lines_per_chunk) + needs.least_panel_bytes * 4 / 3;
}

/// What the program takes once, whoever writes it: the tables of its chunks, the library of its format.
std::int64_t program_bytes(std::int64_t layers, std::int64_t lines, std::int64_t lines_per_chunk) {
  constexpr std::int64_t kLibrary = 2 * kMiB;
  constexpr std::int64_t kTablesPerChunk = 64;
  const std::int64_t chunks = (lines + lines_per_chunk - 1) / std::max<std::int64_t>(1, lines_per_chunk);
  return kLibrary + kTablesPerChunk * chunks * layers;
}

Result<Budget> divide_budget(const Plan& plan, const LayerStack& stack, const Geometry& geometry,
                             const CompileOptions& options) {
  const ReaderNeeds needs = reader_needs(plan, stack, geometry.lines_per_chunk);
  const std::int64_t once = program_bytes(geometry.layers, geometry.lines, geometry.lines_per_chunk);
  const std::int64_t least = once + least_worker_bytes(needs, geometry.lines_per_chunk);
  if (options.memory_bytes < least) {
    const std::int64_t decoder = stack.decoder_bytes.value_or(0);
    std::string remedy = ": raise --memory";
    if (decoder > least / 2) {
      remedy =
          ", " + std::to_string(whole_mib(decoder)) +
          " MiB of them to decode the largest strip or row of tiles: raise --memory, or rewrite TIFF files in small "
          "strips with `tiffcp -s -r 64`";
    }
    return Error{ErrorCode::out_of_range, "memory budget of " + std::to_string(options.memory_bytes / kMiB) +
                                              " MiB: these images need at least " + std::to_string(whole_mib(least)) +
                                              " MiB" + remedy};
  }
  const int wanted = options.threads > 0 ? options.threads : static_cast<int>(std::thread::hardware_concurrency());
  const std::int64_t workers_bytes = options.memory_bytes - once;
  const std::int64_t fit = workers_bytes / least_worker_bytes(needs, geometry.lines_per_chunk);
  Budget budget{};
  budget.threads = static_cast<int>(std::clamp<std::int64_t>(wanted, 1, fit));
  const std::int64_t spare = workers_bytes - budget.threads * worker_bytes(needs, geometry.lines_per_chunk);
  budget.ahead_bytes = spare / 4;
  budget.panel_bytes = (spare - budget.ahead_bytes) / budget.threads;
  return budget;
}

class Compiler {
 public:
  Compiler(ProgramHeader& header, const LayerStack& stack, const ImageOpener& opener, LineSink& sink,
           const CompileOptions& options, const Geometry& geometry, const Budget& budget)
      : header_(header),
        stack_(stack),
        opener_(opener),
        sink_(sink),
        options_(options),
        geometry_(geometry),
        budget_(budget),
        tasks_(header, stack, geometry, budget),
        writer_(sink, budget.ahead_bytes) {}

  Result<void> run() {
    std::vector<std::thread> workers;
    const auto count = static_cast<int>(std::min<std::int64_t>(budget_.threads, tasks_.size()));
    try {
      for (int i = 1; i < count; ++i) {
        workers.emplace_back([this] { work(); });
      }
    } catch (const std::system_error&) {  // no more threads to be had: those there are do it
    }
    work();
    for (std::thread& worker : workers) {
      worker.join();
    }
    if (const std::optional<Error> error = writer_.error()) {
      return *error;
    }
    return {};
  }

 private:
  void work() {
    try {
      work_on_tickets();
    } catch (const std::bad_alloc&) {
      writer_.fail({ErrorCode::io, "out of memory: lower --memory or --threads"});
    }
  }

  void work_on_tickets() {
    const std::unique_ptr<LayerLines> reader = make_layer_lines(header_, stack_, opener_, budget_.panel_bytes);
    reader->stop_when([this] { return go_on(); });
    const std::size_t bytes = static_cast<std::size_t>(geometry_.lines_per_chunk * geometry_.line_bytes);
    const auto buffers = std::make_unique_for_overwrite<std::byte[]>(2 * bytes);
    const std::span<std::byte> read(buffers.get(), bytes);
    const std::span<std::byte> placed(buffers.get() + bytes, bytes);
    while (true) {
      const std::int64_t ticket = next_.fetch_add(1);
      if (ticket >= tasks_.size() || !run_task(tasks_.at(ticket), ticket, *reader, read, placed)) {
        return;
      }
    }
  }

  bool run_task(const Task& task, std::int64_t ticket, LayerLines& reader, std::span<std::byte> read,
                std::span<std::byte> placed) {
    for (std::int64_t chunk = task.first_chunk; chunk < task.first_chunk + task.chunks; ++chunk) {
      for (std::int64_t layer = task.first_layer; layer < task.first_layer + task.layers; ++layer) {
        Result<StoredChunk> stored = make_chunk({layer, chunk}, reader, read, placed);
        if (!stored) {
          writer_.fail(stored.error());
          return false;
        }
        count(layer, chunk, stored.value().fired_pixels);
        if (!writer_.put(ticket, std::move(stored).value())) {
          return false;
        }
      }
    }
    return writer_.close(ticket);
  }

  /// Asked before every chunk, and by the readers while they collect columns.
  Result<void> go_on() const {
    if (options_.cancel != nullptr && options_.cancel->cancelled()) {
      return Error{ErrorCode::cancelled, "stopped before the program was complete; nothing was written"};
    }
    if (writer_.failed()) {
      return Error{ErrorCode::cancelled, "stopped by the error of another worker"};  // which is the one that is told
    }
    return {};
  }

  Result<StoredChunk> make_chunk(ChunkAddress address, LayerLines& reader, std::span<std::byte> read,
                                 std::span<std::byte> placed) {
    GRAVURE_CHECK(go_on());
    const std::int64_t first = address.chunk * geometry_.lines_per_chunk;
    const std::int64_t lines = geometry_.lines_of(address.chunk);
    const auto bytes = static_cast<std::size_t>(lines * geometry_.line_bytes);
    GRAVURE_TRY(const bool invert, reader.read_lines(address.layer, first, lines, read.first(bytes)));
    const bool bidirectional = header_.plan.line.bidirectional;
    const bool starts_reverse = header_.layers[static_cast<std::size_t>(address.layer)].starts_reverse;
    raster::place_rows(placed.first(bytes), read.first(bytes), header_.plan.line.pixels, lines,
                       {.invert = invert,
                        .first_mirrored = bidirectional && (starts_reverse != ((first & 1) != 0)),
                        .alternate = bidirectional});
    return sink_.encode(address, placed.first(bytes));
  }

  void count(std::int64_t layer, std::int64_t chunk, std::int64_t fired) {
    const std::lock_guard lock(count_mutex_);
    header_.layers[static_cast<std::size_t>(layer)].fired_pixels += fired;
    done_ += geometry_.lines_of(chunk);
    if (options_.progress != nullptr) {
      options_.progress->update(done_, geometry_.layers * geometry_.lines);
    }
  }

  ProgramHeader& header_;
  const LayerStack& stack_;
  const ImageOpener& opener_;
  LineSink& sink_;
  const CompileOptions& options_;
  const Geometry geometry_;
  const Budget budget_;
  const TaskList tasks_;
  OrderedWriter writer_;
  std::atomic<std::int64_t> next_{0};
  std::mutex count_mutex_;
  std::int64_t done_ = 0;
};

}  // namespace

std::int64_t least_compile_memory(const LayerStack& stack, std::int64_t lines_per_chunk) {
  const ReaderNeeds needs = reader_needs(Plan{}, stack, lines_per_chunk);
  return program_bytes(static_cast<std::int64_t>(stack.layers.size()), stack.lines, lines_per_chunk) +
         least_worker_bytes(needs, lines_per_chunk);
}

Result<ProgramHeader> compile(ProgramHeader header, const LayerStack& given, const ImageOpener& opener, LineSink& sink,
                              const CompileOptions& options) {
  LayerStack stack = given;
  if (!stack.decoder_bytes) {
    learn_images(stack, opener);
    stack.samples = given.samples;  // what the plan was made with; a file that differs now is refused when it is read
    stack.random_access = given.random_access;
  }
  const Geometry geometry{static_cast<std::int64_t>(header.layers.size()), stack.lines, header.line_bytes(),
                          sink.lines_per_chunk()};
  if (!stack.spills) {
    stack.spills = std::make_shared<ColumnSpills>();
  }
  GRAVURE_TRY(const Budget budget, divide_budget(header.plan, stack, geometry, options));
  for (StoredLayer& layer : header.layers) {
    layer.fired_pixels = 0;
  }
  GRAVURE_CHECK(Compiler(header, stack, opener, sink, options, geometry, budget).run());
  if (options.complete_header) {
    GRAVURE_CHECK(options.complete_header(header));
  }
  GRAVURE_CHECK(sink.finish(header));
  return header;
}

}  // namespace gravure
