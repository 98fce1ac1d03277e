#include "hdf5_session.hpp"

#include <zstd.h>

#include <cstddef>

#include "gravure/formats/grv.hpp"
#include "layout.hpp"

namespace gravure::grv {
namespace {

std::mutex& library_mutex() {
  static std::mutex mutex;
  return mutex;
}

/// Replaces the filter's buffer by `bytes` new ones.
void replace_buffer(void** buffer, std::size_t* size, void* fresh, std::size_t bytes) {
  H5free_memory(*buffer);
  *buffer = fresh;
  *size = bytes;
}

std::size_t unpack_chunk(std::size_t used, std::size_t* size, void** buffer) {
  const unsigned long long bytes = ZSTD_getFrameContentSize(*buffer, used);
  if (bytes == ZSTD_CONTENTSIZE_UNKNOWN || bytes == ZSTD_CONTENTSIZE_ERROR || bytes < 1 ||
      bytes > static_cast<unsigned long long>(kMaxChunkBytes)) {
    return 0;
  }
  void* fresh = H5allocate_memory(bytes, false);
  if (fresh == nullptr) {
    return 0;
  }
  const std::size_t got = ZSTD_decompress(fresh, bytes, *buffer, used);
  if (ZSTD_isError(got) != 0U) {
    H5free_memory(fresh);
    return 0;
  }
  replace_buffer(buffer, size, fresh, bytes);
  return got;
}

std::size_t pack_chunk(int level, std::size_t used, std::size_t* size, void** buffer) {
  const std::size_t bound = ZSTD_compressBound(used);
  void* fresh = H5allocate_memory(bound, false);
  if (fresh == nullptr) {
    return 0;
  }
  const std::size_t got = ZSTD_compress(fresh, bound, *buffer, used, level);
  if (ZSTD_isError(got) != 0U || got >= used) {
    H5free_memory(fresh);
    return 0;
  }
  replace_buffer(buffer, size, fresh, bound);
  return got;
}

/// The filter as the library calls it for plain H5Dread() and H5Dwrite() in this process. Returns the bytes now in
/// use, 0 on failure.
std::size_t zstd_filter(unsigned flags, std::size_t value_count, const unsigned* values, std::size_t used,
                        std::size_t* size, void** buffer) {
  if ((flags & H5Z_FLAG_REVERSE) != 0U) {
    return unpack_chunk(used, size, buffer);
  }
  return pack_chunk(value_count > 0 ? static_cast<int>(values[0]) : 1, used, size, buffer);
}

void register_filter() {
  // Always ours, never a plug-in's: the filter's name is stored in files, and the same job is to give the same bytes.
  static constexpr H5Z_class2_t kFilter = {H5Z_CLASS_T_VERS, kZstdFilter, 1, 1, "zstd", nullptr, nullptr, zstd_filter};
  static bool registered = false;
  if (!registered || H5Zfilter_avail(kZstdFilter) <= 0) {
    registered = H5Zregister(&kFilter) >= 0;
  }
}

}  // namespace

Hdf5Session::Hdf5Session() : lock_(library_mutex()) {
  H5open();
  H5Eget_auto2(H5E_DEFAULT, &printer_, &printer_data_);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  register_filter();
}

Hdf5Session::~Hdf5Session() {
  H5Eclear2(H5E_DEFAULT);
  H5Eset_auto2(H5E_DEFAULT, printer_, printer_data_);
}

std::string hdf5_reason() {
  std::string reason = "HDF5 gives no reason";
  const H5E_walk2_t keep_first = [](unsigned level, const H5E_error2_t* entry, void* text) -> herr_t {
    if (level == 0 && entry->desc != nullptr) {
      *static_cast<std::string*>(text) = entry->desc;
    }
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_first, &reason);
  return reason;
}

}  // namespace gravure::grv

namespace gravure {

void leave_hdf5_to_exit() {
  H5dont_atexit();
}

}  // namespace gravure
