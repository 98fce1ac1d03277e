#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gravure/core/error.hpp"
#include "gravure/core/job.hpp"
#include "gravure/core/plan.hpp"

namespace gravure {

/// One input image as it was compiled.
struct SourceImage {
  std::string path;  ///< relative to the job file where it can be
  std::int64_t page = 0;
  std::int64_t width = 0;
  std::int64_t height = 0;
  std::string sha256;  ///< of the file, lower-case hex
};

/// A stored layer: the pulse decisions of one revolution, once, however often it is exposed.
struct StoredLayer {
  /// Its lines stand in time order for a revolution whose line 0 runs right to left. On a revolution that starts the
  /// other way every line is to be mirrored when read.
  bool starts_reverse = false;
  std::int64_t fired_pixels = 0;
  std::int64_t source = 0;  ///< index into ProgramHeader::sources
  std::int64_t level = 0;   ///< depth maps: which slice of the source; else 0
};

/// The orders to the scanner, one for each microvector, of all lines that run one way. Counts are signed, 0 is the
/// centre of the field, 2^resolution_bits of them make the field; in turns they may lie beyond it.
struct LineSetPoints {
  bool reverse = false;    ///< lines that run right to left
  bool backwards = false;  ///< lines of the passes in which the stage of a flat job comes back
  std::vector<std::int32_t> u_counts;
  std::vector<std::int32_t> v_counts;
};

/// Every program whose plan describes the scanner has the set-points of these lines, in this order, or none at all.
inline std::vector<LineSetPoints> kinds_of_lines(const Plan& plan) {
  std::vector<LineSetPoints> kinds;
  for (const bool backwards : {false, true}) {
    for (const bool reverse : {false, true}) {
      if ((!reverse || plan.line.bidirectional) &&
          (!backwards || (plan.mode == Mode::flat && plan.job.revolutions > 1))) {
        kinds.push_back({reverse, backwards, {}, {}});
      }
    }
  }
  return kinds;
}

/// Where the axes of a path program are ordered to stand at the start of a line, in the counts of the plan's path.
struct PathSetPoint {
  std::array<std::int64_t, kPathAxes.size()> counts{};  ///< W is 0 where the plan has none
  std::int64_t along_counts = 0;

  friend bool operator==(const PathSetPoint&, const PathSetPoint&) = default;
};

/// A point of the path that the light is wanted on, in the frame of the workpiece; straight between two of them.
struct PathTarget {
  double along_mm = 0;  ///< never less than the one before
  std::array<double, 3> position_mm{};
  std::array<double, 3> normal{0, 0, 1};  ///< of the surface, towards the head, length 1
};

/// Set-points of a path program: one at the start of each line and one at the end of the last; 0 for other programs.
inline std::int64_t set_points_of(const Plan& plan) {
  return plan.path ? plan.rotary.lines_per_revolution + 1 : 0;
}

/// A part of a job: its revolutions first, first + 1, ... end - 1.
struct Shard {
  std::int64_t first = 0;
  std::int64_t end = 0;
  std::int64_t image_layers = 0;  ///< of the job's whole image stack: with it every revolution knows its layer
  friend bool operator==(const Shard&, const Shard&) = default;
};

/// Programs with a focus axis have format version 2, all others 1: what an older gravure can read it can still read.
inline constexpr std::uint32_t kFocusAxisFormatVersion = 2;
inline constexpr std::uint32_t kNewestFormatVersion = kFocusAxisFormatVersion;
inline std::uint32_t format_version_of(const Plan& plan) {
  return plan.path && plan.path->has_focus_axis() ? kFocusAxisFormatVersion : 1;
}

/// Everything in a program but the bits of its lines.
struct ProgramHeader {
  std::uint32_t format_version = 1;  ///< as read; a sink writes format_version_of()
  Plan plan;
  std::string job_text;  ///< the job file, byte for byte
  std::string job_path;
  Fires fires = Fires::white;
  LinesAlong lines_along = LinesAlong::rows;
  std::vector<SourceImage> sources;
  /// What the job names beside its images: field grid, machine file (page and pixels 0). Path programs have all of
  /// their files in `sources`; none: the job names none, or the program is older than this.
  std::vector<SourceImage> files;
  std::vector<StoredLayer> layers;
  std::vector<std::uint32_t> layer_of_revolution;
  /// Where layers show the same picture, its bits are kept once: which stored bits are those of each layer, numbered as
  /// they are first used. Empty: every layer has its own. A LineSource takes and gives layers, never stored bits.
  std::vector<std::uint32_t> bits_of_layer;
  /// A shard holds these revolutions of its job alone: layer_of_revolution begins with the first of them.
  std::optional<Shard> shard;
  std::vector<LineSetPoints> set_points;  ///< none: the plan has no scanner, or the program is older than these

  /// Bytes of the marking window of one line: pixels packed MSB first in time order, 1 fires, unused low bits of the
  /// last byte 0.
  std::int64_t line_bytes() const { return (plan.line.pixels + 7) / 8; }
  std::int64_t first_revolution() const { return shard ? shard->first : 0; }
};

/// A run of whole lines of one layer, the unit of storage, compression and checksums.
struct ChunkAddress {
  std::int64_t layer = 0;
  std::int64_t chunk = 0;
};

/// A chunk as it lies in the file.
struct StoredChunk {
  ChunkAddress address;
  std::vector<std::byte> bytes;  ///< compressed, or raw where that did not pay
  std::uint32_t filter_mask = 0;
  std::uint64_t checksum = 0;  ///< XXH3-64 of `bytes`
  std::int64_t fired_pixels = 0;
};

/// Takes the lines of a program. encode() may be called from any thread; put() and finish() from one at a time.
/// Nothing stands at the target path until finish() has succeeded; a sink destroyed before leaves nothing behind.
class LineSink {
 public:
  virtual ~LineSink() = default;
  virtual std::int64_t lines_per_chunk() const noexcept = 0;
  /// Packs a chunk: `lines` holds its lines (line_bytes() each), lines_per_chunk() of them or what is left of the
  /// layer.
  virtual Result<StoredChunk> encode(ChunkAddress address, std::span<const std::byte> lines) const = 0;
  virtual Result<void> put(const StoredChunk& chunk) = 0;
  /// Path programs: the set-points and the wanted points that follow those put before. finish() refuses a program in
  /// which their number is not the plan's.
  virtual Result<void> put_set_points(std::span<const PathSetPoint> /*next*/) {
    return Error{ErrorCode::bad_argument, "this sink takes no programs that follow a path"};
  }
  virtual Result<void> put_targets(std::span<const PathTarget> /*next*/) {
    return Error{ErrorCode::bad_argument, "this sink takes no programs that follow a path"};
  }
  /// Writes the header (now complete, with fired pixels) and puts the file in its place.
  virtual Result<void> finish(const ProgramHeader& header) = 0;
};

/// Gives the lines of a program. fetch() takes one caller at a time by itself; decode() may run on any thread.
class LineSource {
 public:
  virtual ~LineSource() = default;
  virtual const ProgramHeader& header() const noexcept = 0;
  virtual std::int64_t lines_per_chunk() const noexcept = 0;
  virtual Result<StoredChunk> fetch(ChunkAddress address) = 0;
  /// Verifies the checksum and unpacks; `out` takes the chunk's lines. bad_file names the chunk's address.
  virtual Result<void> decode(const StoredChunk& chunk, std::span<std::byte> out) const = 0;
  /// Path programs: set-points (set_points_of() in all) and wanted points (plan.path->targets) from `first` on into
  /// all of `out`, checksums verified; one caller at a time, with fetch(), cheapest in order.
  virtual Result<void> read_set_points(std::int64_t /*first*/, std::span<PathSetPoint> /*out*/) {
    return Error{ErrorCode::bad_argument, "this source has no set-points of a path"};
  }
  virtual Result<void> read_targets(std::int64_t /*first*/, std::span<PathTarget> /*out*/) {
    return Error{ErrorCode::bad_argument, "this source has no points of a path"};
  }
};

}  // namespace gravure
