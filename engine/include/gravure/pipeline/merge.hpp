#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "gravure/core/program.hpp"
#include "gravure/core/progress.hpp"

namespace gravure {

/// A shard of a program, or a program (a shard of all revolutions).
struct MergePart {
  LineSource* lines = nullptr;
  std::string name;  ///< what errors call it
};

/// Which layer of the whole program a revolution exposes, and which image of the stack that layer comes from (0 for the
/// slices of a depth map). Asked for every revolution, one after the other from 0, it numbers as compiling does.
struct LayerNumber {
  std::uint32_t layer = 0;
  std::int64_t image = 0;
};
using LayerNumbering = std::function<LayerNumber(std::int64_t revolution)>;

/// Where the bits of a layer are found.
struct LayerPlace {
  std::size_t part = 0;
  std::int64_t layer = 0;  ///< of that part
};

/// A whole program made of parts.
struct MergedProgram {
  ProgramHeader header;
  std::vector<LayerPlace> layers;  ///< of each layer of the header
  std::vector<LayerPlace> bits;    ///< of each that is stored
};

/// Puts the headers of parts of one job together; that they have one plan and one job text is the caller's to see.
/// The order of the parts does not matter. Fails with bad_argument where revolutions are in no part or in two (naming
/// them), bad_file where a part has another image than the one before under the same name.
Result<MergedProgram> join_parts(std::span<const MergePart> parts, const LayerNumbering& number_of);

/// Finds layers that show the same picture, and lets them share their bits: those that fire equally often are hashed
/// chunk by chunk (XXH3, 128 bits, of the lines as the image has them) for as long as they agree, so that layers that
/// differ cost little.
Result<void> share_equal_bits(MergedProgram& merged, std::span<const MergePart> parts, CancelToken* cancel);

/// Can there be such layers? False where no two fire equally often, and in path programs, which have one.
bool may_share_bits(const ProgramHeader& header);

/// Copies the stored chunks, in the order in which compile() puts them, and finishes the sink, which takes
/// `merged.bits.size()` layers. The file is the one that a single compile of the job makes, byte for byte. A chunk
/// whose checksum does not hold is bad_file, with the name of its part.
Result<void> write_merged(const MergedProgram& merged, std::span<const MergePart> parts, LineSink& sink,
                          CancelToken* cancel, Progress* progress);

}  // namespace gravure
