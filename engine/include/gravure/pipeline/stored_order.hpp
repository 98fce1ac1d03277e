#pragma once

#include "gravure/core/program.hpp"

namespace gravure {

/// In which order the chunks of a program stand in its file. True: chunk 0 of every layer, then chunk 1 ... The slices
/// of a depth map are compiled so, because one decoding serves them all, and helical revolutions, which share their
/// images. False: layer by layer. It follows from the header alone, so that merged shards stand as one compile puts
/// them.
bool interleaves_layers(const ProgramHeader& header);

}  // namespace gravure
