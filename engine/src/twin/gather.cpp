#include "gather.hpp"

#include <algorithm>
#include <cstring>

#include "gravure/core/as_size.hpp"
#include "gravure/raster/place.hpp"

namespace gravure {
namespace {

/// The columns of a stretch that belong to the part.
Stretch cut(Stretch stretch, const ImagePart& part) {
  const std::int64_t before = std::max<std::int64_t>(0, part.first_column - stretch.first_column);
  const std::int64_t end = std::min(stretch.first_column + stretch.columns, part.end_column);
  stretch.first_pixel += before;
  stretch.first_column += before;
  stretch.columns = std::max<std::int64_t>(0, end - stretch.first_column);
  return stretch;
}

/// Windows only slide forward within a revolution, so its first and last line tell.
bool shows(const ExposureMap& map, std::int64_t revolution, std::int64_t index, const ImagePart& part) {
  const Stretch first = map.stretch(revolution, 0, index);
  const Stretch last = map.stretch(revolution, map.lines() - 1, index);
  return first.first_column < part.end_column && last.first_column + last.columns > part.first_column;
}

}  // namespace

Result<void> gather(LineSource& program, ChunkRun& runner, const Showing& showing, const ImagePart& part,
                    std::span<std::byte> out) {
  const ExposureMap map(program.header().plan);
  const std::int64_t line_bytes = program.header().line_bytes();
  const std::int64_t part_bytes = raster::packed_bytes(part.end_column - part.first_column);
  std::memset(out.data(), 0, out.size());
  for (const std::int64_t revolution : showing.revolutions) {
    if (!shows(map, revolution, showing.stretch, part)) {
      continue;
    }
    const bool backwards = map.runs_backwards(revolution);
    const std::int64_t first = map.image_line(revolution, backwards ? part.end_line - 1 : part.first_line);
    const std::int64_t end = first + part.end_line - part.first_line;
    for (std::int64_t chunk = first / program.lines_per_chunk(); chunk * program.lines_per_chunk() < end; ++chunk) {
      GRAVURE_TRY(const std::span<const std::byte> landed, runner.run(revolution, chunk, false));
      const std::int64_t from = std::max(first, runner.first_line());
      const std::int64_t to = std::min(end, runner.first_line() + runner.lines());
      for (std::int64_t line = from; line < to; ++line) {
        const Stretch stretch = cut(map.stretch(revolution, line, showing.stretch), part);
        if (stretch.columns > 0) {
          const std::int64_t at = map.image_line(revolution, line) - part.first_line;
          raster::place_line(out.subspan(as_size(at * part_bytes), as_size(part_bytes)),
                             stretch.first_column - part.first_column,
                             landed.subspan(as_size((line - runner.first_line()) * line_bytes), as_size(line_bytes)),
                             stretch.first_pixel, stretch.columns);
        }
      }
    }
  }
  return {};
}

}  // namespace gravure
