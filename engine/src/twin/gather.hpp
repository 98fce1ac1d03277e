#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "chunk_run.hpp"
#include "gravure/core/exposure_map.hpp"

namespace gravure {

/// The revolutions and stretches that show one image of a program.
struct Showing {
  std::vector<std::int64_t> revolutions;
  std::int64_t stretch = 0;  ///< which one of each line
};

/// Part of an image: lines [first_line, end_line), columns [first_column, end_column).
struct ImagePart {
  std::int64_t first_line = 0;
  std::int64_t end_line = 0;
  std::int64_t first_column = 0;
  std::int64_t end_column = 0;
};

/// Runs what shows the part and puts it together: `out` takes its lines, packed, a one where something fired.
Result<void> gather(LineSource& program, ChunkRun& runner, const Showing& showing, const ImagePart& part,
                    std::span<std::byte> out);

}  // namespace gravure
