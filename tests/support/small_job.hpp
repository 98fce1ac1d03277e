#pragma once

#include <gtest/gtest.h>

#include "gravure/emulator/emulated_device.hpp"
#include "gravure/pipeline/layer_reader.hpp"
#include "gravure/sync/make_plan.hpp"
#include "gravure/twin/verify.hpp"
#include "naive_compile.hpp"

/// Whole jobs in memory: planned, compiled, and run on the emulated board.
namespace gravure::test {

/// A small tube. Exact with the second accumulator; otherwise as close as the counter gets.
inline Job small_job(std::int64_t lines_per_revolution) {
  Job job;
  job.title = "small";
  job.laser = {.seed_hz = 82'000'000, .pulse_divider = 41, .max_pulse_on_demand_hz = 16'400'000};
  job.fpga = {.clock_multiplier = 2, .counter_bits = 32, .fractional = true, .max_prescaler = 1'000};
  job.scanner.pixel_pitch_um = 8;
  job.scanner.slots_per_microvector = 2;
  job.scanner.turn_slots = 30;
  job.scanner.bidirectional = true;
  job.scanner.bidirectional_offset_ticks = 200;
  job.rotary.circumference_mm = ratio(8 * lines_per_revolution, 1000);
  job.rotary.lines_per_revolution = lines_per_revolution;
  job.rotary.encoder_lines = 1'000;
  job.rotary.interpolation_bits = 2;
  job.rotary.max_ab_hz = 41'000'000;
  job.limits.seam_um = ratio(1, 2);
  return job;
}

struct SmallJob {
  Job job;
  MemoryImages images;
  LayerStack stack;
  MemoryProgram program;

  LayerLinesFactory lines() const {
    return [this]() -> Result<std::unique_ptr<LayerLines>> {
      return std::unique_ptr<LayerLines>(std::make_unique<LayerReader>(stack, images, 1 << 20));
    };
  }
};

/// Plans and compiles `stack`; revolution r shows layer (r mod layers), or the last one for ever when held.
inline void compile_job(SmallJob& small, std::int64_t revolutions, LayerOrder order, std::int64_t lines_per_chunk = 4) {
  Result<Plan> plan = make_plan(small.job, small.stack.pixels, revolutions);
  ASSERT_TRUE(plan) << plan.error().message;
  ProgramHeader header = header_for(small.stack, small.job.scanner.bidirectional);
  header.plan = std::move(plan).value();
  const auto layers = static_cast<std::int64_t>(small.stack.layers.size());
  header.layer_of_revolution.clear();
  std::vector<bool> seen(small.stack.layers.size());
  for (std::int64_t r = 0; r < revolutions; ++r) {
    const std::int64_t layer = layer_of_revolution(order, layers, r);
    header.layer_of_revolution.push_back(static_cast<std::uint32_t>(layer));
    if (!seen[static_cast<std::size_t>(layer)]) {
      header.layers[static_cast<std::size_t>(layer)].starts_reverse = line_is_reverse(header.plan, r, 0);
      seen[static_cast<std::size_t>(layer)] = true;
    }
  }
  for (std::size_t layer = 0; layer < header.layers.size(); ++layer) {
    header.layers[layer].source = small.stack.levels > 0 ? 0 : static_cast<std::int64_t>(layer);
    header.layers[layer].level = small.stack.layers[layer].level;
  }
  small.program.lines_per_chunk = lines_per_chunk;
  MemorySink sink(small.program);
  const Result<ProgramHeader> compiled = compile(header, small.stack, small.images, sink, {.threads = 2});
  ASSERT_TRUE(compiled) << compiled.error().message;
}

inline DeviceFactory emulated() {
  return [](PinObserver& pins) -> std::unique_ptr<LineDevice> {
    return std::make_unique<emulator::EmulatedDevice>(&pins);
  };
}

inline Result<VerifyReport> verify_job(const SmallJob& small, const LayerLinesFactory& images,
                                       const VerifyOptions& options = {}, const DeviceFactory& devices = emulated(),
                                       const MemorySource::Damage& damage = {}) {
  return verify(
      [&]() -> Result<std::unique_ptr<LineSource>> {
        return std::unique_ptr<LineSource>(std::make_unique<MemorySource>(small.program, damage));
      },
      devices, images, options);
}

}  // namespace gravure::test
