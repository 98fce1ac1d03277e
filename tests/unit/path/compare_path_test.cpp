#include "gravure/pipeline/compare_path.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "dice.hpp"
#include "gravure/formats/grv.hpp"
#include "gravure/pipeline/path_slots.hpp"
#include "grv_support.hpp"
#include "path_support.hpp"

namespace gravure {
namespace {

using grv_test::Folder;
using path_test::eased_line;
using path_test::request;
using test::SampledMotion;

constexpr double kPitch_mm = 0.01;

/// What a program is made of.
struct Made {
  std::vector<PathInstant> instants = eased_line(20, 9999);  // more than two blocks of rows
  PathPulses pulses = test::all_pulses(kPitch_mm, 1999);
  std::vector<PathTarget> targets;

  Made() {
    for (int i = 0; i < 5000; ++i) {
      targets.push_back({0.004 * i, {0.004 * i, 1.0 / 3, 0}, {0, 0.6, 0.8}});
    }
  }
};

std::unique_ptr<LineSource> program_of(const Folder& folder, const Made& made) {
  const SampledMotion motion(made.instants);
  ProgramHeader header;
  header.plan =
      make_path_plan(request(10), motion.instants(), made.pulses.count, static_cast<std::int64_t>(made.targets.size()))
          .value();
  const auto sink =
      create_grv(folder.file("p.grv"), 1, header.plan.rotary.lines_per_revolution, header.line_bytes()).value();
  EXPECT_TRUE(compile_path(header, motion, made.pulses, made.targets, *sink));
  return open_grv(folder.file("p.grv")).value();
}

std::vector<std::string> differences(const Made& stored, const Made& wanted) {
  const Folder folder;
  const auto program = program_of(folder, stored);
  const auto said = compare_path(*program, SampledMotion(wanted.instants), wanted.pulses, wanted.targets);
  EXPECT_TRUE(said) << said.error().message;
  return said ? said.value() : std::vector<std::string>{};
}

TEST(ComparePath, FindsNothingWhereNothingIsChanged) {
  EXPECT_EQ(differences({}, {}), std::vector<std::string>{});
}

TEST(ComparePath, AllowsWhatAnotherMathematicalLibraryMayRound) {
  Made other;
  for (PathInstant& instant : other.instants) {
    instant.axes[0] += 1e-12;
  }
  other.targets[7].position_mm[1] += 1e-12;
  EXPECT_EQ(differences({}, other), std::vector<std::string>{});
}

TEST(ComparePath, NamesAChangedWantedPoint) {
  Made changed;
  changed.targets[4321].position_mm[2] = 1e-6;
  EXPECT_EQ(differences(changed, {}),
            std::vector<std::string>{"1 wanted point differs from those of the job, the first is number 4321"});
}

TEST(ComparePath, NamesAChangedSetPointAndItsAxis) {
  Made changed;
  changed.instants[8191].axes[6] = 1e-6;
  changed.instants[9000].axes[0] += 1e-6;
  EXPECT_EQ(differences(changed, {}),
            std::vector<std::string>{"2 set-points differ from those the job leads to, the first is number 8191 (V)"});
}

TEST(ComparePath, NamesTheSlotOfAPulseThatIsMissing) {
  Made changed;
  changed.pulses.bits[100] = std::byte{0xEF};
  const auto said = differences(changed, {});
  ASSERT_EQ(said.size(), 1U);
  EXPECT_EQ(said[0].rfind("1 slot differs from what the job fires, the first is slot ", 0), 0U) << said[0];
}

/// The chunk of a program, with a pulse put one slot later on the way.
class LatePulse final : public LineSource {
 public:
  explicit LatePulse(LineSource& program) : program_(program) {}
  const ProgramHeader& header() const noexcept override { return program_.header(); }
  std::int64_t lines_per_chunk() const noexcept override { return program_.lines_per_chunk(); }
  Result<StoredChunk> fetch(ChunkAddress address) override { return program_.fetch(address); }
  Result<void> decode(const StoredChunk& chunk, std::span<std::byte> out) const override {
    GRAVURE_CHECK(program_.decode(chunk, out));
    for (std::size_t at = out.size() / 2; at < out.size(); ++at) {
      const auto byte = std::to_integer<unsigned>(out[at]);
      if ((byte & 0x60U) == 0x40U) {  // slot 1 of these 8 fires, slot 2 does not
        out[at] = static_cast<std::byte>(byte ^ 0x60U);
        break;
      }
    }
    return {};
  }
  Result<void> read_set_points(std::int64_t first, std::span<PathSetPoint> out) override {
    return program_.read_set_points(first, out);
  }
  Result<void> read_targets(std::int64_t first, std::span<PathTarget> out) override {
    return program_.read_targets(first, out);
  }

 private:
  LineSource& program_;
};

TEST(ComparePath, NamesAPulseThatComesOneSlotLate) {
  const Folder folder;
  const Made made;
  const auto program = program_of(folder, made);
  LatePulse late(*program);
  const auto said = compare_path(late, SampledMotion(made.instants), made.pulses, made.targets);
  ASSERT_TRUE(said) << said.error().message;
  ASSERT_EQ(said.value().size(), 1U);
  EXPECT_EQ(said.value()[0].rfind("2 slots differ", 0), 0U) << said.value()[0];
}

TEST(ComparePath, SaysWhereNumbersOfRowsDiffer) {
  Made shorter;
  shorter.instants = eased_line(20, 9990);
  shorter.targets.pop_back();
  EXPECT_EQ(differences({}, shorter),
            (std::vector<std::string>{"the program stores 5000 wanted points, the job has 4999",
                                      "the program stores 10000 set-points, the job leads to 9991"}));
}

/// Slots of a spot that stands, runs for one period and stands again: it is fastest in the middle.
TEST(PathSlots, BoundsSpeedAndErrorBetweenSetPoints) {
  test::Dice dice;
  SCOPED_TRACE(test::Dice::note());
  for (int trial = 0; trial < 2000; ++trial) {
    PathWindow window{};
    for (std::size_t i = 1; i < 4; ++i) {
      const std::int64_t step = dice.coin() ? 0 : dice.between(0, 1'000'000);
      window[i].along_counts = window[i - 1].along_counts + (trial == 0 ? (i == 2 ? 1'000'000 : 0) : step);
    }
    const CoveredPath covered(window);
    double fastest = 0;
    constexpr int kSteps = 2000;
    for (int i = 0; i < kSteps; ++i) {
      fastest =
          std::max(fastest, kSteps * (covered.at((i + 1.0) / kSteps) - covered.at(static_cast<double>(i) / kSteps)));
    }
    ASSERT_GE(covered.max_speed(), fastest - 1e-6) << trial;
    ASSERT_LE(covered.max_speed(), fastest * 1.003 + 1) << trial;
    if (trial == 0) {
      ASSERT_NEAR(covered.max_speed(), 1.5e6, 1);
    }
  }
}

TEST(PathSlots, HalfASlotIsNeverLessThanAnErrorWhereTheSpotSpeedsUpWithinAPeriod) {
  std::vector<PathInstant> instants(12);
  for (std::size_t i = 5; i < instants.size(); ++i) {
    instants[i].along_mm = instants[i].axes[0] = 0.1;  // at rest, 0.1 mm in one period, at rest
  }
  const SampledMotion motion(instants);
  Plan plan = make_path_plan(request(ratio(33, 10)), motion.instants(), 30, 0).value();
  const PathPulses pulses = test::all_pulses(0.0033, 30);
  PathSlots slots(plan, pulses);
  for (std::size_t line = 0; line + 1 < instants.size(); ++line) {
    PathWindow window{};
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t at = std::min(line + i, instants.size()) - (line + i > 0 ? 1 : 0);
      window[i].along_counts = std::llround(instants[at].along_mm * 1e9);
    }
    std::vector<std::byte> bits(13);
    ASSERT_TRUE(slots.place(window, bits));
  }
  const PathSpacing spacing = slots.spacing();
  EXPECT_NEAR(spacing.max_speed_mm_s, 0.1 / 50e-6 * 1.5, 1e-3);
  EXPECT_NEAR(spacing.half_slot_um, 0.75, 1e-6);  // 100 slots a period
  EXPECT_LE(spacing.max_error_um, spacing.half_slot_um);
  EXPECT_GT(spacing.max_error_um, 0.5);  // more than half a slot of the mean speed
}

}  // namespace
}  // namespace gravure
