#pragma once

#include <cstdint>
#include <functional>

#include "gravure/core/image_source.hpp"
#include "gravure/core/program.hpp"
#include "gravure/core/progress.hpp"
#include "gravure/pipeline/layer_reader.hpp"

namespace gravure {

struct CompileOptions {
  static constexpr std::int64_t kDefaultMemoryBytes = std::int64_t{256} << 20;
  std::int64_t memory_bytes = kDefaultMemoryBytes;  ///< for all buffers together, whatever the size of the images
  int threads = 0;                                  ///< 0: one for each processor
  CancelToken* cancel = nullptr;
  Progress* progress = nullptr;  ///< told in lines
  /// Called when every chunk is put and the program is not finished yet: for what of the header takes long to find.
  std::function<Result<void>(ProgramHeader&)> complete_header = {};
};

/// Least memory a compile of this stack, whole images, takes with one worker; `stack.decoder_bytes` counts where it is
/// known.
std::int64_t least_compile_memory(const LayerStack& stack, std::int64_t lines_per_chunk);

/// One streaming pass: read -> bits -> time order (odd lines of the job mirrored when bidirectional) -> chunk -> sink.
/// `header.layers` has one entry for each layer of the stack (helical: for each revolution); their fired_pixels are
/// filled in, and the sink is finished. The program's bytes do not depend on `threads` or `memory_bytes`. The budget
/// holds for all that grows with the images: chunks, panels, what the readers of files hold, what waits to be written.
/// Fewer workers run where it does not suffice for all of them. Fails with out_of_range when the budget is too small
/// (naming what is needed), cancelled, or what reader and sink say.
Result<ProgramHeader> compile(ProgramHeader header, const LayerStack& stack, const ImageOpener& opener, LineSink& sink,
                              const CompileOptions& options);

}  // namespace gravure
