#include "gravure/twin/unroll.hpp"

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "gravure/raster/place.hpp"
#include "gravure/raster/transpose.hpp"

namespace gravure {
namespace {

std::size_t size(std::int64_t bytes) {
  return static_cast<std::size_t>(bytes);
}

class Watcher final : public PinObserver {
 public:
  explicit Watcher(Landing& landing) : landing_(landing) {}
  void on_line(const ExecutedLine& line) override { misplaced_ = !landing_.take(line) || misplaced_; }
  bool misplaced() const { return misplaced_; }

 private:
  Landing& landing_;
  bool misplaced_ = false;
};

/// Runs a revolution chunk by chunk; `take(lines, first_line)` gets what landed, 1 = white.
template <class Take>
Result<void> run_revolution(LineSource& program, const DeviceFactory& devices, std::int64_t revolution,
                            const CancelToken* cancel, Take&& take) {
  const ProgramHeader& header = program.header();
  const Plan& plan = header.plan;
  Landing landing(plan);
  Watcher watcher(landing);
  const std::unique_ptr<DeviceLink> device = devices(watcher);
  GRAVURE_CHECK(device->configure(device_setup(plan, revolution, 0)));
  const std::int64_t layer = header.layer_of_revolution.at(size(revolution));
  const std::int64_t lines = plan.rotary.lines_per_revolution;
  ProgramChunk chunk;
  for (std::int64_t k = 0; k * program.lines_per_chunk() < lines; ++k) {
    if (cancel != nullptr && cancel->cancelled()) {
      return Error{ErrorCode::cancelled, "stopped before the picture was complete; nothing was written"};
    }
    GRAVURE_CHECK(chunk.load(program, {layer, k}));
    landing.start(chunk.lines());
    GRAVURE_CHECK(chunk.send(header, revolution, *device));
    if (watcher.misplaced() || landing.lines() != chunk.lines()) {
      return Error{ErrorCode::device, "revolution " + std::to_string(revolution) + ", lines from " +
                                          std::to_string(chunk.first_line()) +
                                          ": the device marked outside the window the plan gives"};
    }
    GRAVURE_CHECK(
        take(landing.turn_back(chunk.first_line(), line_is_reverse(plan, revolution, 0), header.fires == Fires::black),
             chunk.first_line(), chunk.lines()));
  }
  return {};
}

/// One band of a picture whose lines run along columns: bytes [first, first + width) of every line, turned into rows.
Result<void> unroll_band(LineSource& program, const DeviceFactory& devices, std::int64_t revolution,
                         std::int64_t first_byte, std::int64_t rows, const RowSink& sink, const CancelToken* cancel) {
  const ProgramHeader& header = program.header();
  const std::int64_t lines = header.plan.rotary.lines_per_revolution;
  const std::int64_t slab = raster::packed_bytes(rows);
  std::vector<std::byte> strip(size(lines * slab));
  GRAVURE_CHECK(
      run_revolution(program, devices, revolution, cancel,
                     [&](std::span<const std::byte> landed, std::int64_t first, std::int64_t count) -> Result<void> {
                       for (std::int64_t i = 0; i < count; ++i) {
                         std::memcpy(strip.data() + (first + i) * slab,
                                     landed.data() + i * header.line_bytes() + first_byte, size(slab));
                       }
                       return {};
                     }));
  std::vector<std::byte> turned(size(rows * raster::packed_bytes(lines)));
  raster::transpose(turned, strip, lines, rows);
  return sink(turned, rows);
}

/// Bytes of every line that a band may hold: it is held twice, before and after it is turned, beside a chunk as stored,
/// unpacked, turned, fired and landed.
Result<std::int64_t> fitting_band(const LineSource& program, const UnrollOptions& options) {
  constexpr std::int64_t kMiB = std::int64_t{1} << 20;
  const ProgramHeader& header = program.header();
  const std::int64_t fixed = 6 * kMiB + 6 * program.lines_per_chunk() * header.line_bytes();
  const std::int64_t a_byte = 2 * (header.plan.rotary.lines_per_revolution + 7);
  if (options.memory_bytes < fixed + a_byte) {
    return Error{ErrorCode::out_of_range, "memory budget of " + std::to_string(options.memory_bytes / kMiB) +
                                              " MiB: turning this picture needs at least " +
                                              std::to_string((fixed + a_byte + kMiB - 1) / kMiB) + " MiB"};
  }
  return std::clamp<std::int64_t>((options.memory_bytes - fixed) / a_byte, 1, header.line_bytes());
}

}  // namespace

UnrolledSize unrolled_size(const ProgramHeader& header) {
  const std::int64_t lines = header.plan.rotary.lines_per_revolution;
  const std::int64_t pixels = header.plan.line.pixels;
  return header.lines_along == LinesAlong::rows ? UnrolledSize{pixels, lines} : UnrolledSize{lines, pixels};
}

Result<void> unroll(LineSource& program, const DeviceFactory& devices, std::int64_t revolution, const RowSink& rows,
                    const UnrollOptions& options) {
  const ProgramHeader& header = program.header();
  const std::int64_t revolutions = header.plan.job.revolutions;
  if (revolution < 0 || revolution >= revolutions) {
    return Error{ErrorCode::out_of_range, "--revolution " + std::to_string(revolution) + ": the program has 0 to " +
                                              std::to_string(revolutions - 1)};
  }
  if (header.lines_along == LinesAlong::rows) {
    return run_revolution(
        program, devices, revolution, options.cancel,
        [&](std::span<const std::byte> landed, std::int64_t, std::int64_t count) { return rows(landed, count); });
  }
  GRAVURE_TRY(const std::int64_t band_bytes, fitting_band(program, options));
  const std::int64_t pixels = header.plan.line.pixels;
  for (std::int64_t byte = 0; byte < header.line_bytes(); byte += band_bytes) {
    const std::int64_t band_rows = std::min(pixels - byte * 8, band_bytes * 8);
    GRAVURE_CHECK(unroll_band(program, devices, revolution, byte, band_rows, rows, options.cancel));
  }
  return {};
}

}  // namespace gravure
