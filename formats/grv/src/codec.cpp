#include "codec.hpp"

#include <xxhash.h>
#include <zlib.h>
#include <zstd.h>
#include <zstd_errors.h>

#include <algorithm>
#include <memory>

#include "hash_avx2.hpp"

namespace gravure::grv {
namespace {

/// zlib level for `deflate`: the fastest; higher levels gain little on bilevel lines.
constexpr int kDeflateLevel = 1;

struct FreeContext {
  void operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }
  void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
};

// One of each a thread: making them costs more than a chunk.
ZSTD_CCtx* compressor() {
  thread_local const std::unique_ptr<ZSTD_CCtx, FreeContext> context(ZSTD_createCCtx());
  return context.get();
}

ZSTD_DCtx* decompressor() {
  thread_local const std::unique_ptr<ZSTD_DCtx, FreeContext> context(ZSTD_createDCtx());
  return context.get();
}

Error damaged(const std::string& why) {
  return {ErrorCode::bad_file, "compressed bytes do not unpack: " + why};
}

/// Bytes used of `out`; 0 where they did not fit, which means that compression does not pay.
Result<std::size_t> compress_zstd(int level, std::span<const std::byte> chunk, std::span<std::byte> out) {
  if (compressor() == nullptr) {
    return Error{ErrorCode::io, "zstd: out of memory"};
  }
  const std::size_t used = ZSTD_compressCCtx(compressor(), out.data(), out.size(), chunk.data(), chunk.size(), level);
  if (ZSTD_isError(used) == 0U) {
    return used;
  }
  if (ZSTD_getErrorCode(used) == ZSTD_error_dstSize_tooSmall) {
    return std::size_t{0};
  }
  return Error{ErrorCode::io, std::string("zstd: ") + ZSTD_getErrorName(used)};
}

Result<std::size_t> compress_deflate(std::span<const std::byte> chunk, std::span<std::byte> out) {
  uLongf used = out.size();
  const int status = compress2(reinterpret_cast<Bytef*>(out.data()), &used,
                               reinterpret_cast<const Bytef*>(chunk.data()), chunk.size(), kDeflateLevel);
  if (status == Z_OK) {
    return static_cast<std::size_t>(used);
  }
  if (status == Z_BUF_ERROR) {
    return std::size_t{0};
  }
  return Error{ErrorCode::io, "zlib: out of memory"};
}

Result<void> unpack_zstd(std::span<const std::byte> stored, std::span<std::byte> out) {
  if (decompressor() == nullptr) {
    return Error{ErrorCode::io, "zstd: out of memory"};
  }
  const std::size_t used = ZSTD_decompressDCtx(decompressor(), out.data(), out.size(), stored.data(), stored.size());
  if (ZSTD_isError(used) != 0U) {
    return damaged(ZSTD_getErrorName(used));
  }
  if (used != out.size()) {
    return damaged(std::to_string(used) + " bytes instead of " + std::to_string(out.size()));
  }
  return {};
}

Result<void> unpack_deflate(std::span<const std::byte> stored, std::span<std::byte> out) {
  uLongf used = out.size();
  const int status = uncompress(reinterpret_cast<Bytef*>(out.data()), &used,
                                reinterpret_cast<const Bytef*>(stored.data()), stored.size());
  if (status != Z_OK) {
    return damaged("zlib status " + std::to_string(status));
  }
  if (used != out.size()) {
    return damaged(std::to_string(used) + " bytes instead of " + std::to_string(out.size()));
  }
  return {};
}

}  // namespace

Result<Packed> pack(Compression compression, int zstd_level, std::span<const std::byte> chunk) {
  std::size_t used = 0;
  if (compression != Compression::none) {
    thread_local std::vector<std::byte> scratch;
    scratch.resize(chunk.size() * 9 / 10);  // beyond this it does not pay
    if (!scratch.empty()) {
      GRAVURE_TRY(used, compression == Compression::zstd ? compress_zstd(zstd_level, chunk, scratch)
                                                         : compress_deflate(chunk, scratch));
    }
    if (used > 0) {
      return Packed{{scratch.begin(), scratch.begin() + static_cast<std::ptrdiff_t>(used)}, false};
    }
  }
  return Packed{{chunk.begin(), chunk.end()}, true};
}

Result<void> unpack(Compression compression, bool raw, std::span<const std::byte> stored, std::span<std::byte> out) {
  if (!raw && compression == Compression::zstd) {
    return unpack_zstd(stored, out);
  }
  if (!raw && compression == Compression::deflate) {
    return unpack_deflate(stored, out);
  }
  if (stored.size() != out.size()) {
    return damaged(std::to_string(stored.size()) + " raw bytes instead of " + std::to_string(out.size()));
  }
  std::copy(stored.begin(), stored.end(), out.begin());
  return {};
}

std::uint64_t hash_of(std::span<const std::byte> bytes) noexcept {
#if defined(GRAVURE_HASH_AVX2)
  static const bool avx2 = __builtin_cpu_supports("avx2") != 0;
  if (avx2) {
    return hash_avx2(bytes.data(), bytes.size());
  }
#endif
  return XXH3_64bits(bytes.data(), bytes.size());
}

}  // namespace gravure::grv
