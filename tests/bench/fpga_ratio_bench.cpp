// How much faster than the clocks the event models are: every pair does the same work in this one run, CPU time of one
// thread, the best of some turns of each.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <functional>
#include <vector>

#include "fpga_rtl_counter.hpp"
#include "gravure/emulator/emulated_device.hpp"
#include "gravure/fpga/ab_counter.hpp"
#include "gravure/fpga/ab_edges.hpp"
#include "gravure/fpga/pulse_gate.hpp"
#include "gravure/fpga/synchro_events.hpp"

namespace {

using namespace gravure;
using bench::EdgeSum;

constexpr double kFpgaHz = 164e6;

double cpu_seconds() {
  std::timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Least CPU time of `turns` runs.
double least_seconds(int turns, const std::function<void()>& work) {
  double least = 1e9;
  for (int turn = 0; turn < turns; ++turn) {
    const double start = cpu_seconds();
    work();
    least = std::min(least, cpu_seconds() - start);
  }
  return least;
}

EdgeSum edge_by_edge(const fpga::AbRegisters& registers, std::uint64_t clocks) {
  auto edges = fpga::AbEdges::make(registers);
  EdgeSum sum;
  edges->run_to(clocks, [&sum](const fpga::AbEdge& edge) { sum.take(edge.clock, edge.pins.a, edge.pins.b); });
  return sum;
}

EdgeSum clock_by_clock(const fpga::AbRegisters& registers, std::uint64_t clocks) {
  auto counter = fpga::AbCounter::make(registers);
  EdgeSum sum;
  fpga::AbPins before;
  for (std::uint64_t count = 0; count < clocks; ++count) {
    const fpga::AbPins now = counter->step();
    if (!(now == before)) {
      sum.take(counter->clock(), now.a, now.b);
      before = now;
    }
  }
  return sum;
}

struct Rate {
  double clocks_per_second = 0;
  EdgeSum sum;
};

Rate rate_of(std::uint64_t clocks, const std::function<EdgeSum()>& work) {
  Rate rate;
  const double seconds = least_seconds(3, [&] { rate.sum = work(); });
  rate.clocks_per_second = static_cast<double>(clocks) / seconds;
  return rate;
}

bool same(const Rate& a, const Rate& b) {
  return a.sum.hash == b.sum.hash && a.sum.edges == b.sum.edges;
}

/// Setup 2: increment 2^21. The event model does the Verilator's work, hashed alike, and then much more of it.
bool against_rtl() {
  constexpr std::uint32_t kIncrement = 1U << 21U;
  constexpr std::uint64_t kFew = 20'000'000;
  constexpr std::uint64_t kMany = 20'000'000'000;
  const fpga::AbRegisters registers{.bits = 32, .increment = kIncrement};
  const Rate events = rate_of(kMany, [&] { return edge_by_edge(registers, kMany); });
  std::printf("A-B edges, increment 2^21: event model %.3g clocks/s, %.3g edges/s, %.0f times real time at 164 MHz\n",
              events.clocks_per_second, events.clocks_per_second * kIncrement / (1U << 30U),
              events.clocks_per_second / kFpgaHz);
#ifdef GRAVURE_WITH_VERILATOR
  const Rate rtl = rate_of(kFew, [] { return bench::run_rtl_counter(kIncrement, kFew); });
  const EdgeSum few = edge_by_edge(registers, kFew);
  const bool equal = few.hash == rtl.sum.hash && few.edges == rtl.sum.edges;
  std::printf("  Verilator (-O3 -flto): %.3g clocks/s; event model %.0f times as fast; the same %llu edges: %s\n",
              rtl.clocks_per_second, events.clocks_per_second / rtl.clocks_per_second,
              static_cast<unsigned long long>(few.edges), equal ? "yes" : "NO");
  return equal;
#else
  std::printf("  Verilator: not built, no verilator here (Debian: verilator)\n");
  return true;
#endif
}

/// From an edge in a while to one on every clock.
bool against_clocks() {
  struct Work {
    std::uint64_t increment;
    std::uint64_t num;
  };
  constexpr std::uint64_t kClocks = 100'000'000;
  bool equal = true;
  for (const Work& work : {Work{77, 0}, Work{1U << 21U, 0}, Work{700'000'000, 0}, Work{700'000'000, 1'000'003},
                           Work{(1U << 30U) - 1, 0}, Work{(1U << 30U) - 1, 1'000'003}, Work{1U << 30U, 0}}) {
    const fpga::AbRegisters registers{
        .bits = 32, .increment = work.increment, .fraction_num = work.num, .fraction_den = 4'405'634'541};
    const Rate events = rate_of(kClocks, [&] { return edge_by_edge(registers, kClocks); });
    const Rate clocks = rate_of(kClocks, [&] { return clock_by_clock(registers, kClocks); });
    equal = equal && same(events, clocks);
    std::printf("increment %10llu%s: edge by edge %.3g clocks/s, clock by clock %.3g: %.2f times; the same edges: %s\n",
                static_cast<unsigned long long>(work.increment), work.num != 0 ? " + fraction" : "           ",
                events.clocks_per_second, clocks.clocks_per_second, events.clocks_per_second / clocks.clocks_per_second,
                same(events, clocks) ? "yes" : "NO");
  }
  return equal;
}

constexpr int kFifoBits = 12;

/// Writes one register, as a host does: for one seed clock.
template <class Board>
void write(Board&& hold, const fpga::Register& target, std::uint32_t value) {
  fpga::Synchro::Inputs in;
  in.write = true;
  in.address = target.address;
  in.write_data = value;
  hold(in, 2);
}

/// The whole board with axis 0 running; `hold(inputs, clocks)` runs it.
template <class Board>
void run_axis(Board&& hold, std::uint32_t increment, std::uint64_t clocks) {
  constexpr std::uint32_t kEnableAxis = 2;
  constexpr std::uint32_t kLoadAxis = 2;
  write(hold, fpga::kIncrementRegister, increment);
  write(hold, fpga::kControlRegister, kEnableAxis);
  write(hold, fpga::kCommandRegister, kLoadAxis);
  hold({}, clocks);
}

/// The whole board: every block on every clock against its jumps from event to event.
bool against_board() {
  constexpr std::uint64_t kClocks = 2'000'000;
  bool equal = true;
  for (const std::uint32_t increment : {0U, 1U << 21U, 700'000'000U, 1U << 30U}) {
    const Rate events = rate_of(kClocks, [&] {
      fpga::SynchroEvents board(kFifoBits);
      EdgeSum sum;
      fpga::SynchroEvents::Event before;
      const auto hold = [&](const fpga::Synchro::Inputs& in, std::uint64_t clocks) {
        board.run(in, clocks, [&](const fpga::SynchroEvents::Event& now) {
          if (!(now.axes[0] == before.axes[0])) {
            sum.take(now.clock, now.axes[0].a, now.axes[0].b);
          }
          before = now;
        });
      };
      run_axis(hold, increment, kClocks);
      return sum;
    });
    const Rate clocks = rate_of(kClocks, [&] {
      fpga::Synchro board(kFifoBits);
      EdgeSum sum;
      std::uint64_t clock = 0;
      fpga::AbPins before;
      const auto hold = [&](const fpga::Synchro::Inputs& in, std::uint64_t count) {
        for (; count > 0; --count) {
          const fpga::Synchro::Outputs out = board.step(in);
          const fpga::AbPins now{out.a, out.b};
          ++clock;
          if (!(now == before)) {
            sum.take(clock, now.a, now.b);
          }
          before = now;
        }
      };
      run_axis(hold, increment, kClocks);
      return sum;
    });
    equal = equal && same(events, clocks);
    std::printf(
        "whole board, increment %10u: event to event %.3g clocks/s, clock by clock %.3g: %.3g times; the same "
        "edges: %s\n",
        increment, events.clocks_per_second, clocks.clocks_per_second,
        events.clocks_per_second / clocks.clocks_per_second, same(events, clocks) ? "yes" : "NO");
  }
  return equal;
}

class FiredBytes final : public PinObserver {
 public:
  void on_line(const ExecutedLine& line) override {
    for (const std::byte byte : line.fired) {
      sum += std::to_integer<unsigned>(byte);
    }
    edges = line.axis_at_start.edges;
  }
  std::uint64_t sum = 0;
  std::uint64_t edges = 0;
};

/// A roller of 100 revolutions, all its gates through the emulated board: lines of 3909 slots, 3500 of them pixels.
bool roller() {
  DeviceSetup setup{.counter_bits = 32,
                    .prescaler = 3,
                    .increment = 141'835'289,
                    .fraction_num = 1'000'003,
                    .fraction_den = 4'405'634'541,
                    .ticks_per_slot = 82,
                    .slots_per_line = 3909,
                    .window_slots = 3500,
                    .lines_per_revolution = 27'489,
                    .end_revolution = 100};
  std::vector<std::byte> bits(fpga::packed_bytes(3500), std::byte{0xA5});
  bits.back() = std::byte{0xA0};  // four slots of the last byte are past the window
  FiredBytes pins;
  emulator::EmulatedDevice device(&pins);
  bool good = static_cast<bool>(device.configure(setup));
  const double start = cpu_seconds();
  for (std::int64_t revolution = 0; good && revolution < setup.end_revolution; ++revolution) {
    for (std::int64_t line = 0; good && line < setup.lines_per_revolution; ++line) {
      LineFrame frame{.revolution = revolution, .line = line, .first_slot = 200, .bits = bits};
      frame.crc32c = frame_crc32c(frame);
      good = static_cast<bool>(device.send(frame));
    }
  }
  const double seconds = cpu_seconds() - start;
  const double machine_seconds = static_cast<double>(device.status().tick) / kFpgaHz;
  std::printf(
      "roller, 100 revolutions, %lld lines with all gates: %.2f s for %.0f s of machine time, %.0f times; "
      "edges %llu, %s\n",
      static_cast<long long>(device.status().lines_executed), seconds, machine_seconds, machine_seconds / seconds,
      static_cast<unsigned long long>(pins.edges), good ? "no fault" : "FAULT");
  return good;
}

}  // namespace

int main() {
  const bool rtl = against_rtl();
  const bool clocks = against_clocks();
  const bool board = against_board();
  return roller() && rtl && clocks && board ? 0 : 1;
}
