#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "gravure/core/error.hpp"
#include "gravure/core/layer_lines.hpp"

namespace gravure {

/// Reads rows [first, first + count) of a bilevel image, packed.
using RowReader = std::function<Result<void>(std::int64_t first, std::int64_t count, std::span<std::byte> out)>;

/// The columns of one bilevel image as lines, in a nameless file: turned over slab by slab while the image is decoded
/// once. [slab][column][bytes of the slab's rows]; a slab is read back with one call, and only the columns asked for.
class ColumnSpill {
 public:
  struct Size {
    std::int64_t rows = 0;
    std::int64_t columns = 0;
    std::int64_t slab_rows = 0;  ///< a multiple of 8
  };
  ColumnSpill(Size size, int fd) : size_(size), fd_(fd) {}
  ColumnSpill(const ColumnSpill&) = delete;
  ColumnSpill& operator=(const ColumnSpill&) = delete;
  ~ColumnSpill();

  /// Rows of a slab such that making a spill takes at most `bytes`; 0 where that is too little to be worth it.
  static std::int64_t slab_rows_for(std::int64_t columns, std::int64_t bytes);
  /// Reads the image and writes its columns to a file in the folder for temporary files. Null where that folder cannot
  /// take it (no room, not writable), which leaves nothing behind; an error is the reader's, or the stop test's.
  static Result<std::shared_ptr<const ColumnSpill>> make(const Size& size, const RowReader& rows,
                                                         const StopTest& stop_test);

  /// Columns [first, first + count) as lines of packed rows.
  Result<void> read(std::int64_t first, std::int64_t count, std::span<std::byte> out, const StopTest& stop_test) const;

 private:
  /// False: no room.
  Result<bool> fill(const RowReader& rows, const StopTest& stop_test);
  std::int64_t rows_in(std::int64_t slab) const;
  std::int64_t offset_of(std::int64_t slab) const;

  const Size size_;
  int fd_;
};

/// The spills of the images of a stack, shared by all its readers. One is made by whoever needs it first, the others
/// wait for it; it goes when the last reader lets it go.
class ColumnSpills {
 public:
  using Maker = std::function<Result<std::shared_ptr<const ColumnSpill>>()>;
  /// Null where the folder for temporary files cannot take it: whoever asks decodes again instead.
  Result<std::shared_ptr<const ColumnSpill>> get(const std::string& path, std::int64_t page, const Maker& make);

 private:
  std::mutex mutex_;
  std::map<std::pair<std::string, std::int64_t>, std::weak_ptr<const ColumnSpill>> made_;
  bool no_room_ = false;
};

}  // namespace gravure
