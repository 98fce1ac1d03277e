#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "dice.hpp"
#include "gravure/emulator/emulated_link.hpp"
#include "gravure/session/run.hpp"
#include "gravure/sync/make_plan.hpp"
#include "memory_program.hpp"
#include "small_job.hpp"

/// Programs of random bits on emulated boards, and what they fired.
namespace gravure::session::test {

using gravure::test::Dice;
using gravure::test::MemoryProgram;
using gravure::test::MemorySource;

/// A folder of its own, taken away again.
class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "gravure_session_XXXXXX").string();
    path_ = ::mkdtemp(name.data()) == nullptr ? std::filesystem::path() : std::filesystem::path(name);
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

/// A program whose lines are random bits; the revolutions show its two layers in turn.
inline void random_program(MemoryProgram& program, const Job& job, std::int64_t pixels, std::int64_t revolutions,
                           Dice& dice, std::int64_t lines_per_chunk = 5) {
  Result<Plan> plan = make_plan(job, pixels, revolutions);
  ASSERT_TRUE(plan) << plan.error().message;
  program.header.plan = std::move(plan).value();
  program.lines_per_chunk = lines_per_chunk;
  const Plan& made = program.header.plan;
  const std::int64_t bytes = program.header.line_bytes();
  const std::int64_t lines = made.rotary.lines_per_revolution;
  program.header.sources.push_back({"random", 0, pixels, lines, std::string(64, '0')});
  for (std::int64_t layer = 0; layer < 2; ++layer) {
    StoredLayer stored;
    stored.starts_reverse = dice.coin() && made.line.bidirectional;
    program.header.layers.push_back(stored);
    for (std::int64_t first = 0; first < lines; first += lines_per_chunk) {
      StoredChunk chunk;
      chunk.address = {layer, first / lines_per_chunk};
      for (std::int64_t line = first; line < std::min(first + lines_per_chunk, lines); ++line) {
        for (std::int64_t byte = 0; byte < bytes; ++byte) {
          const auto mask = byte + 1 == bytes && pixels % 8 != 0 ? 0xFF00U >> (pixels % 8) : 0xFFU;
          chunk.bytes.push_back(static_cast<std::byte>(dice.word() & mask));
        }
      }
      program.chunks[{layer, chunk.address.chunk}] = std::move(chunk);
    }
  }
  for (std::int64_t r = 0; r < made.job.revolutions; ++r) {
    program.header.layer_of_revolution.push_back(static_cast<std::uint32_t>(r % 2));
  }
}

inline bool bit_of(std::span<const std::byte> bits, std::int64_t at) {
  return (std::to_integer<unsigned>(bits[static_cast<std::size_t>(at / 8)]) & (0x80U >> (at % 8))) != 0;
}

/// The decisions of a line of the job in time order, a pixel at a time.
inline std::vector<int> wanted_line(const MemoryProgram& program, std::int64_t ordinal) {
  const Plan& plan = program.header.plan;
  const std::int64_t lines = plan.rotary.lines_per_revolution;
  const std::int64_t revolution = ordinal / lines;
  const std::int64_t layer = program.header.layer_of_revolution[static_cast<std::size_t>(revolution)];
  const std::vector<std::byte> stored = program.line(layer, ordinal % lines);
  const bool turned =
      line_is_reverse(plan, revolution, 0) != program.header.layers[static_cast<std::size_t>(layer)].starts_reverse;
  std::vector<int> wanted;
  for (std::int64_t pixel = 0; pixel < plan.line.pixels; ++pixel) {
    wanted.push_back(bit_of(stored, turned ? plan.line.pixels - 1 - pixel : pixel) ? 1 : 0);
  }
  return wanted;
}

/// How often each pixel was fired, in time order of its line.
class Exposure final : public PinObserver {
 public:
  explicit Exposure(const MemoryProgram& program) : program_(program) {
    const Plan& plan = program.header.plan;
    fired_.assign(static_cast<std::size_t>(plan.job.revolutions * plan.rotary.lines_per_revolution),
                  std::vector<int>(static_cast<std::size_t>(plan.line.pixels)));
  }
  void on_line(const ExecutedLine& line) override {
    const Plan& plan = program_.header.plan;
    ASSERT_GE(line.ordinal, 0);
    ASSERT_LT(static_cast<std::size_t>(line.ordinal), fired_.size()) << "a line the job does not have";
    const bool reverse = plan.line.bidirectional && (line.ordinal & 1) != 0;
    const std::int64_t earlier = (line.ordinal & 1) != 0 && plan.line.offset_remainder_ticks < 0 ? 1 : 0;
    EXPECT_EQ(line.first_slot, (reverse ? plan.line.reverse_first_slot : plan.line.forward_first_slot) - earlier);
    std::vector<int>& counts = fired_[static_cast<std::size_t>(line.ordinal)];
    for (std::size_t pixel = 0; pixel < counts.size(); ++pixel) {
      counts[pixel] += bit_of(line.fired, static_cast<std::int64_t>(pixel)) ? 1 : 0;
    }
    ++lines_;
    last_axis_ = line.axis_at_start;
  }
  /// Pixels of lines first .. end that were fired another number of times than wanted.
  std::int64_t wrong(std::int64_t first, std::int64_t end) const {
    std::int64_t wrong = 0;
    for (std::int64_t line = first; line < end; ++line) {
      const std::vector<int> wanted = wanted_line(program_, line);
      for (std::size_t pixel = 0; pixel < wanted.size(); ++pixel) {
        wrong += fired_[static_cast<std::size_t>(line)][pixel] != wanted[pixel] ? 1 : 0;
      }
    }
    return wrong;
  }
  std::int64_t wrong() const { return wrong(0, static_cast<std::int64_t>(fired_.size())); }
  /// Pixels that were fired though the program does not say so, or twice.
  std::int64_t too_often() const {
    std::int64_t too_often = 0;
    for (std::size_t line = 0; line < fired_.size(); ++line) {
      const std::vector<int> wanted = wanted_line(program_, static_cast<std::int64_t>(line));
      for (std::size_t pixel = 0; pixel < wanted.size(); ++pixel) {
        too_often += fired_[line][pixel] > wanted[pixel] ? 1 : 0;
      }
    }
    return too_often;
  }
  const std::vector<int>& counts(std::int64_t line) const { return fired_[static_cast<std::size_t>(line)]; }
  std::int64_t lines() const { return lines_; }
  const AxisState& last_axis() const { return last_axis_; }

 private:
  const MemoryProgram& program_;
  std::vector<std::vector<int>> fired_;
  std::int64_t lines_ = 0;
  AxisState last_axis_;
};

class Notes final : public RunObserver {
 public:
  void on_counts(const RunCounts& counts) override {
    EXPECT_GE(counts.sent, counts.accepted);
    EXPECT_GE(counts.accepted, counts.executed);
    EXPECT_GE(counts.executed, last.executed);
    last = counts;
    if (on_counts_) {
      on_counts_(counts);
    }
  }
  void on_note(const std::string& text) override { notes += text + "\n"; }
  RunCounts last;
  std::string notes;
  std::function<void(const RunCounts&)> on_counts_;
};

inline JobIdentity identity_of(const MemoryProgram& program) {
  const Plan& plan = program.header.plan;
  return {"small.grv", "abc", plan.job.revolutions * plan.rotary.lines_per_revolution,
          plan.rotary.lines_per_revolution};
}

/// One run with a journal that is opened for it.
inline Result<RunReport> run_once(const MemoryProgram& program, DeviceLink& link, const std::string& journal_path,
                                  const RunOptions& options, Notes& notes, const CancelToken& cancel = {}) {
  MemorySource source(program);
  GRAVURE_TRY(Journal journal, Journal::open(journal_path, identity_of(program)));
  return run_program(source, link, journal, options, notes, cancel);
}

}  // namespace gravure::session::test
