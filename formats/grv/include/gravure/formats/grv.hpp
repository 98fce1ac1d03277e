#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "gravure/core/error.hpp"
#include "gravure/core/program.hpp"

namespace gravure {

class FileOutput;

namespace grv {
struct OpenedProgram;
}

/// How a program file is stored. docs/formats/grv.md describes the file, docs/decisions/grv_integrity.md its checksums.
struct GrvOptions {
  enum class Compression : std::uint8_t {
    zstd,     ///< HDF5 filter 32015: fast and small; other programs need the hdf5plugin package to read the bits
    deflate,  ///< HDF5 filter 1: slower and larger, read by every HDF5 program
    none,     ///< the bits as they are
  };
  Compression compression = Compression::zstd;
  int zstd_level = 1;  ///< 1..19
  /// Target size of a chunk; a longer line is a chunk by itself. What is done to a chunk stays in the cache of one
  /// core.
  std::int64_t chunk_bytes = std::int64_t{1} << 18;
  bool focus_axis = false;  ///< the program follows a path and its set-points have W: known before its plan is
};

/// Starts a program file of `layers` layers with `lines_per_layer` lines of `line_bytes` bytes. The same chunks put in
/// the same order give the same file, byte for byte, whatever the number of threads that encoded them.
///
/// Layers that share bits (ProgramHeader::bits_of_layer) are one of the `layers` here. encode() refuses a chunk of the
/// wrong size (bad_argument). put() refuses a chunk out of place, put before, or of another size than encode() gave it
/// (bad_argument); a full disk is io. finish() refuses a missing chunk, a header that does not fit the chunks, fired
/// pixels that do not add up, and set bits beyond the last pixel of a line (bad_argument). Fails with out_of_range for
/// sizes below 1 or beyond 1 GiB a chunk, io where the file cannot be created.
Result<std::unique_ptr<LineSink>> create_grv(const std::string& path, std::int64_t layers, std::int64_t lines_per_layer,
                                             std::int64_t line_bytes, const GrvOptions& options = {});
/// The same, but finish() leaves the whole program at output.temporary_path(): there it can be read, and it is the
/// caller's to commit. `output` outlives the sink.
Result<std::unique_ptr<LineSink>> stage_grv(const FileOutput& output, std::int64_t layers, std::int64_t lines_per_layer,
                                            std::int64_t line_bytes, const GrvOptions& options = {});

/// Opens a program file and verifies everything in it but the bits, which decode() verifies chunk by chunk: any chunk
/// can be had without reading the others. Fails with io where the file cannot be read, bad_file where it is no program,
/// cut off, lengthened or altered (naming the first missing chunk where it is cut), version_mismatch for a format
/// version above kNewestFormatVersion.
Result<std::unique_ptr<LineSource>> open_grv(const std::string& path);

/// A program opened once for any number of readers: what is known of it, its tables of chunks above all, is held once.
class GrvProgram {
 public:
  /// open_grv(). Where the tables alone would not fit `memory_bytes`, out_of_range with what they take, before they are
  /// read.
  static Result<GrvProgram> open(const std::string& path, std::int64_t memory_bytes);

  const ProgramHeader& header() const noexcept;
  /// A reader, for one thread. It may live longer than this.
  std::unique_ptr<LineSource> reader() const;
  /// What the tables take, however many readers there are.
  std::int64_t table_bytes() const noexcept;

 private:
  explicit GrvProgram(std::shared_ptr<const grv::OpenedProgram> opened) : opened_(std::move(opened)) {}
  std::shared_ptr<const grv::OpenedProgram> opened_;
};

/// A program, or a shard of one (ProgramHeader::shard), and how its bits are stored.
struct GrvPart {
  std::unique_ptr<LineSource> lines;
  GrvOptions::Compression compression = GrvOptions::Compression::zstd;
};
/// Opens a program or a shard; open_grv() refuses shards with bad_file. Errors: those of open_grv().
Result<GrvPart> open_grv_part(const std::string& path);

/// For a process that uses HDF5 through this library alone, before anything else of it: HDF5 is not taken down when the
/// process ends. That costs 0.7 million instructions; what it would free ends with the process, and files of ours are
/// closed long before.
void leave_hdf5_to_exit();

}  // namespace gravure
