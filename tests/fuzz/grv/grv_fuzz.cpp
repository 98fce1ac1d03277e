#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <span>
#include <vector>

#include "byte_file.hpp"
#include "codec.hpp"
#include "reader.hpp"
#include "seal.hpp"

// An input that starts like a program is opened as it is and again with checksums that hold for what the seal covers,
// so that the checks behind them are reached too; the checksum over the HDF5 structure is left, because what stands
// behind it is the HDF5 library, not ours. Any other input is a compressed chunk after three bytes of parameters.

namespace {

using Bytes = std::span<const std::byte>;

void require(bool holds) {
  if (!holds) {
    std::abort();
  }
}

/// Set-points and wanted points of a path, which are asked for in whatever pieces suit.
void read_path(gravure::LineSource& source) {
  constexpr std::int64_t kAtOnce = 1000;
  constexpr std::int64_t kMost = 100'000;
  const gravure::Plan& plan = source.header().plan;
  std::vector<gravure::PathSetPoint> points;
  for (std::int64_t first = 0, all = std::min(gravure::set_points_of(plan), kMost); first < all; first += kAtOnce) {
    points.resize(static_cast<std::size_t>(std::min(kAtOnce, all - first)));
    const auto read = source.read_set_points(first, points);
    require(read || !read.error().message.empty());
  }
  std::vector<gravure::PathTarget> targets;
  for (std::int64_t first = 0, all = std::min(plan.path ? plan.path->targets : 0, kMost); first < all;
       first += kAtOnce) {
    targets.resize(static_cast<std::size_t>(std::min(kAtOnce, all - first)));
    const auto read = source.read_targets(first, targets);
    require(read || !read.error().message.empty());
  }
}

void read_everything(Bytes image) {
  const auto part = gravure::grv::open_part(gravure::grv::open_image(image));
  if (!part) {
    return;
  }
  const auto& source = part.value().lines;
  const auto& header = source->header();
  read_path(*source);
  const std::int64_t lines = header.plan.rotary.lines_per_revolution;
  const std::int64_t per_chunk = source->lines_per_chunk();
  for (std::int64_t layer = 0; layer < static_cast<std::int64_t>(header.layers.size()); ++layer) {
    for (std::int64_t first = 0; first < lines; first += per_chunk) {
      const auto chunk = source->fetch({layer, first / per_chunk});
      require(static_cast<bool>(chunk));
      std::vector<std::byte> out(static_cast<std::size_t>(std::min(per_chunk, lines - first) * header.line_bytes()));
      const auto decoded = source->decode(chunk.value(), out);
      require(decoded || !decoded.error().message.empty());
    }
  }
}

/// Gives the seal checksums that hold, where it makes sense at all.
void renew_seal(std::vector<std::byte>& image) {
  using gravure::grv::Seal;
  const std::span<std::byte, Seal::kBytes> front(image.data(), Seal::kBytes);
  const std::uint64_t own = gravure::grv::hash_of(front.first(Seal::kBytes - 8));
  for (std::size_t i = 0; i < 8; ++i) {
    front[Seal::kBytes - 8 + i] = static_cast<std::byte>(own >> (8 * i));
  }
  auto seal = gravure::grv::decode_seal(front, "image");
  if (!seal) {
    return;
  }
  const auto chunks = static_cast<std::uint64_t>(seal.value().layout.chunks());
  const auto table = [&](std::uint64_t at) {
    std::vector<std::uint64_t> values;
    if (at <= image.size() && (image.size() - at) / 8 >= chunks) {
      values.resize(static_cast<std::size_t>(chunks));
      std::memcpy(values.data(), image.data() + at, 8 * values.size());
    }
    return values;
  };
  seal.value().tables_hash =
      gravure::grv::hash_tables({table(seal.value().offset_table_at), table(seal.value().stored_table_at)});
  const auto renewed = gravure::grv::encode_seal(seal.value());
  std::copy(renewed.begin(), renewed.end(), image.begin());
}

void unpack_anything(Bytes input) {
  using gravure::grv::Compression;
  constexpr Compression kAll[] = {Compression::zstd, Compression::deflate, Compression::none};
  const Compression compression = kAll[std::to_integer<std::size_t>(input[0]) % 3];
  const std::size_t size = 1 + std::to_integer<std::size_t>(input[1]) + 256 * std::to_integer<std::size_t>(input[2]);
  std::vector<std::byte> out(size);
  const auto unpacked = gravure::grv::unpack(compression, false, input.subspan(3), out);
  require(unpacked || !unpacked.error().message.empty());
  const auto packed = gravure::grv::pack(compression, 1, input);
  require(static_cast<bool>(packed));
  out.resize(input.size());
  require(static_cast<bool>(gravure::grv::unpack(compression, packed.value().raw, packed.value().bytes, out)));
  require(std::equal(out.begin(), out.end(), input.begin(), input.end()));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const Bytes input = std::as_bytes(std::span(data, size));
  if (size >= gravure::grv::Seal::kBytes && std::memcmp(data, "gravure", 7) == 0) {
    read_everything(input);
    std::vector<std::byte> renewed(input.begin(), input.end());
    renew_seal(renewed);
    read_everything(renewed);
  } else if (size >= 3) {
    unpack_anything(input);
  }
  return 0;
}
