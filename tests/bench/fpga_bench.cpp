#include <benchmark/benchmark.h>

#include <cstdint>
#include <vector>

#include "gravure/emulator/emulated_device.hpp"
#include "gravure/fpga/ab_counter.hpp"
#include "gravure/fpga/ab_edges.hpp"
#include "gravure/fpga/pulse_gate.hpp"

namespace {

using namespace gravure;

/// Clocks of one iteration: enough for some edges at every increment.
constexpr std::uint64_t kCounterClocks = 1'000'000;

fpga::AbRegisters registers_of(const benchmark::State& state) {
  fpga::AbRegisters registers{.bits = 32, .increment = static_cast<std::uint64_t>(state.range(0))};
  if (state.range(1) == 1) {
    registers.fraction_num = 1'000'003;
    registers.fraction_den = 4'405'634'541;
  } else if (state.range(1) == 2) {  // P and Q need more than 64 bits
    registers.fraction_num = 1'000'003;
    registers.fraction_den = ~std::uint64_t{0};
  }
  return registers;
}

void add_clock_rate(benchmark::State& state, std::uint64_t clocks) {
  state.counters["clocks/s"] = benchmark::Counter(static_cast<double>(clocks), benchmark::Counter::kIsRate);
}

/// Both consume each edge in the same way: a hash of (clock, pins).
struct Consumer {
  std::uint64_t hash = 0;
  void operator()(std::uint64_t clock, fpga::AbPins pins) {
    hash = hash * 3 + clock * 4 + (pins.a ? 2U : 0U) + (pins.b ? 1U : 0U);
  }
};

void clock_by_clock(benchmark::State& state) {
  auto counter = fpga::AbCounter::make(registers_of(state));
  Consumer consumer;
  fpga::AbPins before;
  std::uint64_t clocks = 0;
  for (auto _ : state) {
    for (std::uint64_t count = 0; count < kCounterClocks; ++count) {
      const fpga::AbPins now = counter->step();
      if (!(now == before)) {
        consumer(counter->clock(), now);
        before = now;
      }
    }
    clocks += kCounterClocks;
  }
  benchmark::DoNotOptimize(consumer.hash);
  add_clock_rate(state, clocks);
}

/// 2^20 edges' worth of clocks an iteration.
void edge_by_edge(benchmark::State& state) {
  auto edges = fpga::AbEdges::make(registers_of(state));
  const std::uint64_t span = ((std::uint64_t{1} << 50U) / static_cast<std::uint64_t>(state.range(0)));
  Consumer consumer;
  std::uint64_t clocks = 0;
  for (auto _ : state) {
    clocks += span;
    edges->run_to(clocks, [&consumer](const fpga::AbEdge& edge) { consumer(edge.clock, edge.pins); });
  }
  benchmark::DoNotOptimize(consumer.hash);
  add_clock_rate(state, clocks);
  state.counters["edges/s"] = benchmark::Counter(static_cast<double>(edges->edges()), benchmark::Counter::kIsRate);
}

void increments(benchmark::internal::Benchmark* bench) {
  bench->ArgNames({"increment", "fraction"});
  for (const std::int64_t increment : {std::int64_t{77}, std::int64_t{1} << 21U, std::int64_t{700'000'000},
                                       (std::int64_t{1} << 30U) - 1, std::int64_t{1} << 30U}) {
    bench->Args({increment, 0});
    if (increment < std::int64_t{1} << 30U) {
      bench->Args({increment, 1});
      bench->Args({increment, 2});
    }
  }
}
BENCHMARK(clock_by_clock)->Apply(increments);
BENCHMARK(edge_by_edge)->Apply(increments);

void gate_lines(benchmark::State& state) {
  const auto slots = static_cast<std::uint32_t>(state.range(0));
  std::vector<std::byte> bits(fpga::packed_bytes(slots), std::byte{0xA8});
  std::vector<std::byte> fired(bits.size());
  for (auto _ : state) {
    fpga::gate_line(bits, slots, false, fired);
    benchmark::DoNotOptimize(fired.data());
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations());
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations() * bits.size()));
}
BENCHMARK(gate_lines)->Arg(3500)->Arg(100'000);

class LastLine final : public PinObserver {
 public:
  void on_line(const ExecutedLine& line) override { edges += line.axis_at_start.edges; }
  std::uint64_t edges = 0;
};

void send_lines(benchmark::State& state) {
  const DeviceSetup setup{.counter_bits = 32,
                          .prescaler = 3,
                          .increment = 141'835'289,
                          .fraction_num = static_cast<std::uint64_t>(state.range(0)),
                          .fraction_den = 4'405'634'541,
                          .ticks_per_slot = 82,
                          .slots_per_line = 3909,
                          .window_slots = 3500,
                          .lines_per_revolution = 27'489};
  const std::vector<std::byte> bits(fpga::packed_bytes(3500), std::byte{0xF0});
  std::vector<LineFrame> frames;  // signing them is the host's part of the work
  for (std::int64_t line = 0; line < setup.lines_per_revolution; ++line) {
    frames.push_back({.line = line, .first_slot = 200, .bits = bits});
    frames.back().crc32c = frame_crc32c(frames.back());
  }
  LastLine observer;
  emulator::EmulatedDevice device(&observer);
  std::size_t next = frames.size();
  for (auto _ : state) {
    if (next == frames.size()) {
      next = 0;
      if (!device.configure(setup)) {
        state.SkipWithError("the device refused its registers");
        break;
      }
    }
    if (!device.send(frames[next++])) {
      state.SkipWithError("the device refused a frame");
      break;
    }
  }
  benchmark::DoNotOptimize(observer.edges);
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(send_lines)->ArgName("fraction")->Arg(0)->Arg(1'000'003);

void checksum_lines(benchmark::State& state) {
  const std::vector<std::byte> bits(fpga::packed_bytes(3500), std::byte{0xF0});
  const LineFrame frame{.first_slot = 200, .bits = bits};
  for (auto _ : state) {
    benchmark::DoNotOptimize(frame_crc32c(frame));
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(checksum_lines);

}  // namespace
