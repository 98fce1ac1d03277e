#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <ostream>
#include <vector>

#include "frame_maker.hpp"
#include "gravure/fpga/latencies.hpp"
#include "gravure/fpga/line_progress.hpp"
#include "gravure/fpga/register_map.hpp"
#include "stimulus.hpp"

// A host that goes on after a fault by what executed_lines and closed_slot say: whatever clock the gate closes on,
// every pulse of the job is fired once.
namespace gravure::cosim {
namespace {

std::uint64_t seed_from_environment() {
  const char* text = std::getenv("GRAVURE_TEST_SEED");
  return text == nullptr ? 1 : std::strtoull(text, nullptr, 10);
}

struct Job {
  std::uint64_t slots = 1;  ///< np
  std::uint64_t seeds = 1;  ///< k
  std::uint64_t delay = 0;  ///< of backward lines
  bool backward = false;    ///< odd lines are
  std::uint64_t lines = 5;  ///< one revolution
  std::uint64_t window = 1;
  std::vector<std::uint64_t> first_slot;  ///< of a line
  std::vector<std::vector<bool>> fires;   ///< of a line, of a slot
  std::uint64_t pulses() const { return lines * slots; }
};

enum class Cut { none, interlock, stop, shape, silence };

/// What the board said when it stood, and the slots in which the gate was open, if for one clock only.
struct Run {
  std::uint64_t executed = 0;
  std::uint64_t closed_slot = 0;
  std::uint64_t closed_at = ~std::uint64_t{0};  ///< slots before this one passed, by the clock of the cut
  std::vector<bool> fired;                      ///< of all slots of the job
};

class Host {
 public:
  explicit Host(Machine& board) : board_(board), in_(board.inputs().size()), out_(board.outputs().size()) {
    set("rst", 1);
    clock();
    set("rst", 0);
  }

  /// Lines from `first` on, the slots of that one that are before `skip` dark; the gate closes `after` clocks behind
  /// go.
  Run run(const Job& job, std::uint64_t first, std::uint64_t skip, Cut cut, std::uint64_t after) {
    set_up(job, first, cut, after);
    for (std::uint64_t line = first; line < job.lines; ++line) {
      send(job, line, line == first ? skip : 0, line - first);
    }
    idle(4);
    run_ = {};
    run_.fired.assign(job.pulses(), false);
    write(fpga::kControlRegister, 1U + 16U + (job.backward ? 32U : 0U) + (cut == Cut::silence ? 4U : 0U));
    shown_ = false;
    write(fpga::kCommandRegister, 64);
    const std::uint64_t go = now_ - 1 + fpga::kSettingsLatency;  // is taken on this clock
    start_ = go + kFirstTick + fpga::kStartLatency + fpga::kSlotToGate - 1;
    job_ = &job;
    first_ = first;
    shown_ = true;
    const std::uint64_t end = (job.lines - first) * job.slots * job.seeds + kFirstTick + 40;
    const std::uint64_t closes = cut_at(cut, after, go, end);
    while (now_ < go + end) {
      idle(1);
    }
    shown_ = false;
    run_.closed_at = passed_before(std::min(closes, start_ + (job.lines - first) * job.slots * job.seeds));
    run_.executed = read(fpga::kExecutedLinesRegister);
    run_.closed_slot = read(fpga::kClosedSlotRegister);
    return run_;
  }

 private:
  static constexpr std::uint64_t kFirstTick = 3;

  static std::size_t place(const std::vector<Port>& ports, const char* name) {
    const auto port = std::find_if(ports.begin(), ports.end(), [name](const Port& p) { return p.name == name; });
    return static_cast<std::size_t>(port - ports.begin());
  }
  void set(const char* name, std::uint64_t value) { in_[place(board_.inputs(), name)] = value; }

  /// A seed clock.
  void clock() {
    board_.step(in_, out_);
    board_.step(in_, out_);
    if (shown_ && out_[gate_] != 0) {
      const std::uint64_t slot = passed_before(now_ + 1);
      ASSERT_GT(slot, first_ * job_->slots) << "the gate is open before the first line";
      run_.fired[slot - 1] = true;
    }
    ++now_;
  }
  void idle(std::uint64_t clocks) {
    for (; clocks > 0; --clocks) {
      clock();
    }
  }
  void write(const fpga::Register& target, std::uint64_t data) {
    set("write", 1);
    set("address", target.address);
    set("write_data", data);
    clock();
    set("write", 0);
  }
  std::uint64_t read(const fpga::Register& from) {
    set("address", from.address);
    idle(fpga::kReadLatency);
    return out_[place(board_.outputs(), "read_data")];
  }
  void byte(std::uint64_t data) {
    set("in_valid", 1);
    set("in_data", data);
    clock();
    set("in_valid", 0);
  }

  /// The clock just after which the gate shows a slot, counted over the job.
  std::uint64_t shown_at(std::uint64_t slot) const {
    const bool backward = job_->backward && slot / job_->slots % 2 == 1;
    return start_ + (slot - first_ * job_->slots) * job_->seeds + (backward ? job_->delay : 0);
  }
  /// How many slots of the job, those before this run included, the gate shows before `clock`.
  std::uint64_t passed_before(std::uint64_t clock) const {
    std::uint64_t slot = first_ * job_->slots;
    while (slot < job_->pulses() && shown_at(slot) < clock) {
      ++slot;
    }
    return slot;
  }

  void set_up(const Job& job, std::uint64_t first, Cut cut, std::uint64_t after) {
    write(fpga::kControlRegister, 0);
    write(fpga::kSeedsPerSlotRegister, job.seeds);
    write(fpga::kSlotsPerLineRegister, job.slots);
    write(fpga::kWindowSlotsRegister, job.window);
    write(fpga::kReverseDelayRegister, job.delay);
    write(fpga::kLinesPerRevolutionRegister, job.lines);
    write(fpga::kPositionRevolutionRegister, 0);
    write(fpga::kPositionLineRegister, first);
    write(fpga::kFirstTickRegister, kFirstTick);
    write(fpga::kSilenceLimitRegister, cut == Cut::silence ? after + 1 : 1);
    write(fpga::kCommandRegister, 1);
    write(fpga::kCommandRegister, 8);
    idle(4);
  }
  void send(const Job& job, std::uint64_t line, std::uint64_t skip, std::uint64_t sequence) {
    std::vector<std::uint8_t> bits((job.window + 7) / 8);
    for (std::uint64_t at = 0; at < job.window; ++at) {
      const std::uint64_t slot = job.first_slot[line] + at;
      if (slot >= skip && job.fires[line][slot]) {
        bits[at / 8] = static_cast<std::uint8_t>(bits[at / 8] | 0x80U >> (at % 8));
      }
    }
    for (const std::uint8_t each : line_frame(sequence, 0, line, job.first_slot[line], bits)) {
      byte(each);
    }
  }

  /// Closes the gate and returns the clock from which it is closed.
  std::uint64_t cut_at(Cut cut, std::uint64_t after, std::uint64_t go, std::uint64_t end) {
    constexpr std::uint64_t kParserLatency = 3;  // a byte that is no mark to the fault
    if (cut == Cut::none || go + after >= go + end) {
      return ~std::uint64_t{0};
    }
    if (cut == Cut::silence) {  // go was written kSettingsLatency ago
      return go - fpga::kSettingsLatency + 1 + (after + 1) + fpga::kWatchdogLatency;
    }
    while (now_ < go + after) {
      idle(1);
    }
    switch (cut) {
      case Cut::interlock:
        set("interlock", 1);
        idle(1);
        set("interlock", 0);
        return now_ - 1;
      case Cut::stop:
        write(fpga::kControlRegister, 0);
        return now_ - 1 + fpga::kSettingsLatency;
      default:
        byte(0);
        return now_ - 1 + kParserLatency;
    }
  }

  Machine& board_;
  std::vector<std::uint64_t> in_;
  std::vector<std::uint64_t> out_;
  std::size_t gate_ = place(board_.outputs(), "gate");
  std::uint64_t now_ = 0;  ///< seed clocks that have passed
  bool shown_ = false;     ///< the gate is looked at
  const Job* job_ = nullptr;
  std::uint64_t first_ = 0;
  std::uint64_t start_ = 0;  ///< just after this clock the gate shows the first slot of a forward line
  Run run_;
};

Job random_job(Dice& dice, std::uint64_t seeds, std::uint64_t delay) {
  Job job;
  const std::uint64_t gap = seeds - delay < 2 ? 1 : 0;  // slots: the gate fetches a line's first byte in two clocks
  job.slots = dice.one_in(5) ? 1 + gap : 2 + dice.word() % 10;
  job.seeds = seeds;
  job.delay = delay;
  job.backward = true;
  job.window = 1 + dice.word() % (job.slots - gap);
  for (std::uint64_t line = 0; line < job.lines; ++line) {
    job.first_slot.push_back(gap + dice.word() % (job.slots - job.window - gap + 1));
    job.fires.emplace_back(job.slots, false);
    for (std::uint64_t at = 0; at < job.window; ++at) {
      job.fires.back()[job.first_slot.back() + at] = !dice.one_in(3);
    }
  }
  return job;
}

void add(std::vector<int>& total, const std::vector<bool>& fired) {
  for (std::size_t slot = 0; slot < total.size(); ++slot) {
    total[slot] += fired[slot] ? 1 : 0;
  }
}

class Resume : public testing::TestWithParam<const char*> {
 protected:
  std::unique_ptr<Machine> board() const {
#ifdef GRAVURE_WITH_VERILATOR
    if (std::string(GetParam()) == "Rtl") {
      return make_rtl("synchro");
    }
#endif
    return find_block("synchro")->model();
  }
};

/// Runs the job with cuts until it is through; each is `cuts` of (kind, clock) in turn.
void expect_every_pulse_once(Host& host, const Job& job, const std::vector<std::pair<Cut, std::uint64_t>>& cuts,
                             unsigned& partial_lines) {
  std::vector<int> fired(job.pulses());
  std::uint64_t line = 0;
  std::uint64_t skip = 0;
  for (std::size_t at = 0; at <= cuts.size() && line < job.lines; ++at) {
    const auto [cut, after] = at < cuts.size() ? cuts[at] : std::pair{Cut::none, std::uint64_t{0}};
    const Run run = host.run(job, line, skip, cut, after);
    SCOPED_TRACE(testing::Message() << "run " << at << ", cut " << static_cast<int>(cut) << " after " << after
                                    << " of lines from " << line << ", slot " << skip);
    add(fired, run.fired);
    const std::uint64_t slots = run.closed_slot & 0xFFFFFFU;
    const bool partial = (run.closed_slot & fpga::LineProgress::kPartialBit) != 0;
    ASSERT_EQ((line + run.executed) * job.slots + slots, run.closed_at);
    ASSERT_EQ(partial, slots != 0);
    skip = run.executed != 0 ? slots : std::max(skip, slots);  // cut once more before it came to new slots
    line += run.executed;
    partial_lines += partial ? 1 : 0;
  }
  ASSERT_EQ(line, job.lines);
  for (std::uint64_t slot = 0; slot < job.pulses(); ++slot) {
    const bool fires = job.fires[slot / job.slots][slot % job.slots];
    ASSERT_EQ(fired[slot], fires ? 1 : 0) << "line " << slot / job.slots << ", slot " << slot % job.slots;
  }
}

/// Every clock of a job, every delay of slots of 1 to 5 clocks, by each way to close the gate.
TEST_P(Resume, FiresEveryPulseOnceWhateverClockTheGateClosesOn) {
  const std::uint64_t seed = seed_from_environment();
  SCOPED_TRACE(testing::Message() << "rerun with GRAVURE_TEST_SEED=" << seed);
  Dice dice(seed);
  const auto machine = board();
  Host host(*machine);
  unsigned partial_lines = 0;
  for (std::uint64_t seeds = 1; seeds <= 5; ++seeds) {
    for (std::uint64_t delay = 0; delay < seeds; ++delay) {
      for (const Cut cut : {Cut::interlock, Cut::stop, Cut::shape, Cut::silence}) {
        const Job job = random_job(dice, seeds, delay);
        SCOPED_TRACE(testing::Message() << "k " << seeds << ", delay " << delay << ", np " << job.slots);
        for (std::uint64_t after = 0; after < job.pulses() * seeds + 20; ++after) {
          expect_every_pulse_once(host, job, {{cut, after}}, partial_lines);
          if (HasFatalFailure()) {
            return;
          }
        }
      }
    }
  }
  EXPECT_GT(partial_lines, 1000U);
}

TEST_P(Resume, FiresEveryPulseOnceWhereALineIsCutAgainAndAgain) {
  const std::uint64_t seed = seed_from_environment();
  SCOPED_TRACE(testing::Message() << "rerun with GRAVURE_TEST_SEED=" << seed);
  Dice dice(seed);
  const auto machine = board();
  Host host(*machine);
  unsigned partial_lines = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const std::uint64_t seeds = 1 + dice.word() % 7;
    const Job job = random_job(dice, seeds, dice.word() % seeds);
    std::vector<std::pair<Cut, std::uint64_t>> cuts;
    cuts.resize(6);
    for (auto& [cut, after] : cuts) {
      cut = static_cast<Cut>(1 + dice.word() % 4);
      after = dice.word() % (2 * job.slots * seeds + 12);
    }
    expect_every_pulse_once(host, job, cuts, partial_lines);
    if (HasFatalFailure()) {
      return;
    }
  }
  EXPECT_GT(partial_lines, 500U);
}

#ifdef GRAVURE_WITH_VERILATOR
INSTANTIATE_TEST_SUITE_P(Boards, Resume, testing::Values("Model", "Rtl"), [](const auto& each) { return each.param; });
#else
INSTANTIATE_TEST_SUITE_P(Boards, Resume, testing::Values("Model"), [](const auto& each) { return each.param; });
#endif

}  // namespace
}  // namespace gravure::cosim
