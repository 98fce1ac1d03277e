#include "layout.hpp"

#include <algorithm>

namespace gravure::grv {
namespace {

Result<void> check_size(const char* name, std::int64_t value, std::int64_t max) {
  if (value < 1 || value > max) {
    return Error{ErrorCode::out_of_range,
                 std::string(name) + " = " + std::to_string(value) + ": must be 1 to " + std::to_string(max)};
  }
  return {};
}

}  // namespace

std::int64_t Layout::lines_in(std::int64_t chunk) const {
  return std::min(lines_per_chunk, lines_per_layer - first_line(chunk));
}

bool Layout::contains(ChunkAddress address) const {
  return address.layer >= 0 && address.layer < layers && address.chunk >= 0 && address.chunk < chunks_per_layer();
}

std::size_t Layout::index_of(ChunkAddress address) const {
  return static_cast<std::size_t>(address.layer * chunks_per_layer() + address.chunk);
}

ChunkAddress Layout::address_of(std::size_t index) const {
  const auto position = static_cast<std::int64_t>(index);
  return {position / chunks_per_layer(), position % chunks_per_layer()};
}

std::string Layout::describe(ChunkAddress address) const {
  std::string text = "layer " + std::to_string(address.layer) + ", chunk " + std::to_string(address.chunk);
  if (contains(address)) {
    const std::int64_t first = first_line(address.chunk);
    text += " (lines " + std::to_string(first) + ".." + std::to_string(first + lines_in(address.chunk) - 1) + ")";
  }
  return text;
}

Result<void> check_layout(const Layout& layout) {
  GRAVURE_CHECK(check_size("layers", layout.layers, kMaxChunks));
  GRAVURE_CHECK(check_size("lines per layer", layout.lines_per_layer, std::int64_t{1} << 40));
  GRAVURE_CHECK(check_size("bytes per line", layout.line_bytes, kMaxChunkBytes));
  GRAVURE_CHECK(check_size("lines per chunk", layout.lines_per_chunk,
                           std::min(layout.lines_per_layer, kMaxChunkBytes / layout.line_bytes)));
  return check_size("chunks per layer", layout.chunks_per_layer(), kMaxChunks / layout.layers);
}

Result<Layout> make_layout(std::int64_t layers, std::int64_t lines_per_layer, std::int64_t line_bytes,
                           std::int64_t target_bytes) {
  Layout layout{layers, lines_per_layer, line_bytes, 1};
  GRAVURE_CHECK(check_size("bytes per line", line_bytes, kMaxChunkBytes));
  GRAVURE_CHECK(check_size("chunk_bytes", target_bytes, kMaxChunkBytes));
  GRAVURE_CHECK(check_size("lines per layer", lines_per_layer, std::int64_t{1} << 40));
  const std::int64_t most = std::clamp<std::int64_t>(target_bytes / line_bytes, 1, lines_per_layer);
  const std::int64_t chunks = (lines_per_layer + most - 1) / most;
  layout.lines_per_chunk = (lines_per_layer + chunks - 1) / chunks;
  GRAVURE_CHECK(check_layout(layout));
  return layout;
}

}  // namespace gravure::grv
