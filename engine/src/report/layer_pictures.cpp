#include "gravure/report/layer_pictures.hpp"

#include <algorithm>
#include <atomic>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "gravure/core/as_size.hpp"
#include "gravure/core/exposure_map.hpp"
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
  for (std::int64_t r = 0; r < image_layers(header); ++r) {
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
    const std::int64_t shown =
        options.only_layer
            ? 1
            : std::min({layers, options.most_shown_layers, std::max<std::int64_t>(1, options.most_shown_cells)});
    shown_ = evenly(layers, shown);
    revolutions_ = exposures_of_images(header);
    if (options.only_layer) {
      next_ = *options.only_layer;
      end_ = next_ + 1;
      shown_.assign(shown_.size(), true);
      revolutions_.assign(revolutions_.size(), 0);
      revolutions_[as_size(next_)] = 1;
    }
    plan_pictures(std::min(options.most_cells, options.most_shown_cells / shown));
  }

  std::int64_t layers() const { return options_.only_layer ? 1 : end_; }
  void run(const std::function<Result<std::unique_ptr<LineSource>>()>& programs, std::int64_t memory_bytes) {
    Result<std::unique_ptr<LineSource>> program = programs();
    if (!program) {
      fail(program.error());
      return;
    }
    for (std::int64_t layer = next_++; layer < end_ && !failed_; layer = next_++) {
      if (const Result<void> added = add(*program.value(), layer, memory_bytes); !added) {
        fail(added.error());
      }
    }
  }
  Result<LayerPictures> take() {
    if (error_) {
      return *error_;
    }
    return std::move(pictures_);
  }

 private:
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
    const AreaCount empty(pictures_.picture, pictures_.cells);
    for (std::int64_t row = 0; row < pictures_.cells.height; ++row) {
      for (std::int64_t column = 0; column < pictures_.cells.width; ++column) {
        pictures_.pixels.push_back(empty.pixels_of(column, row));
      }
    }
    pictures_.pulses.assign(pictures_.pixels.size(), 0);
    pictures_.seam_pulses.assign(as_size(pictures_.seam_extent().area()), 0);
    pictures_.layers.resize(images_.size());
    for (const std::int64_t revolutions : revolutions_) {
      pictures_.exposures += revolutions;
    }
  }

  Result<void> add(LineSource& program, std::int64_t layer, std::int64_t memory_bytes) {
    AreaCount count(pictures_.picture, pictures_.cells);
    SeamWindow seam(pictures_.picture, pictures_.seam_place, pictures_.lines_are_rows);
    UnrollOptions unroll_options;
    unroll_options.memory_bytes = memory_bytes;
    unroll_options.table_bytes = options_.table_bytes;
    unroll_options.cancel = options_.cancel;
    const RowSink sink = [&](std::span<const std::byte> rows, std::int64_t lines) -> Result<void> {
      GRAVURE_CHECK(count.add(rows, lines));
      seam.add(rows, lines);
      return {};
    };
    GRAVURE_CHECK(unroll_layer(program, devices_, layer, sink, unroll_options));
    keep(layer, count, seam);
    return {};
  }

  void keep(std::int64_t layer, const AreaCount& count, const SeamWindow& seam) {
    const bool white = header_.fires == Fires::white;
    const std::scoped_lock lock(mutex_);
    LayerPicture& picture = pictures_.layers[as_size(layer)];
    picture.layer = layer;
    picture.source = images_[as_size(layer)].first;
    picture.level = images_[as_size(layer)].second;
    picture.revolutions = revolutions_[as_size(layer)];
    for (std::size_t cell = 0; cell < pictures_.pixels.size(); ++cell) {
      const std::int64_t fired = white ? count.ones()[cell] : pictures_.pixels[cell] - count.ones()[cell];
      picture.fired_pixels += fired;
      pictures_.pulses[cell] += fired * picture.revolutions;
      if (shown_[as_size(layer)]) {
        picture.shares.push_back(share_of(fired, pictures_.pixels[cell]));
      }
    }
    for (std::size_t pixel = 0; pixel < seam.ones().size(); ++pixel) {
      const bool fired = seam.ones()[pixel] == white;
      pictures_.seam_pulses[pixel] += fired ? picture.revolutions : 0;
      if (shown_[as_size(layer)]) {
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
  std::vector<bool> shown_;
  std::vector<std::int64_t> revolutions_;
  LayerPictures pictures_;
  std::atomic<std::int64_t> next_ = 0;
  std::atomic<bool> failed_ = false;
  std::mutex mutex_;  ///< of what follows, and of the pictures
  std::int64_t done_ = 0;
  std::optional<Error> error_;
};

/// Sums of the cells of each column along the line.
void add_columns(LayerPictures& pictures) {
  const Extent& cells = pictures.cells;
  const std::int64_t columns = pictures.lines_are_rows ? cells.width : cells.height;
  pictures.column_pulses.assign(as_size(columns), 0);
  pictures.column_pixels.assign(as_size(columns), 0);
  for (std::int64_t cell = 0; cell < cells.area(); ++cell) {
    const std::size_t column = as_size(pictures.lines_are_rows ? cell % cells.width : cell / cells.width);
    pictures.column_pulses[column] += pictures.pulses[as_size(cell)];
    pictures.column_pixels[column] += pictures.pixels[as_size(cell)];
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
  Work work(header, devices, options);
  const std::int64_t wanted =
      options.threads > 0 ? options.threads : std::max<std::int64_t>(1, std::thread::hardware_concurrency());
  const std::int64_t all = options.memory_bytes - options.table_bytes;
  const std::int64_t fit = std::max<std::int64_t>(1, all / least_unroll_bytes(*program));
  const std::int64_t workers = std::min<std::int64_t>({wanted, 4, work.layers(), fit});
  const std::int64_t share = all / workers + options.table_bytes;  // so that a refusal names all of the budget
  std::vector<std::thread> threads;
  for (std::int64_t worker = 1; worker < workers; ++worker) {
    threads.emplace_back([&] { work.run(programs, share); });
  }
  work.run(programs, share);
  for (std::thread& thread : threads) {
    thread.join();
  }
  GRAVURE_TRY(LayerPictures pictures, work.take());
  add_columns(pictures);
  return pictures;
}

}  // namespace gravure::report
