#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "gravure/core/exposure_map.hpp"
#include "gravure/core/program.hpp"
#include "gravure/pipeline/layer_reader.hpp"

namespace gravure {

/// Memory that the reader of a program's lines takes.
struct ReaderNeeds {
  std::int64_t line_bytes = 0;         ///< a line it gives
  std::int64_t fixed_bytes = 0;        ///< beside its panel, when up to `lines` lines are asked for at once
  std::int64_t least_panel_bytes = 0;  ///< the smallest panel it works with
};
ReaderNeeds reader_needs(const Plan& plan, const LayerStack& stack, std::int64_t lines);

/// The lines of the stored layers of a program, left to right. `header` and `stack` must outlive the reader. The stack
/// holds the whole images: one input for each stored layer, or one for each layer of a helical job.
std::unique_ptr<LayerLines> make_layer_lines(const ProgramHeader& header, const LayerStack& stack,
                                             const ImageOpener& opener, std::int64_t panel_bytes);

/// Cuts the marking windows of bands, passes and helical revolutions out of the lines of the images, in bounded memory.
///
/// Helical: asked for the same lines of one revolution after the other, it keeps a panel: of each image the columns
/// that as many coming revolutions as fit expose in these lines. So an image is read once for each panel.
class WindowReader final : public LayerLines {
 public:
  WindowReader(const ProgramHeader& header, const LayerStack& stack, const ImageOpener& opener,
               std::int64_t panel_bytes);
  /// What stays dark is 0, so it never asks for inversion.
  Result<bool> read_lines(std::int64_t layer, std::int64_t first_line, std::int64_t count,
                          std::span<std::byte> out) override;
  std::int64_t least_memory_bytes(std::int64_t lines) override;
  void grant_memory(std::int64_t lines, std::int64_t bytes) override;
  void stop_when(StopTest test) override { inner_.stop_when(std::move(test)); }

 private:
  /// Columns of one image while they are kept: whole bytes of `lines` lines.
  struct Strip {
    std::int64_t first_byte = 0;  ///< of the image's line
    std::int64_t bytes = 0;       ///< of each line
    std::int64_t offset = 0;      ///< of its first line in held_
  };
  Result<void> cut_lines(std::int64_t layer, std::int64_t first_line, std::int64_t count, std::span<std::byte> out);
  Result<void> load_panel(std::int64_t revolution, std::int64_t first_line, std::int64_t count);
  Result<void> fill_strip(std::size_t image, std::int64_t first, std::int64_t count);
  void place_strips(std::int64_t revolution, std::int64_t first_line, std::int64_t count);
  void expose(std::int64_t revolution, std::int64_t first_line, std::int64_t count, std::span<std::byte> out) const;

  const ProgramHeader& header_;
  const LayerStack& stack_;
  const ImageOpener& opener_;
  const ExposureMap map_;
  std::vector<std::int64_t> revolution_of_;  ///< stored layer -> the first revolution that exposes it
  std::int64_t panel_bytes_;
  LayerReader inner_;
  std::vector<std::byte> rows_;  ///< lines of an image as they are read
  std::vector<std::byte> held_;  ///< the panel; a one fires
  std::vector<Strip> strips_;    ///< of each image
  std::int64_t held_line_ = 0;
  std::int64_t held_lines_ = 0;
  std::int64_t held_revolution_ = 0;
  std::int64_t held_revolutions_ = 0;
  Result<void> panel_read_;  ///< how collecting the panel ended
};

}  // namespace gravure
