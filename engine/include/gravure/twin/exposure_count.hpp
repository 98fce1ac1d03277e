#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "gravure/core/exposure_map.hpp"
#include "gravure/core/program.hpp"
#include "gravure/twin/unroll.hpp"

namespace gravure {

/// Counts how often each pixel of a program's pictures was fired, by lines as a board fired them: in the size and
/// orientation of the source images, some rows at a time.
class ExposureCount {
 public:
  /// Which picture: that of a revolution (with bands: the same one of every band), that of a layer (helical programs
  /// alone), or all pictures on top of each other. out_of_range names what the program has; bad_argument: a revolution
  /// of a helical program, a layer of another.
  static Result<ExposureCount> make(const ProgramHeader& header, std::optional<std::int64_t> revolution,
                                    std::optional<std::int64_t> layer);

  UnrolledSize size() const { return unrolled_size(*header_); }
  /// Begins anew with rows [first_row, end_row) of the picture.
  void start(std::int64_t first_row, std::int64_t end_row);
  /// What fired of a line: bits of its window in time order. bad_file where the program has no such line, or no window
  /// there; out_of_range where a pixel was fired more than 255 times.
  Result<void> add(std::int64_t revolution, std::int64_t line, std::int64_t first_slot,
                   std::span<const std::byte> bits);
  /// A byte a pixel, rows without padding.
  std::span<const std::byte> rows() const noexcept { return counts_; }

 private:
  ExposureCount(const ProgramHeader& header, std::optional<std::int64_t> revolution, std::optional<std::int64_t> layer)
      : header_(&header), map_(header.plan), revolution_(revolution), layer_(layer) {}
  Result<void> check(std::int64_t revolution, std::int64_t line, std::int64_t first_slot, std::size_t bytes) const;
  Result<void> count(const Stretch& stretch, std::int64_t image_line);

  const ProgramHeader* header_;
  ExposureMap map_;
  std::optional<std::int64_t> revolution_;
  std::optional<std::int64_t> layer_;
  std::int64_t first_row_ = 0;
  std::int64_t end_row_ = 0;
  std::vector<std::byte> landed_;  ///< the line, left to right
  std::vector<std::byte> counts_;
};

}  // namespace gravure
