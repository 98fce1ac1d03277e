#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "gravure/core/image_source.hpp"
#include "gravure/core/job.hpp"
#include "gravure/core/layer_lines.hpp"
#include "gravure/pipeline/tiles.hpp"
#include "gravure/raster/slice.hpp"

namespace gravure {

class ColumnSpill;
class ColumnSpills;

/// Where a layer's pixels come from.
struct LayerInput {
  std::string path;
  std::int64_t page = 0;
  std::int64_t level = 0;  ///< depth maps: which slice
};

/// The images of a job in exposure order and what makes a pixel of them fire.
struct LayerStack {
  std::vector<LayerInput> layers;
  std::int64_t lines = 0;   ///< of every layer
  std::int64_t pixels = 0;  ///< of every line
  TileGrid tiles;           ///< a layer is its image so many times side by side
  SampleType samples = SampleType::bit;
  bool random_access = true;        ///< false: one of the files must be read from its first row on
  std::int64_t rows_per_block = 1;  ///< of the highest strips or tiles among the images
  /// The most that a reader of one of the images holds (ImageInfo). Left out: found by opening each of them.
  std::optional<std::int64_t> decoder_bytes;
  LinesAlong lines_along = LinesAlong::rows;
  Fires fires = Fires::white;
  std::optional<std::int64_t> threshold;  ///< grey layers: a sample >= threshold is white
  std::int64_t levels = 0;                ///< depth map: number of slices; 0 for a stack of layers
  std::optional<Rational> depth_min;      ///< depth map: sample with no pulse; default 0
  std::optional<Rational> depth_max;      ///< depth map: sample with every pulse; default 1, 255 or 65535
  /// What messages call these three: the keys of a job, or the options that they came from.
  std::string threshold_name = "image.threshold";
  std::string depth_min_name = "image.depth_min";
  std::string depth_max_name = "image.depth_max";
  std::shared_ptr<ColumnSpills> spills;  ///< of images too large to turn over in memory; none: decoded many times
};

/// Fills in what the images say of themselves: samples, random_access, rows_per_block and decoder_bytes of all
/// distinct ones that open, and lets readers share temporary files (`spills`). Those that do not open are passed over:
/// read_lines() says why.
void learn_images(LayerStack& stack, const ImageOpener& opener);

/// Reads the lines of a stack in bounded memory: rows straight from the file, columns by way of panels (as many columns
/// as the budget holds, transposed in blocks). A bilevel picture of more than one panel is decoded once, into a
/// temporary file that holds its columns, where one can be had; else, and always where samples are grey, once a panel.
class LayerReader final : public LayerLines {
 public:
  /// `panel_bytes` bounds what columns keep in memory; at least 8 columns are always held.
  LayerReader(const LayerStack& stack, const ImageOpener& opener, std::int64_t panel_bytes);
  Result<bool> read_lines(std::int64_t layer, std::int64_t first_line, std::int64_t count,
                          std::span<std::byte> out) override;
  std::int64_t least_memory_bytes(std::int64_t lines) override;
  void grant_memory(std::int64_t lines, std::int64_t bytes) override;
  /// No temporary files, for readers that leave an image after every few lines: each visit would write one anew.
  void decode_always() { spills_wanted_ = false; }
  void stop_when(StopTest test) override { stop_test_ = std::move(test); }

  /// What a reader holds beside its panels when up to `lines` lines are asked for at once, as far as the stack tells.
  static std::int64_t fixed_bytes(const LayerStack& stack, std::int64_t lines);
  /// The smallest panel; 0 for rows.
  static std::int64_t least_panel_bytes(const LayerStack& stack);
  /// Lines that one pass over a file yields; reading such groups in order is cheapest.
  static std::int64_t lines_per_pass(const LayerStack& stack, std::int64_t panel_bytes);

 private:
  struct Limit {
    double value;
    raster::Where where;
  };
  Result<void> go_on() const { return stop_test_ ? stop_test_() : Result<void>(); }
  Result<void> select(const LayerInput& input);
  Result<void> check_image(const LayerInput& input, const ImageInfo& info) const;
  Result<void> read_rows(std::int64_t first_row, std::int64_t count, std::span<std::byte> out);
  Result<void> read_bits(std::int64_t first_line, std::int64_t count, std::span<std::byte> out);
  /// As many of the lines as are held in one piece; at least one.
  Result<std::span<const std::byte>> read_samples(std::int64_t first_line, std::int64_t count);
  /// Holds the panel of columns that contains `first_line`.
  Result<void> load_panel(std::int64_t first_line);
  Result<void> decode_panel(std::int64_t first, std::int64_t count);
  /// The temporary file with the columns of this image, where it pays.
  Result<void> find_spill();
  /// Where a grey sample becomes a pulse in this layer.
  Result<Limit> limit_of(const LayerInput& input) const;
  void cut(std::span<const std::byte> samples, std::int64_t count, const Limit& limit, std::span<std::byte> out) const;

  const LayerStack& stack_;
  const ImageOpener& opener_;
  std::int64_t panel_lines_;
  StopTest stop_test_;
  bool spills_wanted_ = true;
  std::unique_ptr<ImageSource> source_;
  std::string path_;
  std::int64_t page_ = -1;
  std::shared_ptr<const ColumnSpill> spill_;
  std::int64_t next_row_ = 0;  ///< what a file that only runs upwards has not given yet
  // The lines kept: a block of sample rows, or a panel of columns already turned into lines.
  std::vector<std::byte> held_;
  std::int64_t held_first_ = 0;
  std::int64_t held_count_ = 0;
};

}  // namespace gravure
