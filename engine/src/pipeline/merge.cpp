#include "gravure/pipeline/merge.hpp"

#include <xxhash.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include "gravure/pipeline/stored_order.hpp"

namespace gravure {
namespace {

Shard range_of(const ProgramHeader& header) {
  return header.shard.value_or(Shard{0, header.plan.job.revolutions, 1});
}

std::string name_range(std::int64_t first, std::int64_t end) {
  return end - first == 1 ? "revolution " + std::to_string(first)
                          : "revolutions " + std::to_string(first) + " to " + std::to_string(end - 1);
}

Error missing(std::int64_t first, std::int64_t end) {
  return {ErrorCode::bad_argument, name_range(first, end) + " of the job " + (end - first == 1 ? "is" : "are") +
                                       " in none of the shards: compile with --revolutions " + std::to_string(first) +
                                       ":" + std::to_string(end)};
}

/// The parts by their first revolution; every revolution is in exactly one of them.
Result<std::vector<std::size_t>> in_order(std::span<const MergePart> parts) {
  std::vector<std::size_t> order(parts.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto range = [&](std::size_t part) { return range_of(parts[part].lines->header()); };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return range(a).first < range(b).first; });
  std::int64_t next = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Shard now = range(order[i]);
    if (now.first < next) {
      const std::string& before = parts[order[i - 1]].name;
      return Error{ErrorCode::bad_argument, name_range(now.first, std::min(next, now.end)) + ": in " + before +
                                                " and in " + parts[order[i]].name + ": leave one of them out"};
    }
    if (now.first > next) {
      return missing(next, now.first);
    }
    next = now.end;
  }
  const std::int64_t all = parts[order.front()].lines->header().plan.job.revolutions;
  if (next < all) {
    return missing(next, all);
  }
  return order;
}

bool same_file(const SourceImage& a, const SourceImage& b) {
  return a.path == b.path && a.page == b.page && a.width == b.width && a.height == b.height && a.sha256 == b.sha256;
}

/// The images of all parts, numbered as their layers are first used.
class Sources {
 public:
  explicit Sources(std::vector<SourceImage>& all) : all_(all) {}

  Result<std::int64_t> of_image(std::int64_t image, const SourceImage& source, const std::string& part) {
    const auto [row, is_new] = rows_.try_emplace(image, static_cast<std::int64_t>(all_.size()));
    if (is_new) {
      all_.push_back(source);
    } else if (const SourceImage& known = all_[static_cast<std::size_t>(row->second)]; !same_file(known, source)) {
      return Error{ErrorCode::bad_file, part + ": its image " + source.path + " is not the one of the shards before (" +
                                            known.path + ", SHA-256 " + known.sha256.substr(0, 12) + ", here " +
                                            source.sha256.substr(0, 12) +
                                            "): it changed between the two: compile them from the same images"};
    }
    return row->second;
  }

 private:
  std::vector<SourceImage>& all_;
  std::map<std::int64_t, std::int64_t> rows_;  // image of the stack -> row
};

/// Helical: every part names all images of the job.
Result<void> take_all_sources(const std::vector<SourceImage>& sources, Sources& known, const std::string& part) {
  for (std::size_t image = 0; image < sources.size(); ++image) {
    GRAVURE_CHECK(known.of_image(static_cast<std::int64_t>(image), sources[image], part));
  }
  return {};
}

Result<void> add_part(const MergePart& part, std::size_t index, const LayerNumbering& number_of, Sources& sources,
                      MergedProgram& merged) {
  const ProgramHeader& header = part.lines->header();
  if (header.plan.carriage) {
    GRAVURE_CHECK(take_all_sources(header.sources, sources, part.name));
  }
  for (std::size_t r = 0; r < header.layer_of_revolution.size(); ++r) {
    const LayerNumber number = number_of(header.first_revolution() + static_cast<std::int64_t>(r));
    const std::uint32_t local = header.layer_of_revolution[r];
    merged.header.layer_of_revolution.push_back(number.layer);
    StoredLayer layer = header.layers[local];
    if (!header.plan.carriage && !header.sources.empty()) {
      GRAVURE_TRY(layer.source,
                  sources.of_image(number.image, header.sources[static_cast<std::size_t>(layer.source)], part.name));
    }
    if (number.layer == merged.layers.size()) {  // else an earlier one has its bits
      merged.header.layers.push_back(layer);
      merged.layers.push_back({index, local});
    }
  }
  return {};
}

/// A chunk that is passed on as it lies in its part: nobody unpacks it, so its checksum is looked at here.
Result<StoredChunk> fetch_sound(const MergePart& part, ChunkAddress address) {
  GRAVURE_TRY(StoredChunk chunk, part.lines->fetch(address));
  if (XXH3_64bits(chunk.bytes.data(), chunk.bytes.size()) != chunk.checksum) {
    return Error{ErrorCode::bad_file,
                 part.name + ": layer " + std::to_string(address.layer) + ", chunk " + std::to_string(address.chunk) +
                     ": altered, its checksum does not hold: get a good copy, or compile it again"};
  }
  return chunk;
}

}  // namespace

bool interleaves_layers(const ProgramHeader& header) {
  return header.plan.carriage || std::any_of(header.layers.begin(), header.layers.end(),
                                             [](const StoredLayer& layer) { return layer.level > 0; });
}

Result<MergedProgram> join_parts(std::span<const MergePart> parts, const LayerNumbering& number_of) {
  if (parts.empty()) {
    return Error{ErrorCode::bad_argument, "there is no shard to merge"};
  }
  GRAVURE_TRY(const std::vector<std::size_t> order, in_order(parts));
  MergedProgram merged;
  merged.header = parts[order.front()].lines->header();
  merged.header.shard.reset();
  merged.header.sources.clear();
  merged.header.layers.clear();
  merged.header.layer_of_revolution.clear();
  merged.header.bits_of_layer.clear();
  Sources sources(merged.header.sources);
  for (const std::size_t part : order) {
    GRAVURE_CHECK(add_part(parts[part], part, number_of, sources, merged));
  }
  merged.bits = merged.layers;
  return merged;
}

Result<void> write_merged(const MergedProgram& merged, std::span<const MergePart> parts, LineSink& sink,
                          CancelToken* cancel, Progress* progress) {
  const std::int64_t lines = merged.header.plan.rotary.lines_per_revolution;
  const std::int64_t per_chunk = sink.lines_per_chunk();
  const std::int64_t chunks = (lines + per_chunk - 1) / per_chunk;
  const auto layers = static_cast<std::int64_t>(merged.bits.size());
  const bool interleaved = interleaves_layers(merged.header);
  for (std::int64_t i = 0; i < layers * chunks; ++i) {
    if (cancel != nullptr && cancel->cancelled()) {
      return Error{ErrorCode::cancelled, "stopped before the program was complete; nothing was written"};
    }
    const ChunkAddress to = interleaved ? ChunkAddress{i % layers, i / layers} : ChunkAddress{i / chunks, i % chunks};
    const LayerPlace& from = merged.bits[static_cast<std::size_t>(to.layer)];
    GRAVURE_TRY(StoredChunk chunk, fetch_sound(parts[from.part], {from.layer, to.chunk}));
    chunk.address = to;
    GRAVURE_CHECK(sink.put(chunk));
    if (progress != nullptr) {
      progress->update(i + 1, layers * chunks);
    }
  }
  return sink.finish(merged.header);
}

}  // namespace gravure
