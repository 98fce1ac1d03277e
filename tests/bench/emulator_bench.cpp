// How fast an emulated board takes a job: bytes in, every frame checked, every line carried out. A job asks for one bit
// a slot of the marking window, 16.4 Mbit/s at 16.4 MHz pulse on demand.
#include <benchmark/benchmark.h>

#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "gravure/emulator/emulated_board.hpp"
#include "gravure/fpga/register_map.hpp"
#include "gravure/protocol/frame.hpp"

namespace {

using namespace gravure;
using namespace gravure::emulator;

constexpr std::uint32_t kLines = 20'000;
constexpr std::size_t kTransferBytes = std::size_t{64} << 10U;

std::vector<std::byte> stream_of(std::uint32_t window_slots) {
  std::vector<std::byte> stream;
  std::vector<std::byte> bits(window_slots / 8);
  std::uint32_t noise = 1;
  for (std::uint32_t line = 0; line < kLines; ++line) {
    for (std::byte& byte : bits) {
      noise = noise * 1'664'525U + 1'013'904'223U;
      byte = static_cast<std::byte>(noise >> 24U);
    }
    protocol::append_frame(stream, {.sequence = line, .revolution = 0, .line = line, .first_slot = 100}, bits);
  }
  return stream;
}

void prepare(EmulatedBoard& board, std::uint32_t window_slots) {
  constexpr std::uint32_t kRunTimed = 1U | 2U | 8U | 16U;
  constexpr std::uint32_t kAcknowledgeAndPosition = 1U | 8U;
  constexpr std::uint32_t kGo = 64;
  const auto write = [&board](const fpga::Register& one, std::uint32_t value) {
    board.write_register(one.address, value);
  };
  write(fpga::kControlRegister, 0);
  write(fpga::kSeedsPerSlotRegister, 5);
  write(fpga::kSlotsPerLineRegister, window_slots + 200);
  write(fpga::kWindowSlotsRegister, window_slots);
  write(fpga::kLinesPerRevolutionRegister, kLines);
  write(fpga::kCommandRegister, kAcknowledgeAndPosition);
  write(fpga::kControlRegister, kRunTimed);
  write(fpga::kCommandRegister, kGo);
}

void take_job(benchmark::State& state, EmulatedBoard& board) {
  const auto window_slots = static_cast<std::uint32_t>(state.range(0));
  const std::vector<std::byte> stream = stream_of(window_slots);
  for (auto _ : state) {
    prepare(board, window_slots);
    std::span<const std::byte> rest = stream;
    while (!rest.empty()) {
      rest = rest.subspan(board.take(rest.first(std::min(rest.size(), kTransferBytes))));
      board.pass_time();
    }
    if (board.status().executed_lines != kLines) {
      state.SkipWithError("the board did not run all lines");
      return;
    }
  }
  const double slots = static_cast<double>(state.iterations()) * kLines * window_slots;
  state.counters["Mbit_per_s"] = benchmark::Counter(slots * 1e-6, benchmark::Counter::kIsRate);
  state.counters["times_16.4"] = benchmark::Counter(slots / 16.4e6, benchmark::Counter::kIsRate);
}

void board_in_memory(benchmark::State& state) {
  EmulatedBoard board{BoardOptions()};
  take_job(state, board);
}

/// With its folder, where everything that fires is written once more.
void board_in_a_folder(benchmark::State& state) {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "gravure_board_bench";
  std::filesystem::remove_all(folder);
  {
    Result<EmulatedBoard> board = EmulatedBoard::open(folder.string(), {});
    if (!board) {
      state.SkipWithError(board.error().message.c_str());
      return;
    }
    take_job(state, board.value());
  }
  std::filesystem::remove_all(folder);
}

BENCHMARK(board_in_memory)->Arg(1000)->Arg(3504)->Arg(16'000)->Unit(benchmark::kMillisecond);
BENCHMARK(board_in_a_folder)->Arg(1000)->Arg(3504)->Arg(16'000)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
