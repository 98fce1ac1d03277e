#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "dice.hpp"
#include "gravure/emulator/emulated_board.hpp"
#include "gravure/fpga/synchro_events.hpp"
#include "recorder.hpp"
#include "wire_host.hpp"

namespace gravure::emulator {
namespace {

/// Seed clocks that the model's blocks take, which the board leaves out (docs/registers.md, "Latencies"): from an input
/// to what the gate shows of it.
constexpr std::uint64_t kGoToGate = fpga::kSettingsLatency + fpga::kStartLatency + fpga::kSlotToGate;
constexpr std::uint64_t kByteToGate = fpga::kVerdictLatency + fpga::kFaultLatency + fpga::kGateLatency;
constexpr std::uint64_t kMarkToGate = kByteToGate - 1;  // a wrong mark shows at once
constexpr std::uint64_t kStopToGate = fpga::kSettingsLatency + fpga::kGateLatency;
constexpr std::uint64_t kInterlockToGate = fpga::kGateLatency;
constexpr std::uint64_t kSilenceToGate = 1 + fpga::kWatchdogLatency + fpga::kGateLatency;

enum class Trouble { none, bad_byte, starve, interlock, silence, stop };

/// The bit-exact model and the board, side by side: the same writes and bytes on the same clocks.
class Pair {
 public:
  Pair() { reset(); }
  Pair(const Pair&) = delete;
  Pair& operator=(const Pair&) = delete;
  void reset() {
    model = fpga::SynchroEvents(12);
    now_ = go_ = last_word_ = board_clock_ = 0;
    silences_.clear();
    silence_more_ = 0;
    gate_.clear();
    recorder.lines.clear();
    BoardOptions options;
    options.seed_hz = 1'000'000'000;
    options.now_ns = [this] { return board_clock_; };
    options.fifo_bits = 12;
    options.observer = &recorder;
    board = std::make_unique<EmulatedBoard>(std::move(options));
    hold({.rst = true}, 4);
  }
  void write(const fpga::Register& target, std::uint64_t value) {
    std::vector<test::Write> writes;
    test::add_write(writes, target, value);
    for (const test::Write& one : writes) {
      write(one);
    }
  }
  void write(const test::Write& one, std::uint64_t to_gate = 0) {
    speak();
    at(now_ + to_gate);
    const bool limit = one.address == fpga::kSilenceLimitRegister.address;
    board->write_register(one.address, static_cast<std::uint32_t>(one.value + (limit ? silence_more_ : 0)));
    fpga::Synchro::Inputs in;
    in.write = true;
    in.address = one.address;
    in.write_data = one.value;
    hold(in, 1);
    hold({}, 8);
  }
  void go() {
    go_ = now_;
    write({fpga::kCommandRegister.address, test::kGo}, kGoToGate);
  }
  void byte(std::byte data, std::uint64_t to_gate = kByteToGate) {
    speak();
    at(now_ + to_gate);
    ASSERT_EQ(board->take(std::span(&data, 1)), 1U);
    hold({.in_valid = true, .in_data = std::to_integer<std::uint8_t>(data)}, 1);
  }
  void interlock() {
    at(now_ + kInterlockToGate);
    board->open_interlock();
    hold({.interlock = true}, 1);
  }
  void stop() { write({fpga::kControlRegister.address, 0}, kStopToGate); }
  void wait_until(std::uint64_t clock) {
    if (clock > now_) {
      hold({}, clock - now_);
    }
  }
  std::uint64_t now() const { return now_; }
  /// The longest times without a word from the host.
  const std::set<std::uint64_t>& silences() const { return silences_; }
  bool faulty() const { return model.outputs().fault != 0; }
  /// Whether the gate was open on the first clock of a slot, counted from tick 0.
  bool fired_at(std::uint64_t seeds) const {
    const std::uint64_t clock = go_ + kGoToGate + seeds;
    const auto after = std::upper_bound(gate_.begin(), gate_.end(), clock,
                                        [](std::uint64_t value, const Change& one) { return value < one.clock; });
    return after != gate_.begin() && (after - 1)->open;
  }
  std::uint32_t read(const fpga::Register& target) {
    fpga::Synchro::Inputs in;
    in.address = target.address;
    hold(in, fpga::kReadLatency);
    return model.outputs().read_data;
  }
  void catch_up() {
    at(now_ + kGoToGate);
    board->pass_time();
  }

  std::int64_t silence_more_ = 0;
  fpga::SynchroEvents model{12};
  std::unique_ptr<EmulatedBoard> board;
  test::Recorder recorder;

 private:
  struct Change {
    std::uint64_t clock;
    bool open;
  };
  void speak() {
    silences_.insert(now_ - last_word_);
    last_word_ = now_;
  }
  void at(std::uint64_t clock) { board_clock_ = std::max(board_clock_, clock); }
  void hold(const fpga::Synchro::Inputs& in, std::uint64_t seeds) {
    model.run(in, 2 * seeds, [this](const fpga::SynchroEvents::Event& now) {
      if (gate_.empty() || gate_.back().open != now.gate) {
        gate_.push_back({(now.clock + 1) / 2, now.gate});
      }
    });
    now_ += seeds;
  }
  std::uint64_t now_ = 0;  ///< seed clocks that have passed
  std::uint64_t go_ = 0;
  std::uint64_t last_word_ = 0;
  std::set<std::uint64_t> silences_;
  std::uint64_t board_clock_ = 0;
  std::vector<Change> gate_;
};

/// A job of a few lines, and what happens to it.
struct Trial {
  DeviceSetup setup;
  std::int64_t lines = 0;
  std::uint64_t first_tick = 0;
  std::uint32_t control = test::kRunTimed;
  std::uint64_t reverse_delay = 0;
  bool ahead = false;  ///< all frames before go; else each while the line before runs
  Trouble trouble = Trouble::none;
  std::uint64_t when = 0;  ///< seed clocks since tick 0, of interlock and stop
  std::size_t bad_byte = 0;
  std::byte bad_bits{};
  std::int64_t missing = 0;  ///< starve: frames from this one on do not come

  std::uint64_t line_seeds() const {
    return static_cast<std::uint64_t>(setup.slots_per_line * setup.ticks_per_slot / setup.clock_multiplier);
  }
};

Trial draw_trial(gravure::test::Dice& dice) {
  Trial trial;
  DeviceSetup& setup = trial.setup;
  setup = test::wire_setup();
  setup.window_slots = dice.between(0, 60);
  setup.slots_per_line = setup.window_slots + dice.between(1, 40);
  const std::int64_t frame = 29 + (setup.window_slots + 7) / 8;
  const std::int64_t least = (frame + 60) / setup.slots_per_line + 1;  // a frame and more in a line time
  const std::int64_t seeds_per_slot = dice.between(std::max<std::int64_t>(least, 4), least + 6);
  setup.ticks_per_slot = 2 * seeds_per_slot;
  setup.lines_per_revolution = dice.between(1, 5);
  setup.end_revolution = 20;
  setup.first_revolution = dice.between(0, 3);
  setup.first_line = dice.between(0, setup.lines_per_revolution - 1);
  trial.lines = dice.between(1, 12);
  trial.ahead = dice.coin();
  trial.first_tick = static_cast<std::uint64_t>(dice.between(trial.ahead ? 0 : frame + 60, 500));
  if (dice.coin()) {
    trial.control |= 32U;
    trial.reverse_delay = static_cast<std::uint64_t>(dice.between(0, seeds_per_slot - 3));
  }
  trial.trouble = static_cast<Trouble>(dice.between(0, 5));
  trial.when =
      static_cast<std::uint64_t>(dice.between(0, trial.lines * static_cast<std::int64_t>(trial.line_seeds()) - 1));
  trial.bad_byte = static_cast<std::size_t>(dice.between(0, trial.lines * frame - 1));
  trial.bad_bits = static_cast<std::byte>(1U << static_cast<unsigned>(dice.between(0, 7)));
  trial.missing = dice.between(0, trial.lines);
  return trial;
}

class BoardAndModel : public testing::Test {
 protected:
  void prepare() {
    for (const test::Write& one : test::preparation(trial_.setup, static_cast<std::uint32_t>(trial_.first_tick))) {
      pair_.write(one);
    }
    pair_.write(fpga::kReverseDelayRegister, trial_.reverse_delay);
    if (trial_.trouble == Trouble::silence) {
      // Counted from the host's last word, which is its go or a byte.
      const std::uint64_t last_word = trial_.ahead ? kGoToGate : kByteToGate;
      pair_.silence_more_ = static_cast<std::int64_t>(kSilenceToGate) - static_cast<std::int64_t>(last_word);
      pair_.write(fpga::kSilenceLimitRegister, 3 * trial_.line_seeds() / 2);
      trial_.control |= test::kWatch;
    }
    pair_.write(fpga::kControlRegister, trial_.control);
  }
  /// Waits, but lets happen what comes before.
  void wait_until(std::uint64_t clock) {
    const bool momentary = trial_.trouble == Trouble::interlock || trial_.trouble == Trouble::stop;
    const std::uint64_t when = tick_0_ + trial_.when;
    if (gone_ && momentary && !happened_ && when < clock) {
      pair_.wait_until(std::max(when, pair_.now() + 10));  // what a byte before it sets off is over then
      happened_ = true;
      trial_.trouble == Trouble::stop ? pair_.stop() : pair_.interlock();
    }
    pair_.wait_until(clock);
  }
  void send_frame(std::int64_t number) {
    std::vector<std::byte> frame;
    const DeviceSetup& setup = trial_.setup;
    test::add_frame(frame, setup, first_line() + number, static_cast<std::uint32_t>(number));
    for (std::size_t at = 0; at < frame.size() && !pair_.faulty(); ++at, ++byte_) {
      const bool bad = trial_.trouble == Trouble::bad_byte && byte_ == trial_.bad_byte;
      pair_.byte(frame[at] ^ (bad ? trial_.bad_bits : std::byte{0}), bad && at == 0 ? kMarkToGate : kByteToGate);
    }
  }
  void go() {
    tick_0_ = pair_.now() + trial_.first_tick;
    gone_ = true;
    pair_.go();
  }
  std::int64_t first_line() const {
    return trial_.setup.first_revolution * trial_.setup.lines_per_revolution + trial_.setup.first_line;
  }
  void run() {
    prepare();
    const std::int64_t count = trial_.trouble == Trouble::starve ? trial_.missing : trial_.lines;
    if (!trial_.ahead) {
      go();
    }
    for (std::int64_t number = 0; number < count && !pair_.faulty(); ++number) {
      if (!trial_.ahead && number > 0) {  // well within the line before
        wait_until(tick_0_ + static_cast<std::uint64_t>(number - 1) * trial_.line_seeds() + 30);
      }
      send_frame(number);
    }
    if (trial_.ahead) {
      go();
    }
    wait_until(tick_0_ + static_cast<std::uint64_t>(trial_.lines + 2) * trial_.line_seeds() + 600);
    pair_.catch_up();
  }
  /// Whether the host spoke again so close to the limit that the latencies decide.
  bool too_close() const {
    const std::uint64_t limit = 3 * trial_.line_seeds() / 2;
    const auto close = pair_.silences().lower_bound(limit - std::min<std::uint64_t>(limit, 12));
    return trial_.trouble == Trouble::silence && close != pair_.silences().end() && *close < limit + 12;
  }
  void compare() {
    const fpga::LineProgress::Outputs progress = pair_.model.line_progress();
    const BoardStatus status = pair_.board->status();
    EXPECT_EQ(static_cast<unsigned>(status.fault), pair_.model.outputs().fault);
    EXPECT_EQ(status.executed_lines, progress.executed);
    EXPECT_EQ(status.partial_line, progress.partial);
    EXPECT_EQ(status.closed_slot, progress.partial ? progress.slots : 0U);
    for (const fpga::Register* one :
         {&fpga::kFaultsRegister, &fpga::kExecutedLinesRegister, &fpga::kClosedSlotRegister}) {
      EXPECT_EQ(pair_.board->read_register(one->address), pair_.read(*one)) << one->name;
    }
    compare_gate();
  }
  /// Slot by slot, far beyond the end.
  void compare_gate() {
    const DeviceSetup& setup = trial_.setup;
    std::size_t fired = 0;
    for (std::int64_t number = 0; number < trial_.lines + 2; ++number) {
      const std::int64_t ordinal = first_line() + number;
      const auto line = std::find_if(pair_.recorder.lines.begin(), pair_.recorder.lines.end(),
                                     [&](const test::Recorder::Line& one) { return one.ordinal == ordinal; });
      const bool backward = (trial_.control & 32U) != 0 && (ordinal & 1) != 0;
      for (std::int64_t slot = 0; slot < setup.slots_per_line; ++slot) {
        const auto begin = trial_.first_tick + static_cast<std::uint64_t>(number) * trial_.line_seeds() +
                           static_cast<std::uint64_t>(slot * setup.ticks_per_slot / 2) +
                           (backward ? trial_.reverse_delay : 0);
        bool expected = false;
        if (line != pair_.recorder.lines.end() && slot >= line->first_slot &&
            slot < line->first_slot + setup.window_slots) {
          const auto pixel = static_cast<std::size_t>(slot - line->first_slot);
          expected = (line->fired[pixel / 8] & static_cast<std::byte>(0x80U >> (pixel % 8))) != std::byte{0};
        }
        fired += expected ? 1 : 0;
        ASSERT_EQ(pair_.fired_at(begin), expected) << "line " << number << ", slot " << slot;
      }
    }
    fired_ += fired;
  }
  Trial trial_;
  Pair pair_;
  std::uint64_t tick_0_ = 0;
  std::size_t byte_ = 0;
  bool gone_ = false;
  bool happened_ = false;
  std::size_t fired_ = 0;
};

TEST_F(BoardAndModel, DoTheSameInEveryJob) {
  gravure::test::Dice dice;
  SCOPED_TRACE(gravure::test::Dice::note());
  std::set<std::uint8_t> faults;
  int partial = 0;
  int skipped = 0;
  for (int trial = 0; trial < 1000; ++trial) {
    SCOPED_TRACE(testing::Message() << "trial " << trial);
    trial_ = draw_trial(dice);
    pair_.reset();
    byte_ = 0;
    gone_ = happened_ = false;
    run();
    if (too_close()) {
      ++skipped;
      continue;
    }
    compare();
    if (HasFailure()) {
      return;
    }
    faults.insert(pair_.model.outputs().fault);
    partial += pair_.model.line_progress().partial ? 1 : 0;
  }
  EXPECT_EQ(faults.size(), 7U) << "no fault, and each of the six";
  EXPECT_GT(partial, 100);
  EXPECT_LT(skipped, 50);
  EXPECT_GT(fired_, 10'000U);
}

TEST(EmulatedBoard, ClosesItsGateInAnySlotThatTheSeedChooses) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> places;
  const DeviceSetup setup = test::wire_setup();
  std::vector<std::byte> stream = test::wire_stream(setup, 0, 5);
  stream.back() ^= std::byte{1};
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    BoardOptions options;
    options.seed = seed;
    EmulatedBoard board(std::move(options));
    for (const test::Write& one : test::preparation(setup, 100)) {
      board.write_register(one.address, one.value);
    }
    board.write_register(fpga::kControlRegister.address, test::kRunTimed);
    board.write_register(fpga::kCommandRegister.address, test::kGo);
    ASSERT_EQ(board.take(stream), stream.size());
    const BoardStatus status = board.status();
    ASSERT_EQ(status.fault, DeviceFault::checksum);
    places.emplace(status.executed_lines, status.closed_slot);
  }
  EXPECT_EQ(places.size(), 5U * 20U);
}

}  // namespace
}  // namespace gravure::emulator
