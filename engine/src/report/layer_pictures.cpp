#include "gravure/report/layer_pictures.hpp"

#include <algorithm>
#include <atomic>
#include <map>
#include <mutex>
#include <new>
#include <optional>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

#include "gravure/core/as_size.hpp"
#include "gravure/core/exposure_map.hpp"
#include "gravure/core/units.hpp"
#include "gravure/twin/unroll.hpp"
#include "seam_window.hpp"

namespace gravure::report {
namespace {

/// Images as (source, level), in the order in which unroll_layer() numbers them.
std::vector<std::pair<std::int64_t, std::int64_t>> images_of(const ProgramHeader& header) {
  std::vector<std::pair<std::int64_t, std::int64_t>> images;
  if (header.plan.carriage) {
    const bool depth_map = header.sources.size() == 1;  // a stack has a source for each layer
    for (std::int64_t layer = 0; layer < header.plan.carriage->layers; ++layer) {
      images.emplace_back(depth_map ? 0 : layer, depth_map ? layer : 0);
    }
    return images;
  }
  const std::int64_t layers = image_layers(header);  // not for each of them: it goes through all
  for (std::int64_t r = 0; r < layers; ++r) {
    const StoredLayer& stored = header.layers[header.layer_of_revolution[as_size(r)]];
    images.emplace_back(stored.source, stored.level);
  }
  return images;
}

/// `most` numbers of 0 .. count - 1, evenly, the first and the last among them.
std::vector<bool> evenly(std::int64_t count, std::int64_t most) {
  std::vector<bool> chosen(as_size(count), count <= most);
  for (std::int64_t i = 0; i < most && count > most; ++i) {
    chosen[as_size(most == 1 ? 0 : i * (count - 1) / (most - 1))] = true;
  }
  return chosen;
}

std::byte share_of(std::int64_t part, std::int64_t whole) {
  return static_cast<std::byte>((2 * 255 * part + whole) / (2 * whole));
}

using Programs = std::function<Result<std::unique_ptr<LineSource>>()>;

/// Makes the pictures of layers, several at a time, and adds them up.
class Work {
 public:
  Work(const ProgramHeader& header, const DeviceFactory& devices, const LayerPicturesOptions& options)
      : header_(header),
        devices_(devices),
        options_(options),
        images_(images_of(header)),
        end_(static_cast<std::int64_t>(images_.size())) {
    const auto layers = static_cast<std::int64_t>(images_.size());
    shown_layers_ = std::min({options.only_layer ? 1 : layers, options.most_shown_layers,
                              std::max<std::int64_t>(1, options.most_shown_cells)});
    shown_ = evenly(layers, shown_layers_);
    revolutions_ = exposures_of_images(header);
    if (options.only_layer) {
      next_ = *options.only_layer;
      end_ = next_ + 1;
      shown_.assign(shown_.size(), shown_layers_ > 0);
      revolutions_.assign(revolutions_.size(), 0);
      revolutions_[as_size(next_)] = 1;
    }
    plan_pictures(std::min(options.most_cells, options.most_shown_cells / std::max<std::int64_t>(1, shown_layers_)));
  }

  Result<LayerPictures> run(const Programs& programs, const LineSource& program) {
    GRAVURE_TRY(const std::int64_t count, divide_budget(program));
    begin_pictures();
    std::vector<std::thread> workers;
    workers.reserve(as_size(count));
    try {
      for (std::int64_t i = 1; i < count; ++i) {
        workers.emplace_back([&] { work(programs); });
      }
    } catch (const std::system_error&) {  // no more threads to be had: those there are do it
    } catch (const std::bad_alloc&) {     // nor memory for one
    }
    work(programs);
    for (std::thread& worker : workers) {
      worker.join();
    }
    if (out_of_memory_) {
      return Error{ErrorCode::io, "out of memory: lower --memory or --threads"};
    }
    if (error_) {
      return *error_;
    }
    return std::move(pictures_);
  }

 private:
  std::int64_t layers() const { return options_.only_layer ? 1 : end_; }

  /// What a worker holds beside what it unrolls: a row of cells, where its cells begin, and the seam.
  std::int64_t worker_bytes() const { return 16 * (pictures_.cells.width + 1) + pictures_.seam_extent().area() / 8; }
  /// The cells, whoever counts: pulses of all layers, shares of those that are shown.
  std::int64_t cell_bytes() const { return (8 + shown_layers_) * pictures_.cells.area(); }
  /// What all of them hold together beside the cells: sums along and across the line; pulses of the seam, again where
  /// craters are added up, and their depth; the layers themselves.
  std::int64_t shared_bytes() const {
    constexpr std::int64_t kLayer = 256;
    return options_.table_bytes + 32 * (pictures_.cells.width + pictures_.cells.height) +
           (24 + shown_layers_) * pictures_.seam_extent().area() + kLayer * static_cast<std::int64_t>(images_.size());
  }

  /// How many workers the budget holds; what each may take to unroll is in unroll_bytes_.
  Result<std::int64_t> divide_budget(const LineSource& program) {
    const std::int64_t once = shared_bytes() + cell_bytes();
    const std::int64_t each = worker_bytes() + least_unroll_bytes(program);
    const std::int64_t later =
        options_.later_bytes ? options_.later_bytes(pictures_.cells, pictures_.seam_extent(), shown_layers_) : 0;
    const std::int64_t least = once + std::max(each, later);
    if (options_.memory_bytes < least) {
      return Error{ErrorCode::out_of_range,
                   "memory budget of " + std::to_string(options_.memory_bytes / kMiB) +
                       " MiB: drawing this program in " + std::to_string(pictures_.cells.width) + " x " +
                       std::to_string(pictures_.cells.height) + " cells needs at least " +
                       std::to_string(whole_mib(least)) + " MiB, " + std::to_string(whole_mib(cell_bytes())) +
                       " of them for the cells and " + std::to_string(whole_mib(options_.table_bytes)) +
                       " for the tables of its chunks: " + options_.remedy};
    }
    constexpr std::int64_t kMostWorkers = 4;
    const std::int64_t wanted =
        options_.threads > 0 ? options_.threads : std::max<std::int64_t>(1, std::thread::hardware_concurrency());
    const std::int64_t all = options_.memory_bytes - once;
    const std::int64_t count = std::max<std::int64_t>(1, std::min({wanted, kMostWorkers, layers(), all / each}));
    unroll_bytes_ = all / count - worker_bytes() + options_.table_bytes;  // unrolling counts the tables itself
    return count;
  }

  void work(const Programs& programs) {
    try {
      work_on_layers(programs);
    } catch (const std::bad_alloc&) {  // to say so here would take memory
      out_of_memory_ = failed_ = true;
    }
  }

  void work_on_layers(const Programs& programs) {
    Result<std::unique_ptr<LineSource>> program = programs();
    if (!program) {
      fail(program.error());
      return;
    }
    for (std::int64_t layer = next_++; layer < end_ && !failed_; layer = next_++) {
      if (const Result<void> added = add(*program.value(), layer); !added) {
        fail(added.error());
      }
    }
  }

  void plan_pictures(std::int64_t most_cells) {
    const Plan& plan = header_.plan;
    const UnrolledSize size = unrolled_size(header_);
    pictures_.picture = {size.width, size.height};
    pictures_.lines_are_rows = header_.lines_along == LinesAlong::rows;
    const double pixel = to_double(plan.line.pixel_pitch_um);
    const double line = to_double(plan.rotary.line_pitch_um);
    pictures_.cells = choose_cells(pictures_.picture, pictures_.lines_are_rows ? pixel : line,
                                   pictures_.lines_are_rows ? line : pixel, most_cells);
    SeamPlace& seam = pictures_.seam_place;
    seam.columns = std::min(options_.most_seam_columns, image_columns(plan));
    seam.first_column = (image_columns(plan) - seam.columns) / 2;
    seam.lines_each = std::min(options_.most_seam_lines, plan.rotary.lines_per_revolution / 2);
  }

  void begin_pictures() {
    cell_widths_ = cell_sizes(pictures_.cells.width, pictures_.picture.width);
    cell_heights_ = cell_sizes(pictures_.cells.height, pictures_.picture.height);
    pictures_.pulses.assign(as_size(pictures_.cells.area()), 0);
    pictures_.seam_pulses.assign(as_size(pictures_.seam_extent().area()), 0);
    pictures_.layers.resize(images_.size());
    for (const std::int64_t revolutions : revolutions_) {
      pictures_.exposures += revolutions;
    }
  }

  Result<void> add(LineSource& program, std::int64_t layer) {
    LayerPicture& picture = pictures_.layers[as_size(layer)];
    picture.layer = layer;
    picture.source = images_[as_size(layer)].first;
    picture.level = images_[as_size(layer)].second;
    picture.revolutions = revolutions_[as_size(layer)];
    if (shown_[as_size(layer)]) {
      picture.shares.reserve(as_size(pictures_.cells.area()));
    }
    AreaCount count(pictures_.picture, pictures_.cells,
                    [&](std::int64_t row, std::span<const std::int64_t> ones) { keep(picture, row, ones); });
    SeamWindow seam(pictures_.picture, pictures_.seam_place, pictures_.lines_are_rows);
    UnrollOptions unroll_options;
    unroll_options.memory_bytes = unroll_bytes_;
    unroll_options.table_bytes = options_.table_bytes;
    unroll_options.cancel = options_.cancel;
    const RowSink sink = [&](std::span<const std::byte> rows, std::int64_t lines) -> Result<void> {
      GRAVURE_CHECK(count.add(rows, lines));
      seam.add(rows, lines);
      return {};
    };
    // The first revolutions show the images one after the other; unroll_layer() would go through all to know there is
    // such a one.
    GRAVURE_CHECK(header_.plan.carriage ? unroll_layer(program, devices_, layer, sink, unroll_options)
                                        : unroll(program, devices_, layer, sink, unroll_options));
    keep(picture, seam);
    return {};
  }

  void keep(LayerPicture& picture, std::int64_t row, std::span<const std::int64_t> ones) {
    const bool white = header_.fires == Fires::white;
    const bool shown = shown_[as_size(picture.layer)];
    const std::scoped_lock lock(mutex_);
    const auto pulses = std::span(pictures_.pulses).subspan(as_size(row) * ones.size(), ones.size());
    for (std::size_t column = 0; column < ones.size(); ++column) {
      const std::int64_t pixels = cell_widths_[column] * cell_heights_[as_size(row)];
      const std::int64_t fired = white ? ones[column] : pixels - ones[column];
      picture.fired_pixels += fired;
      pulses[column] += fired * picture.revolutions;
      if (shown) {
        picture.shares.push_back(share_of(fired, pixels));
      }
    }
  }

  void keep(LayerPicture& picture, const SeamWindow& seam) {
    const bool white = header_.fires == Fires::white;
    const std::scoped_lock lock(mutex_);
    for (std::size_t pixel = 0; pixel < seam.ones().size(); ++pixel) {
      const bool fired = seam.ones()[pixel] == white;
      pictures_.seam_pulses[pixel] += fired ? picture.revolutions : 0;
      if (shown_[as_size(picture.layer)]) {
        picture.seam.push_back(fired ? std::byte{255} : std::byte{0});
      }
    }
    if (options_.progress != nullptr) {
      options_.progress->update(++done_, layers());
    }
  }

  void fail(const Error& error) {
    const std::scoped_lock lock(mutex_);
    failed_ = true;
    if (!error_) {
      error_ = error;
    }
  }

  const ProgramHeader& header_;
  const DeviceFactory& devices_;
  const LayerPicturesOptions& options_;
  std::vector<std::pair<std::int64_t, std::int64_t>> images_;
  std::int64_t end_;  ///< after the last layer that is made
  std::int64_t shown_layers_ = 0;
  std::vector<bool> shown_;
  std::vector<std::int64_t> revolutions_;
  std::int64_t unroll_bytes_ = 0;  ///< of each worker
  LayerPictures pictures_;
  std::vector<std::int64_t> cell_widths_;  ///< in pixels
  std::vector<std::int64_t> cell_heights_;
  std::atomic<std::int64_t> next_ = 0;
  std::atomic<bool> failed_ = false;
  std::atomic<bool> out_of_memory_ = false;
  std::mutex mutex_;  ///< of what follows, and of the pictures
  std::int64_t done_ = 0;
  std::optional<Error> error_;
};

/// Sums of the cells of each column along the line.
void add_columns(LayerPictures& pictures) {
  const std::vector<std::int64_t> widths = cell_sizes(pictures.cells.width, pictures.picture.width);
  const std::vector<std::int64_t> heights = cell_sizes(pictures.cells.height, pictures.picture.height);
  const Extent& cells = pictures.cells;
  const std::int64_t columns = pictures.lines_are_rows ? cells.width : cells.height;
  pictures.column_pulses.assign(as_size(columns), 0);
  pictures.column_pixels.assign(as_size(columns), 0);
  for (std::int64_t cell = 0; cell < cells.area(); ++cell) {
    const std::size_t x = as_size(cell % cells.width);
    const std::size_t y = as_size(cell / cells.width);
    const std::size_t column = pictures.lines_are_rows ? x : y;
    pictures.column_pulses[column] += pictures.pulses[as_size(cell)];
    pictures.column_pixels[column] += widths[x] * heights[y];
  }
}

}  // namespace

std::vector<std::int64_t> exposures_of_images(const ProgramHeader& header) {
  const auto images = images_of(header);
  if (header.plan.carriage) {
    return std::vector<std::int64_t>(images.size(), 1);  // every column gets every layer once
  }
  std::map<std::pair<std::int64_t, std::int64_t>, std::int64_t> revolutions;
  for (std::int64_t r = 0; r < revolutions_per_band(header.plan); ++r) {
    const StoredLayer& stored = header.layers[header.layer_of_revolution[as_size(r)]];
    ++revolutions[{stored.source, stored.level}];
  }
  std::vector<std::int64_t> each;
  each.reserve(images.size());
  for (const auto& image : images) {
    each.push_back(revolutions[image]);
  }
  return each;
}

Result<LayerPictures> layer_pictures(const std::function<Result<std::unique_ptr<LineSource>>()>& programs,
                                     const DeviceFactory& devices, const LayerPicturesOptions& options) {
  GRAVURE_TRY(const std::unique_ptr<LineSource> program, programs());
  const ProgramHeader& header = program->header();
  const std::int64_t layers = image_layers(header);
  if (options.only_layer && (*options.only_layer < 0 || *options.only_layer >= layers)) {
    return Error{ErrorCode::out_of_range, "--layer " + std::to_string(*options.only_layer) + ": the program has 0 to " +
                                              std::to_string(layers - 1)};
  }
  GRAVURE_TRY(LayerPictures pictures, Work(header, devices, options).run(programs, *program));
  add_columns(pictures);
  return pictures;
}

}  // namespace gravure::report
