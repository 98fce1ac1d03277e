#include <xxhash.h>

#include <algorithm>
#include <map>
#include <utility>

#include "gravure/pipeline/merge.hpp"
#include "gravure/raster/place.hpp"

namespace gravure {
namespace {

/// Layers that agree as far as they were looked at.
using Group = std::vector<std::size_t>;
using Groups = std::vector<Group>;

/// Layers that fire equally often; a group of one is nothing to share.
Groups equally_bright(const std::vector<StoredLayer>& layers) {
  std::map<std::int64_t, Group> by_pulses;
  for (std::size_t layer = 0; layer < layers.size(); ++layer) {
    by_pulses[layers[layer].fired_pixels].push_back(layer);
  }
  Groups groups;
  for (auto& [pulses, group] : by_pulses) {
    if (group.size() > 1) {
      groups.push_back(std::move(group));
    }
  }
  return groups;
}

/// Reads chunks of layers as the images have them, whichever way their lines were stored.
class Pictures {
 public:
  Pictures(const MergedProgram& merged, std::span<const MergePart> parts)
      : merged_(merged), parts_(parts), per_chunk_(parts.front().lines->lines_per_chunk()) {
    const auto bytes = static_cast<std::size_t>(per_chunk_ * merged.header.line_bytes());
    stored_.resize(bytes);
    turned_.resize(bytes);
  }
  std::int64_t chunks() const { return (lines() + per_chunk_ - 1) / per_chunk_; }

  Result<std::pair<std::uint64_t, std::uint64_t>> hash(std::size_t layer, std::int64_t chunk) {
    const LayerPlace& place = merged_.layers[layer];
    LineSource& source = *parts_[place.part].lines;
    GRAVURE_TRY(const StoredChunk found, source.fetch({place.layer, chunk}));
    const std::int64_t count = std::min(per_chunk_, lines() - chunk * per_chunk_);
    const auto bytes = static_cast<std::size_t>(count * merged_.header.line_bytes());
    std::span<const std::byte> picture = std::span(stored_).first(bytes);
    GRAVURE_CHECK(source.decode(found, std::span(stored_).first(bytes)));
    // Lines alternate, so that which of them run backwards follows from the first and the number of the line.
    const bool odd_first = (chunk * per_chunk_ & 1) != 0;
    if (merged_.header.plan.line.bidirectional) {
      raster::place_rows(
          std::span(turned_).first(bytes), picture, merged_.header.plan.line.pixels, count,
          {.first_mirrored = merged_.header.layers[layer].starts_reverse != odd_first, .alternate = true});
      picture = std::span(turned_).first(bytes);
    }
    const XXH128_hash_t hash = XXH3_128bits(picture.data(), picture.size());
    return std::pair(hash.high64, hash.low64);
  }

 private:
  std::int64_t lines() const { return merged_.header.plan.rotary.lines_per_revolution; }

  const MergedProgram& merged_;
  std::span<const MergePart> parts_;
  std::int64_t per_chunk_;
  std::vector<std::byte> stored_;
  std::vector<std::byte> turned_;
};

/// Splits a group by one more chunk of its layers.
Result<Groups> split(const Group& group, std::int64_t chunk, Pictures& pictures) {
  std::map<std::pair<std::uint64_t, std::uint64_t>, Group> by_hash;
  for (const std::size_t layer : group) {
    GRAVURE_TRY(const auto hash, pictures.hash(layer, chunk));
    by_hash[hash].push_back(layer);
  }
  Groups groups;
  for (auto& [hash, part] : by_hash) {
    if (part.size() > 1) {
      groups.push_back(std::move(part));
    }
  }
  return groups;
}

/// Every layer of a group takes the bits of its first; what is stored is numbered as it is first used.
void share(MergedProgram& merged, const Groups& groups) {
  std::vector<StoredLayer>& layers = merged.header.layers;
  std::vector<std::size_t> first(layers.size());
  for (std::size_t layer = 0; layer < layers.size(); ++layer) {
    first[layer] = layer;
  }
  for (const Group& group : groups) {
    for (const std::size_t layer : group) {
      first[layer] = group.front();
      layers[layer].starts_reverse = layers[group.front()].starts_reverse;
    }
  }
  std::vector<std::uint32_t> number(layers.size());
  merged.bits.clear();
  merged.header.bits_of_layer.clear();
  for (std::size_t layer = 0; layer < layers.size(); ++layer) {
    if (first[layer] == layer) {
      number[layer] = static_cast<std::uint32_t>(merged.bits.size());
      merged.bits.push_back(merged.layers[layer]);
    }
    merged.header.bits_of_layer.push_back(number[first[layer]]);
  }
}

}  // namespace

bool may_share_bits(const ProgramHeader& header) {
  return !header.plan.path && !equally_bright(header.layers).empty();
}

Result<void> share_equal_bits(MergedProgram& merged, std::span<const MergePart> parts, CancelToken* cancel) {
  Groups groups = equally_bright(merged.header.layers);
  if (groups.empty()) {
    return {};
  }
  Pictures pictures(merged, parts);
  for (std::int64_t chunk = 0; chunk < pictures.chunks(); ++chunk) {
    Groups next;
    for (const Group& group : groups) {
      if (cancel != nullptr && cancel->cancelled()) {
        return Error{ErrorCode::cancelled, "stopped while equal layers were sought"};
      }
      GRAVURE_TRY(Groups parted, split(group, chunk, pictures));
      std::move(parted.begin(), parted.end(), std::back_inserter(next));
    }
    groups = std::move(next);
  }
  if (!groups.empty()) {
    share(merged, groups);
  }
  return {};
}

}  // namespace gravure
