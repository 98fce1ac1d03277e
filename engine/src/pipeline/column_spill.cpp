#include "column_spill.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "gravure/core/as_size.hpp"
#include "gravure/raster/place.hpp"
#include "gravure/raster/transpose.hpp"

namespace gravure {
namespace {

constexpr std::int64_t kLeastSlabRows = 64;   // pieces of 8 bytes; shorter ones cost more than decoding again
constexpr std::int64_t kMostSlabRows = 4096;  // beyond this nothing is won
constexpr std::int64_t kBandRows = 64;
constexpr std::size_t kPieceBytes = std::size_t{8} << 20;  // written at a time

Error failure(const char* what) {
  return {ErrorCode::io, std::string("temporary file for columns: ") + what + ": " + std::strerror(errno) +
                             ": set TMPDIR to a folder with room"};
}

/// A file without a name: gone with the process, however that ends.
Result<int> nameless_file() {
  std::error_code failed;
  const std::filesystem::path folder = std::filesystem::temp_directory_path(failed);
  if (failed) {
    errno = ENOENT;
    return failure("no folder");
  }
  std::string pattern = (folder / "gravure-columns-XXXXXX").string();
  const int fd = ::mkostemp(pattern.data(), O_CLOEXEC);
  if (fd < 0) {
    return failure("cannot create");
  }
  ::unlink(pattern.c_str());
  return fd;
}

Result<void> write_at(int fd, std::int64_t offset, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t put = ::pwrite(fd, bytes.data(), bytes.size(), offset);
    if (put < 0 && errno == EINTR) {
      continue;
    }
    if (put <= 0) {
      return failure("cannot write");
    }
    bytes = bytes.subspan(static_cast<std::size_t>(put));
    offset += put;
  }
  return {};
}

Result<void> read_at(int fd, std::int64_t offset, std::span<std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t got = ::pread(fd, bytes.data(), bytes.size(), offset);
    if (got < 0 && errno == EINTR) {
      continue;
    }
    if (got <= 0) {
      return failure("cannot read");
    }
    bytes = bytes.subspan(static_cast<std::size_t>(got));
    offset += got;
  }
  return {};
}

}  // namespace

ColumnSpill::~ColumnSpill() {
  ::close(fd_);
}

std::int64_t ColumnSpill::slab_rows_for(std::int64_t columns, std::int64_t bytes) {
  // A slab is held as rows and as columns.
  const std::int64_t rows = bytes / std::max<std::int64_t>(1, 2 * raster::packed_bytes(columns));
  return rows < kLeastSlabRows ? 0 : std::min(rows / kLeastSlabRows * kLeastSlabRows, kMostSlabRows);
}

std::int64_t ColumnSpill::rows_in(std::int64_t slab) const {
  return std::min(size_.slab_rows, size_.rows - slab * size_.slab_rows);
}

std::int64_t ColumnSpill::offset_of(std::int64_t slab) const {
  return slab * (size_.slab_rows / 8) * size_.columns;
}

Result<std::shared_ptr<const ColumnSpill>> ColumnSpill::make(const Size& size, const RowReader& rows,
                                                             const StopTest& stop_test) {
  const Result<int> fd = nameless_file();
  if (!fd) {
    return std::shared_ptr<const ColumnSpill>();
  }
  const auto spill = std::make_shared<ColumnSpill>(size, fd.value());
  GRAVURE_TRY(const bool filled, spill->fill(rows, stop_test));
  return filled ? std::shared_ptr<const ColumnSpill>(spill) : nullptr;
}

Result<bool> ColumnSpill::fill(const RowReader& rows, const StopTest& stop_test) {
  const std::int64_t row_bytes = raster::packed_bytes(size_.columns);
  std::vector<std::byte> slab(as_size(size_.slab_rows * row_bytes));
  std::vector<std::byte> turned(as_size(size_.slab_rows / 8 * size_.columns));
  for (std::int64_t number = 0; number * size_.slab_rows < size_.rows; ++number) {
    const std::int64_t count = rows_in(number);
    for (std::int64_t row = 0; row < count; row += kBandRows) {
      const std::int64_t now = std::min(kBandRows, count - row);
      GRAVURE_CHECK(rows(number * size_.slab_rows + row, now,
                         std::span(slab).subspan(as_size(row * row_bytes), as_size(now * row_bytes))));
    }
    const auto columns = std::span(turned).first(as_size(raster::packed_bytes(count) * size_.columns));
    raster::transpose(columns, slab, count, size_.columns);
    for (std::size_t at = 0; at < columns.size(); at += kPieceBytes) {  // a disk may be slower than any codec
      GRAVURE_CHECK(stop_test());
      const std::size_t now = std::min(kPieceBytes, columns.size() - at);
      if (!write_at(fd_, offset_of(number) + static_cast<std::int64_t>(at), columns.subspan(at, now))) {
        return false;
      }
    }
  }
  return true;
}

Result<void> ColumnSpill::read(std::int64_t first, std::int64_t count, std::span<std::byte> out,
                               const StopTest& stop_test) const {
  const std::int64_t line_bytes = raster::packed_bytes(size_.rows);
  std::vector<std::byte> pieces(as_size(size_.slab_rows / 8 * count));
  for (std::int64_t slab = 0; slab * size_.slab_rows < size_.rows; ++slab) {
    GRAVURE_CHECK(stop_test());
    const std::int64_t piece = raster::packed_bytes(rows_in(slab));
    const auto now = std::span(pieces).first(as_size(piece * count));
    GRAVURE_CHECK(read_at(fd_, offset_of(slab) + first * piece, now));
    std::byte* to = out.data() + slab * (size_.slab_rows / 8);
    for (std::int64_t column = 0; column < count; ++column, to += line_bytes) {
      std::memcpy(to, now.data() + column * piece, as_size(piece));
    }
  }
  return {};
}

Result<std::shared_ptr<const ColumnSpill>> ColumnSpills::get(const std::string& path, std::int64_t page,
                                                             const Maker& make) {
  const std::lock_guard lock(mutex_);
  std::weak_ptr<const ColumnSpill>& known = made_[{path, page}];
  if (std::shared_ptr<const ColumnSpill> there = known.lock(); there || no_room_) {
    return there;
  }
  Result<std::shared_ptr<const ColumnSpill>> made = make();
  if (made) {
    known = made.value();
    no_room_ = made.value() == nullptr;
  }
  return made;
}

}  // namespace gravure
