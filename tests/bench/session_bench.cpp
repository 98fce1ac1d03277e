// Slots a second that `run` brings to the emulated board: read from a program file, unpacked, framed, sent by credit
// and executed line by line, with the journal on disk. POD pulses come at 16.4 Mbit/s.
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <filesystem>

#include "dice.hpp"
#include "gravure/emulator/emulated_link.hpp"
#include "gravure/formats/grv.hpp"
#include "gravure/session/run.hpp"
#include "gravure/sync/make_plan.hpp"

namespace {

using namespace gravure;

constexpr std::int64_t kPixels = 8'000;
constexpr std::int64_t kLines = 20'000;

Job wide_job() {
  Job job;
  job.laser = {.seed_hz = 82'000'000, .pulse_divider = 5, .max_pulse_on_demand_hz = 16'400'000};
  job.fpga = {.clock_multiplier = 2, .counter_bits = 32, .fractional = true, .max_prescaler = 1'000};
  job.scanner.pixel_pitch_um = 8;
  job.scanner.slots_per_microvector = 2;
  job.scanner.turn_slots = 1'000;
  job.scanner.bidirectional = true;
  job.rotary.circumference_mm = ratio(8 * kLines, 1000);
  job.rotary.lines_per_revolution = kLines;
  job.rotary.encoder_lines = 1'000;
  job.rotary.interpolation_bits = 2;
  job.rotary.max_ab_hz = 41'000'000;
  job.limits.seam_um = ratio(1, 2);
  return job;
}

/// Half of the lines hold a pattern that packs well, half are noise.
Result<void> write_program(const std::string& path) {
  test::Dice dice;
  ProgramHeader header;
  GRAVURE_TRY(header.plan, make_plan(wide_job(), kPixels, 2));
  header.sources.push_back({"bench", 0, kPixels, kLines, std::string(64, '0')});
  header.layers.push_back({});
  header.layer_of_revolution = {0, 0};
  const std::int64_t bytes = header.line_bytes();
  GRAVURE_TRY(const std::unique_ptr<LineSink> sink, create_grv(path, 1, kLines, bytes));
  for (std::int64_t first = 0; first < kLines; first += sink->lines_per_chunk()) {
    const std::int64_t lines = std::min(sink->lines_per_chunk(), kLines - first);
    std::vector<std::byte> bits(static_cast<std::size_t>(lines * bytes));
    for (std::size_t at = 0; at < bits.size(); ++at) {
      bits[at] = static_cast<std::byte>(first % (2 * sink->lines_per_chunk()) == 0 ? 0xF0U : dice.word());
    }
    GRAVURE_TRY(const StoredChunk chunk, sink->encode({0, first / sink->lines_per_chunk()}, bits));
    header.layers[0].fired_pixels += chunk.fired_pixels;
    GRAVURE_CHECK(sink->put(chunk));
  }
  return sink->finish(header);
}

class Silent final : public session::RunObserver {
 public:
  void on_counts(const session::RunCounts& counts) override { executed = counts.executed; }
  void on_note(const std::string&) override {}
  std::int64_t executed = 0;
};

void BM_RunOnEmulatedBoard(benchmark::State& state) {
  std::string folder = (std::filesystem::temp_directory_path() / "gravure_bench_XXXXXX").string();
  if (::mkdtemp(folder.data()) == nullptr) {
    state.SkipWithError("no temporary folder");
    return;
  }
  const std::string program = folder + "/bench.grv";
  if (const Result<void> written = write_program(program); !written) {
    state.SkipWithError(written.error().message.c_str());
  }
  std::int64_t slots = 0;
  for (auto _ : state) {
    std::filesystem::remove(folder + "/journal");
    const Result<std::unique_ptr<LineSource>> source = open_grv(program);
    Result<session::Journal> journal =
        session::Journal::open(folder + "/journal", {program, "bench", 2 * kLines, kLines});
    emulator::EmulatedLink link((emulator::EmulatedBoard(emulator::BoardOptions{})));
    Silent silent;
    const Result<session::RunReport> report =
        session::run_program(*source.value(), link, journal.value(), {}, silent, {});
    if (!report || report.value().end != session::RunEnd::finished) {
      state.SkipWithError(report ? "it did not come to its end" : report.error().message.c_str());
      break;
    }
    slots += 2 * kLines * kPixels;
  }
  state.counters["Mbit/s"] = benchmark::Counter(static_cast<double>(slots) / 1e6, benchmark::Counter::kIsRate);
  std::filesystem::remove_all(folder);
}
BENCHMARK(BM_RunOnEmulatedBoard)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace

BENCHMARK_MAIN();
