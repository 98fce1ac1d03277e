#include "gravure/twin/unroll.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "chunk_run.hpp"
#include "gather.hpp"
#include "gravure/core/as_size.hpp"
#include "gravure/core/exposure_map.hpp"
#include "gravure/core/units.hpp"
#include "gravure/raster/place.hpp"
#include "gravure/raster/transpose.hpp"

namespace gravure {
namespace {

bool columns_are_lines(const ProgramHeader& header) {
  return header.lines_along == LinesAlong::columns;
}

/// Ones become zeros and zeros ones, but for the unused bits of each row.
void invert(std::span<std::byte> rows, std::int64_t width) {
  const std::int64_t bytes = raster::packed_bytes(width);
  std::for_each(rows.begin(), rows.end(), [](std::byte& byte) { byte = ~byte; });
  const auto used = static_cast<std::byte>(0xFFU << static_cast<unsigned>(8 * bytes - width));
  for (std::size_t last = as_size(bytes) - 1; last < rows.size(); last += as_size(bytes)) {
    rows[last] &= used;
  }
}

/// Runs a revolution that shows a whole image, chunk by chunk.
Result<void> unroll_lines(LineSource& program, const DeviceFactory& devices, std::int64_t revolution,
                          const RowSink& rows, const CancelToken* cancel) {
  const ProgramHeader& header = program.header();
  ChunkRun runner(program, devices, cancel);
  for (std::int64_t k = 0; k * program.lines_per_chunk() < header.plan.rotary.lines_per_revolution; ++k) {
    GRAVURE_TRY(const std::span<const std::byte> landed, runner.run(revolution, k, header.fires == Fires::black));
    GRAVURE_CHECK(rows(landed, runner.lines()));
  }
  return {};
}

/// What unrolling takes beside the part of the picture: a chunk as stored, unpacked, turned, fired and landed, library
/// and codec.
std::int64_t fixed_bytes(const LineSource& program) {
  return 6 * kMiB + 6 * program.lines_per_chunk() * program.header().line_bytes();
}

/// What a picture is put together of: its line, or eight rows (a byte of each line) before and after they are turned.
std::int64_t unit_bytes(const ProgramHeader& header) {
  return columns_are_lines(header) ? 2 * (header.plan.rotary.lines_per_revolution + 7)
                                   : raster::packed_bytes(image_columns(header.plan));
}

/// How many of `all` units of the picture fit the budget; at least one must.
Result<std::int64_t> fitting(const LineSource& program, const UnrollOptions& options, std::int64_t all) {
  const std::int64_t unit = unit_bytes(program.header());
  const std::int64_t fixed = options.table_bytes + fixed_bytes(program);
  if (options.memory_bytes < fixed + unit) {
    return Error{ErrorCode::out_of_range, "memory budget of " + std::to_string(options.memory_bytes / kMiB) +
                                              " MiB: turning this picture needs at least " +
                                              std::to_string(whole_mib(fixed + unit)) + " MiB"};
  }
  return std::clamp<std::int64_t>((options.memory_bytes - fixed) / unit, 1, all);
}

/// Puts the picture together line by line, as many at a time as fit the budget.
Result<void> gather_lines(LineSource& program, ChunkRun& runner, const Showing& showing, const RowSink& rows,
                          const UnrollOptions& options) {
  const ProgramHeader& header = program.header();
  const std::int64_t columns = image_columns(header.plan);
  const std::int64_t all = header.plan.rotary.lines_per_revolution;
  const std::int64_t bytes = raster::packed_bytes(columns);
  GRAVURE_TRY(const std::int64_t fit, fitting(program, options, all));
  const std::int64_t block = std::min(fit, std::max<std::int64_t>(1, program.lines_per_chunk()));
  std::vector<std::byte> lines(as_size(block * bytes));
  for (std::int64_t first = 0; first < all; first += block) {
    const std::int64_t count = std::min(block, all - first);
    const std::span<std::byte> out = std::span(lines).first(as_size(count * bytes));
    GRAVURE_CHECK(gather(program, runner, showing, {first, first + count, 0, columns}, out));
    if (header.fires == Fires::black) {
      invert(out, columns);
    }
    GRAVURE_CHECK(rows(out, count));
  }
  return {};
}

/// A picture whose lines run along columns: as many of its rows as fit the budget, twice, before and after they are
/// turned.
Result<void> gather_columns(LineSource& program, ChunkRun& runner, const Showing& showing, const RowSink& rows,
                            const UnrollOptions& options) {
  const ProgramHeader& header = program.header();
  const std::int64_t columns = image_columns(header.plan);
  const std::int64_t lines = header.plan.rotary.lines_per_revolution;
  GRAVURE_TRY(const std::int64_t fit, fitting(program, options, raster::packed_bytes(columns)));
  for (std::int64_t first = 0; first < columns; first += 8 * fit) {
    const std::int64_t count = std::min(8 * fit, columns - first);
    std::vector<std::byte> strip(as_size(lines * raster::packed_bytes(count)));
    GRAVURE_CHECK(gather(program, runner, showing, {0, lines, first, first + count}, strip));
    std::vector<std::byte> turned(as_size(count * raster::packed_bytes(lines)));
    raster::transpose(turned, strip, lines, count);
    if (header.fires == Fires::black) {
      invert(turned, lines);
    }
    GRAVURE_CHECK(rows(turned, count));
  }
  return {};
}

Result<void> unroll_showing(LineSource& program, const DeviceFactory& devices, const Showing& showing,
                            const RowSink& rows, const UnrollOptions& options) {
  ChunkRun runner(program, devices, options.cancel);
  return columns_are_lines(program.header()) ? gather_columns(program, runner, showing, rows, options)
                                             : gather_lines(program, runner, showing, rows, options);
}

/// The revolutions that show the image of `revolution`: the same one of every band.
Showing showing_with(const Plan& plan, std::int64_t revolution) {
  Showing showing;
  const std::int64_t each = revolutions_per_band(plan);
  for (std::int64_t r = revolution % each; r < plan.job.revolutions; r += each) {
    showing.revolutions.push_back(r);
  }
  return showing;
}

Result<void> check_index(const char* option, std::int64_t value, std::int64_t count) {
  if (value < 0 || value >= count) {
    return Error{ErrorCode::out_of_range, std::string(option) + " " + std::to_string(value) +
                                              ": the program has 0 to " + std::to_string(count - 1)};
  }
  return {};
}

}  // namespace

UnrolledSize unrolled_size(const ProgramHeader& header) {
  const std::int64_t lines = header.plan.rotary.lines_per_revolution;
  const std::int64_t columns = image_columns(header.plan);
  return columns_are_lines(header) ? UnrolledSize{lines, columns} : UnrolledSize{columns, lines};
}

std::int64_t least_unroll_bytes(const LineSource& program) {
  return fixed_bytes(program) + unit_bytes(program.header());
}

std::int64_t image_layers(const ProgramHeader& header) {
  if (header.plan.carriage) {
    return header.plan.carriage->layers;
  }
  const std::vector<std::int64_t> images = images_of_layers(header);
  return images.empty() ? 0 : 1 + *std::max_element(images.begin(), images.end());
}

std::vector<std::int64_t> images_of_layers(const ProgramHeader& header) {
  std::vector<std::int64_t> images;
  if (header.plan.carriage) {
    return images;
  }
  std::map<std::pair<std::int64_t, std::int64_t>, std::int64_t> known;  // source and level, as they are first shown
  for (const StoredLayer& layer : header.layers) {
    const auto next = static_cast<std::int64_t>(known.size());
    images.push_back(known.try_emplace({layer.source, layer.level}, next).first->second);
  }
  return images;
}

Result<void> unroll(LineSource& program, const DeviceFactory& devices, std::int64_t revolution, const RowSink& rows,
                    const UnrollOptions& options) {
  const ProgramHeader& header = program.header();
  if (header.plan.carriage) {
    return Error{ErrorCode::bad_argument,
                 "--revolution " + std::to_string(revolution) +
                     ": a revolution of a helical program shows a part of each layer; give --layer, 0 to " +
                     std::to_string(header.plan.carriage->layers - 1)};
  }
  GRAVURE_CHECK(check_index("--revolution", revolution, header.plan.job.revolutions));
  if (ExposureMap(header.plan).whole_images() && !columns_are_lines(header)) {
    return unroll_lines(program, devices, revolution, rows, options.cancel);
  }
  return unroll_showing(program, devices, showing_with(header.plan, revolution), rows, options);
}

Result<void> unroll_layer(LineSource& program, const DeviceFactory& devices, std::int64_t layer, const RowSink& rows,
                          const UnrollOptions& options) {
  const Plan& plan = program.header().plan;
  GRAVURE_CHECK(check_index("--layer", layer, image_layers(program.header())));
  if (!plan.carriage) {
    return unroll(program, devices, layer, rows, options);  // every order shows them one after the other
  }
  Showing showing;
  showing.stretch = plan.carriage->layers - 1 - layer;
  for (std::int64_t r = 0; r < plan.job.revolutions; ++r) {
    showing.revolutions.push_back(r);
  }
  return unroll_showing(program, devices, showing, rows, options);
}

}  // namespace gravure
