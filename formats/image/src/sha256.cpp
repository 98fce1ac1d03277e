#include "sha256.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <utility>

#include "gravure/core/file_output.hpp"
#include "gravure/formats/image_files.hpp"
#if defined(__x86_64__)
#include <cpuid.h>
#include <immintrin.h>
#endif

namespace gravure {
namespace {

constexpr std::size_t kBlock = 64;

/// FIPS 180-4 section 4.2.2.
alignas(16) constexpr std::array<std::uint32_t, 64> kRound = {
    0x428a2f98, 0x71374491, 0xb5c0fbcf, 0xe9b5dba5, 0x3956c25b, 0x59f111f1, 0x923f82a4, 0xab1c5ed5,
    0xd807aa98, 0x12835b01, 0x243185be, 0x550c7dc3, 0x72be5d74, 0x80deb1fe, 0x9bdc06a7, 0xc19bf174,
    0xe49b69c1, 0xefbe4786, 0x0fc19dc6, 0x240ca1cc, 0x2de92c6f, 0x4a7484aa, 0x5cb0a9dc, 0x76f988da,
    0x983e5152, 0xa831c66d, 0xb00327c8, 0xbf597fc7, 0xc6e00bf3, 0xd5a79147, 0x06ca6351, 0x14292967,
    0x27b70a85, 0x2e1b2138, 0x4d2c6dfc, 0x53380d13, 0x650a7354, 0x766a0abb, 0x81c2c92e, 0x92722c85,
    0xa2bfe8a1, 0xa81a664b, 0xc24b8b70, 0xc76c51a3, 0xd192e819, 0xd6990624, 0xf40e3585, 0x106aa070,
    0x19a4c116, 0x1e376c08, 0x2748774c, 0x34b0bcb5, 0x391c0cb3, 0x4ed8aa4a, 0x5b9cca4f, 0x682e6ff3,
    0x748f82ee, 0x78a5636f, 0x84c87814, 0x8cc70208, 0x90befffa, 0xa4506ceb, 0xbef9a3f7, 0xc67178f2};

using State = std::array<std::uint32_t, 8>;

/// FIPS 180-4 section 6.2.2, as it stands there.
void compress_portable(State& state, const unsigned char* data, std::size_t blocks) {
  for (; blocks > 0; --blocks, data += kBlock) {
    std::array<std::uint32_t, 64> w{};
    for (std::size_t t = 0; t < 16; ++t) {
      w[t] = std::uint32_t{data[4 * t]} << 24 | std::uint32_t{data[4 * t + 1]} << 16 |
             std::uint32_t{data[4 * t + 2]} << 8 | std::uint32_t{data[4 * t + 3]};
    }
    for (std::size_t t = 16; t < 64; ++t) {
      const std::uint32_t s0 = std::rotr(w[t - 15], 7) ^ std::rotr(w[t - 15], 18) ^ (w[t - 15] >> 3);
      const std::uint32_t s1 = std::rotr(w[t - 2], 17) ^ std::rotr(w[t - 2], 19) ^ (w[t - 2] >> 10);
      w[t] = w[t - 16] + s0 + w[t - 7] + s1;
    }
    auto [a, b, c, d, e, f, g, h] = state;
    for (std::size_t t = 0; t < 64; ++t) {
      const std::uint32_t t1 =
          h + (std::rotr(e, 6) ^ std::rotr(e, 11) ^ std::rotr(e, 25)) + ((e & f) ^ (~e & g)) + kRound[t] + w[t];
      const std::uint32_t t2 = (std::rotr(a, 2) ^ std::rotr(a, 13) ^ std::rotr(a, 22)) + ((a & b) ^ (a & c) ^ (b & c));
      h = g, g = f, f = e, e = d + t1, d = c, c = b, b = a, a = t1 + t2;
    }
    const State round = {a, b, c, d, e, f, g, h};
    for (std::size_t i = 0; i < state.size(); ++i) {
      state[i] += round[i];
    }
  }
}

#if defined(__x86_64__)
/// The four words of the schedule after these sixteen, which stand in `w0` to `w3`.
__attribute__((target("sha,sse4.1"), always_inline)) inline __m128i next_words(__m128i w0, __m128i w1, __m128i w2,
                                                                               __m128i w3) {
  const __m128i sum = _mm_add_epi32(_mm_sha256msg1_epu32(w0, w1), _mm_alignr_epi8(w3, w2, 4));
  return _mm_sha256msg2_epu32(sum, w3);
}

__attribute__((target("sha,sse4.1"), always_inline)) inline void four_rounds(__m128i& abef, __m128i& cdgh,
                                                                             __m128i words, std::size_t first) {
  const __m128i sum = _mm_add_epi32(words, _mm_load_si128(reinterpret_cast<const __m128i*>(kRound.data() + first)));
  cdgh = _mm_sha256rnds2_epu32(cdgh, abef, sum);
  abef = _mm_sha256rnds2_epu32(abef, cdgh, _mm_shuffle_epi32(sum, 0x0e));
}

/// The same with the processor's SHA instructions, five times as fast: state as ABEF and CDGH. Each round waits for the
/// one before, so the words of the schedule must cost nothing beside: they stay in registers, by name.
__attribute__((target("sha,sse4.1"))) void compress_sha_ni(State& state, const unsigned char* data,
                                                           std::size_t blocks) {
  const __m128i big_endian = _mm_set_epi64x(0x0c0d0e0f08090a0bLL, 0x0405060700010203LL);
  auto* const words = reinterpret_cast<__m128i*>(state.data());
  const __m128i low = _mm_shuffle_epi32(_mm_loadu_si128(words), 0xb1);       // b a d c -> c d a b
  const __m128i high = _mm_shuffle_epi32(_mm_loadu_si128(words + 1), 0x1b);  // e f g h -> h g f e
  __m128i abef = _mm_alignr_epi8(low, high, 8);
  __m128i cdgh = _mm_blend_epi16(high, low, 0xf0);
  for (; blocks > 0; --blocks, data += kBlock) {
    const __m128i abef_before = abef;
    const __m128i cdgh_before = cdgh;
    const auto* const block = reinterpret_cast<const __m128i*>(data);
    __m128i w0 = _mm_shuffle_epi8(_mm_loadu_si128(block), big_endian);
    __m128i w1 = _mm_shuffle_epi8(_mm_loadu_si128(block + 1), big_endian);
    __m128i w2 = _mm_shuffle_epi8(_mm_loadu_si128(block + 2), big_endian);
    __m128i w3 = _mm_shuffle_epi8(_mm_loadu_si128(block + 3), big_endian);
    for (std::size_t round = 0;; round += 16) {
      four_rounds(abef, cdgh, w0, round);
      four_rounds(abef, cdgh, w1, round + 4);
      four_rounds(abef, cdgh, w2, round + 8);
      four_rounds(abef, cdgh, w3, round + 12);
      if (round == 48) {
        break;
      }
      w0 = next_words(w0, w1, w2, w3);
      w1 = next_words(w1, w2, w3, w0);
      w2 = next_words(w2, w3, w0, w1);
      w3 = next_words(w3, w0, w1, w2);
    }
    abef = _mm_add_epi32(abef, abef_before);
    cdgh = _mm_add_epi32(cdgh, cdgh_before);
  }
  const __m128i feba = _mm_shuffle_epi32(abef, 0x1b);
  const __m128i dchg = _mm_shuffle_epi32(cdgh, 0xb1);
  _mm_storeu_si128(words, _mm_blend_epi16(feba, dchg, 0xf0));
  _mm_storeu_si128(words + 1, _mm_alignr_epi8(dchg, feba, 8));
}

bool has_sha_ni() {
  // Leaf 7, ebx bit 29; __builtin_cpu_supports does not know "sha" in clang 14.
  unsigned int a = 0;
  unsigned int b = 0;
  unsigned int c = 0;
  unsigned int d = 0;
  return __get_cpuid_count(7, 0, &a, &b, &c, &d) != 0 && (b >> 29 & 1U) != 0 && __builtin_cpu_supports("sse4.1") != 0;
}
#endif

using Compress = void (*)(State&, const unsigned char*, std::size_t);

Compress fastest() {
#if defined(__x86_64__)
  if (has_sha_ni()) {
    return compress_sha_ni;
  }
#endif
  return compress_portable;
}

class Sha256 {
 public:
  explicit Sha256(Compress compress) : compress_(compress) {}

  void add(const unsigned char* data, std::size_t size) {
    if (size == 0) {
      return;
    }
    total_ += size;
    if (held_ > 0) {
      const std::size_t taken = std::min(size, kBlock - held_);
      std::memcpy(rest_.data() + held_, data, taken);
      held_ += taken, data += taken, size -= taken;
      if (held_ < kBlock) {
        return;
      }
      compress_(state_, rest_.data(), 1);
    }
    compress_(state_, data, size / kBlock);
    held_ = size % kBlock;
    std::memcpy(rest_.data(), data + (size - held_), held_);
  }

  std::string finish() {
    const std::uint64_t bits = total_ * 8;
    std::array<unsigned char, 2 * kBlock> tail = {0x80};
    const std::size_t padding = (held_ < kBlock - 8 ? kBlock : 2 * kBlock) - held_;
    for (std::size_t i = 0; i < 8; ++i) {
      tail[padding - 1 - i] = static_cast<unsigned char>(bits >> (8 * i));
    }
    add(tail.data(), padding);
    std::string text;
    for (const std::uint32_t word : state_) {
      for (int shift = 28; shift >= 0; shift -= 4) {
        text += "0123456789abcdef"[word >> shift & 15U];
      }
    }
    return text;
  }

 private:
  Compress compress_;
  State state_ = {0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a, 0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<unsigned char, kBlock> rest_{};
  std::size_t held_ = 0;
  std::uint64_t total_ = 0;
};

struct CloseFile {
  void operator()(std::FILE* file) const noexcept { static_cast<void>(std::fclose(file)); }
};

}  // namespace

std::string sha256_text(std::string_view bytes) {
  Sha256 hash(fastest());
  hash.add(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
  return hash.finish();
}

std::string sha256_text_portable(std::string_view bytes) {
  Sha256 hash(compress_portable);
  hash.add(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
  return hash.finish();
}

struct Sha256File::State {
  static constexpr std::size_t kBuffer = std::size_t{64} << 10;
  std::string path;
  std::unique_ptr<std::FILE, CloseFile> file;
  Sha256 hash{fastest()};
  std::unique_ptr<unsigned char[]> buffer = std::make_unique_for_overwrite<unsigned char[]>(kBuffer);
};

Sha256File::Sha256File(std::unique_ptr<State> state) : state_(std::move(state)) {}
Sha256File::Sha256File(Sha256File&&) noexcept = default;
Sha256File& Sha256File::operator=(Sha256File&&) noexcept = default;
Sha256File::~Sha256File() = default;

Result<Sha256File> Sha256File::open(const std::string& path) {
  std::error_code unknown;
  if (!std::filesystem::is_regular_file(path, unknown)) {
    return Error{ErrorCode::bad_file, path + ": is no file that exists: nothing to hash"};
  }
  auto state = std::make_unique<State>();
  state->path = path;
  state->file.reset(std::fopen(path.c_str(), "rbe"));
  if (state->file == nullptr) {
    return open_error(path, errno);
  }
  return Sha256File(std::move(state));
}

Result<std::size_t> Sha256File::next() {
  const std::size_t got = std::fread(state_->buffer.get(), 1, State::kBuffer, state_->file.get());
  if (std::ferror(state_->file.get()) != 0) {
    return Error{ErrorCode::io, state_->path + ": cannot read: " + std::strerror(errno)};
  }
  state_->hash.add(state_->buffer.get(), got);
  return got;
}

std::string Sha256File::finish() {
  return state_->hash.finish();
}

Result<std::string> sha256_file(const std::string& path, const CancelToken* cancel) {
  GRAVURE_TRY(Sha256File file, Sha256File::open(path));
  while (true) {
    GRAVURE_TRY(const std::size_t got, file.next());
    if (got == 0) {
      return file.finish();
    }
    if (cancel != nullptr && cancel->cancelled()) {
      return Error{ErrorCode::cancelled, path + ": stopped before its SHA-256 was known"};
    }
  }
}

}  // namespace gravure
