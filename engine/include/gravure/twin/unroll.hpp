#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "gravure/core/progress.hpp"
#include "gravure/twin/exposure.hpp"

namespace gravure {

struct UnrollOptions {
  std::int64_t memory_bytes = std::int64_t{256} << 20;
  std::int64_t table_bytes = 0;  ///< of them for what the readers of the program hold together
  CancelToken* cancel = nullptr;
};

/// Takes rows of the unrolled picture from top to bottom: packed MSB first, 1 is white, unused low bits 0.
using RowSink = std::function<Result<void>(std::span<const std::byte> rows, std::int64_t count)>;

/// Size of the picture an unrolled revolution has: that of its source image.
struct UnrolledSize {
  std::int64_t width = 0;
  std::int64_t height = 0;
};
UnrolledSize unrolled_size(const ProgramHeader& header);

/// The budget that does for any picture of the program, its tables beside.
std::int64_t least_unroll_bytes(const LineSource& program);

/// Images the program shows: layers of the stack that are exposed at all.
std::int64_t image_layers(const ProgramHeader& header);

/// Which image each of header.layers shows, from 0 to image_layers(): several show the same one where there are bands
/// or passes in both directions of a stage. Empty in helical mode, where a revolution shows a part of every image.
std::vector<std::int64_t> images_of_layers(const ProgramHeader& header);

/// Runs one revolution (pass) on the device, where there are bands that of each, and gives what was exposed as the
/// source's picture: its size, orientation and polarity. Pictures whose lines run along columns are turned in parts
/// that fit the budget. bad_argument in helical mode, where no revolution shows a picture.
Result<void> unroll(LineSource& program, const DeviceFactory& devices, std::int64_t revolution, const RowSink& rows,
                    const UnrollOptions& options);

/// The same for image `layer`, from 0 to image_layers(): in helical mode its segment of all revolutions put together,
/// in others the first revolution that exposes it.
Result<void> unroll_layer(LineSource& program, const DeviceFactory& devices, std::int64_t layer, const RowSink& rows,
                          const UnrollOptions& options);

}  // namespace gravure
