#include "gravure/pipeline/compile_path.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "gravure/formats/grv.hpp"
#include "grv_support.hpp"
#include "path_support.hpp"

namespace gravure {
namespace {

using grv_test::Folder;
using path_test::eased_line;
using path_test::even_line;
using path_test::request;
using test::all_pulses;
using test::SampledMotion;

struct Compiled {
  CompiledPath made;
  std::unique_ptr<LineSource> source;
};

std::vector<PathTarget> straight_targets(double length_mm, int count) {
  std::vector<PathTarget> targets;
  for (int i = 0; i < count; ++i) {
    const double along = length_mm * i / (count - 1);
    targets.push_back({along, {along, -0.25 * i, 1.0 / 3}, {0, 0.6, 0.8}});
  }
  return targets;
}

Result<Compiled> compile_to(const std::string& path, const std::vector<PathInstant>& instants, const PathPulses& pulses,
                            const std::vector<PathTarget>& targets = {}, GrvOptions options = {},
                            bool focus_axis = false) {
  options.focus_axis = focus_axis;
  const SampledMotion motion(instants);
  ProgramHeader header;
  const Rational pitch_um = ratio(std::llround(pulses.pitch_mm * 1e6), 1000);
  const PathPlanRequest wanted = focus_axis ? path_test::with_focus_axis(request(pitch_um), -2, 2) : request(pitch_um);
  GRAVURE_TRY(header.plan,
              make_path_plan(wanted, motion.instants(), pulses.count, static_cast<std::int64_t>(targets.size())));
  header.job_text = "mode = \"freeform\"\n";
  GRAVURE_TRY(const auto sink,
              create_grv(path, 1, header.plan.rotary.lines_per_revolution, header.line_bytes(), options));
  GRAVURE_TRY(CompiledPath made, compile_path(header, motion, pulses, targets, *sink));
  GRAVURE_TRY(auto source, open_grv(path));
  return Compiled{std::move(made), std::move(source)};
}

/// Slots that fire, counted from the begin of the path.
std::vector<std::int64_t> fired_slots(LineSource& source) {
  std::vector<std::int64_t> fired;
  const Plan& plan = source.header().plan;
  const std::int64_t line_bytes = source.header().line_bytes();
  for (std::int64_t first = 0; first < plan.rotary.lines_per_revolution; first += source.lines_per_chunk()) {
    const std::int64_t lines = std::min(source.lines_per_chunk(), plan.rotary.lines_per_revolution - first);
    std::vector<std::byte> bits(static_cast<std::size_t>(lines * line_bytes));
    const auto chunk = source.fetch({0, first / source.lines_per_chunk()});
    EXPECT_TRUE(source.decode(chunk.value(), bits));
    for (std::int64_t slot = 0; slot < lines * plan.line.slots; ++slot) {
      const std::int64_t inside = slot % plan.line.slots;
      const auto at = static_cast<std::size_t>(slot / plan.line.slots * line_bytes + inside / 8);
      if ((bits[at] & static_cast<std::byte>(0x80U >> (inside % 8))) != std::byte{0}) {
        fired.push_back(first * plan.line.slots + slot);
      }
    }
  }
  return fired;
}

TEST(CompilePath, FiresEvenlyAtConstantSpeed) {
  const Folder folder;
  // A micrometre a slot, pulses 10 um apart: the first belongs half a pitch from the begin.
  const auto made = compile_to(folder.file("p.grv"), even_line(0.1, 50), all_pulses(0.01, 499));
  ASSERT_TRUE(made) << made.error().message;
  const auto slots = fired_slots(*made.value().source);
  ASSERT_EQ(slots.size(), 499U);
  for (std::size_t i = 20; i < 480; ++i) {  // the ends, where the test's axis is torn from rest, are not even
    EXPECT_EQ(slots[i], static_cast<std::int64_t>(10 * i + 5));
  }
}

TEST(CompilePath, FiresInTheSlotNearestToEachPitch) {
  const Folder folder;
  const auto instants = eased_line(20, 3000);
  const auto made = compile_to(folder.file("p.grv"), instants, all_pulses(0.007, 2857));
  ASSERT_TRUE(made) << made.error().message;
  const auto slots = fired_slots(*made.value().source);
  ASSERT_EQ(slots.size(), 2857U);
  const auto along = [](double slot) {
    const double s = slot / 300'000;
    return 20 * s * s * s * (10 - 15 * s + 6 * s * s);
  };
  for (std::size_t i = 0; i < slots.size(); ++i) {
    const double belongs = (static_cast<double>(i) + 0.5) * 0.007;
    const auto slot = static_cast<double>(slots[i]);
    ASSERT_LE(along(slot - 0.51), belongs) << "pulse " << i;
    ASSERT_GE(along(slot + 0.51), belongs) << "pulse " << i;
  }
  const PathSpacing& spacing = made.value().made.spacing;
  EXPECT_EQ(spacing.fired, 2857);
  EXPECT_LE(spacing.max_error_um, spacing.half_slot_um);
  EXPECT_GT(spacing.max_error_um, spacing.half_slot_um / 2);
  EXPECT_NEAR(spacing.max_speed_mm_s, 20 * 1.875 / 0.15, 0.5);
}

TEST(CompilePath, LeavesOutPulsesWhoseBitIsZero) {
  const Folder folder;
  PathPulses pulses = all_pulses(0.01, 499);
  pulses.bits[5] = std::byte{0x7F};
  const auto made = compile_to(folder.file("p.grv"), even_line(0.1, 50), pulses);
  ASSERT_TRUE(made) << made.error().message;
  const auto slots = fired_slots(*made.value().source);
  EXPECT_EQ(slots.size(), 498U);
  EXPECT_EQ(std::count(slots.begin(), slots.end(), 405), 0);
  EXPECT_EQ(made.value().made.spacing.pulses, 499);
}

TEST(CompilePath, KeepsTheLightOffWhileNoPathIsCovered) {
  const Folder folder;
  std::vector<PathInstant> instants = eased_line(2, 500);
  const std::vector<PathInstant> rest(300, instants.back());
  instants.insert(instants.end(), rest.begin(), rest.end());
  for (PathInstant instant : eased_line(2, 500)) {
    instant.along_mm += 2;
    instants.push_back(instant);
  }
  const auto made = compile_to(folder.file("p.grv"), instants, all_pulses(0.01, 400));
  ASSERT_TRUE(made) << made.error().message;
  const auto slots = fired_slots(*made.value().source);
  ASSERT_EQ(slots.size(), 400U);
  for (const std::int64_t slot : slots) {
    EXPECT_TRUE(slot <= 50'000 || slot >= 80'100) << slot;
  }
}

TEST(CompilePath, StoresEverySetPointAndWantedPoint) {
  const Folder folder;
  const auto instants = eased_line(20, 9999);  // more than two chunks of rows
  const auto targets = straight_targets(20, 5000);
  for (const auto compression :
       {GrvOptions::Compression::zstd, GrvOptions::Compression::deflate, GrvOptions::Compression::none}) {
    const auto made = compile_to(folder.file("p.grv"), instants, all_pulses(0.01, 1000), targets, {compression});
    ASSERT_TRUE(made) << made.error().message;
    LineSource& source = *made.value().source;
    std::vector<PathSetPoint> points(instants.size());
    ASSERT_TRUE(source.read_set_points(0, points));
    for (std::size_t i = 0; i < points.size(); ++i) {
      for (std::size_t axis = 0; axis < kPathAxes.size(); ++axis) {
        ASSERT_EQ(points[i].counts[axis], std::llround(instants[i].axes[axis] * 1e13));
      }
      ASSERT_EQ(points[i].along_counts, std::llround(instants[i].along_mm * 1e9));
    }
    std::vector<PathSetPoint> some(10);
    ASSERT_TRUE(source.read_set_points(8190, some));
    EXPECT_TRUE(std::equal(some.begin(), some.end(), points.begin() + 8190));
    EXPECT_EQ(source.read_set_points(9991, some).error().code, ErrorCode::bad_argument);
    std::vector<PathTarget> found(targets.size());
    ASSERT_TRUE(source.read_targets(0, found));
    for (std::size_t i = 0; i < found.size(); ++i) {
      ASSERT_NEAR(found[i].along_mm, targets[i].along_mm, 0.5e-9);
      ASSERT_NEAR(found[i].position_mm[1], targets[i].position_mm[1], 0.5e-9);
      ASSERT_NEAR(found[i].normal[2], 0.8, 0.5e-12);
    }
  }
}

TEST(CompilePath, StoresTheFocusAxisInAFormatOfItsOwn) {
  const Folder folder;
  auto instants = eased_line(20, 9999);
  const auto plain = compile_to(folder.file("p.grv"), instants, all_pulses(0.01, 1000));
  for (std::size_t i = 0; i < instants.size(); ++i) {
    instants[i].axes[kFocusAxis] = std::sin(static_cast<double>(i) / 700);
  }
  const auto again = compile_to(folder.file("again.grv"), instants, all_pulses(0.01, 1000));
  const auto made = compile_to(folder.file("w.grv"), instants, all_pulses(0.01, 1000), {}, {}, true);
  ASSERT_TRUE(plain && again && made) << made.error().message;
  EXPECT_EQ(plain.value().source->header().format_version, 1U);
  EXPECT_FALSE(plain.value().source->header().plan.path->has_focus_axis());
  EXPECT_EQ(grv_test::load(folder.file("p.grv")), grv_test::load(folder.file("again.grv"))) << "no W, no trace of it";
  EXPECT_EQ(made.value().source->header().format_version, 2U);
  EXPECT_EQ(made.value().source->header().plan.path->axes.at(kFocusAxis).most, Rational(2));
  std::vector<PathSetPoint> points(instants.size());
  ASSERT_TRUE(plain.value().source->read_set_points(0, points));
  EXPECT_EQ(points[700].counts[kFocusAxis], 0);
  ASSERT_TRUE(made.value().source->read_set_points(0, points));
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t axis = 0; axis < kPathAxes.size(); ++axis) {
      ASSERT_EQ(points[i].counts[axis], std::llround(instants[i].axes[axis] * 1e13)) << kPathAxes[axis];
    }
    ASSERT_EQ(points[i].along_counts, std::llround(instants[i].along_mm * 1e9));
  }
}

TEST(PathProgram, IsRefusedWhereItsSinkWasMadeForOtherAxes) {
  for (const bool focus_axis : {false, true}) {
    const Folder folder;
    const SampledMotion motion(even_line(0.1, 50));
    ProgramHeader header;
    header.plan =
        make_path_plan(focus_axis ? path_test::with_focus_axis(request(10), -2, 2) : request(10), 51, 499, 0).value();
    const auto sink = create_grv(folder.file("p.grv"), 1, 50, header.line_bytes(), {.focus_axis = !focus_axis}).value();
    const auto made = compile_path(header, motion, all_pulses(0.01, 499), {}, *sink);
    ASSERT_FALSE(made);
    EXPECT_EQ(made.error().code, ErrorCode::bad_argument);
    EXPECT_NE(made.error().message.find(focus_axis ? "a focus axis, its set-points were put without W"
                                                   : "no focus axis, its set-points were put with W"),
              std::string::npos)
        << made.error().message;
  }
}

TEST(CompilePath, RefusesAPathTooFastForThePulses) {
  const Folder folder;
  const auto made = compile_to(folder.file("p.grv"), even_line(0.1, 50), all_pulses(0.0005, 9000));
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, ErrorCode::out_of_range);
  // 2000 mm/s, and 4/3 of it in the first period, where the spot is torn from rest.
  EXPECT_NE(made.error().message.find("2666.6"), std::string::npos) << made.error().message;
  EXPECT_TRUE(folder.names().empty());
}

TEST(CompilePath, RefusesWhatDoesNotFit) {
  const Folder folder;
  const auto refused = [&folder](const std::vector<PathInstant>& instants, const PathPulses& pulses,
                                 const std::string& says) {
    const auto made = compile_to(folder.file("p.grv"), instants, pulses);
    ASSERT_FALSE(made) << says;
    EXPECT_EQ(made.error().code, ErrorCode::bad_argument);
    EXPECT_NE(made.error().message.find(says), std::string::npos) << made.error().message;
    EXPECT_TRUE(folder.names().empty());
  };
  refused(even_line(0.1, 50), all_pulses(0.01, 501), "ends before pulse 500");
  auto shrinking = even_line(0.1, 50);
  shrinking[7].along_mm = 0.5;
  refused(shrinking, all_pulses(0.01, 10), "instant 7");
  auto broken = even_line(0.1, 50);
  broken[9].axes[4] = std::nan("");
  refused(broken, all_pulses(0.01, 10), "instant 9 of the motion: C is");
  refused({PathInstant{}}, all_pulses(0.01, 10), "at least 2");
}

TEST(PathPlan, NamesThePeriodsThatWouldFit) {
  PathPlanRequest wanted = request(5);
  wanted.servo_period_us = ratio(503, 10);
  const auto plan = make_path_plan(wanted, 10, 0, 0);
  ASSERT_FALSE(plan);
  EXPECT_NE(plan.error().message.find("50 or 50.5"), std::string::npos) << plan.error().message;
}

TEST(PathProgram, IsRefusedWhereSetPointsWereNotPut) {
  const Folder folder;
  const SampledMotion motion(even_line(0.1, 5));
  ProgramHeader header;
  header.plan = make_path_plan(request(10), 6, 0, 0).value();
  header.layers = {{}};
  header.layer_of_revolution = {0};
  const auto sink = create_grv(folder.file("p.grv"), 1, 5, header.line_bytes()).value();
  ASSERT_TRUE(sink->put(sink->encode({0, 0}, std::vector<std::byte>(5 * 13)).value()));
  ASSERT_TRUE(sink->put_set_points(std::vector<PathSetPoint>(5)));
  const auto done = sink->finish(header);
  ASSERT_FALSE(done);
  EXPECT_NE(done.error().message.find("5 set-points"), std::string::npos) << done.error().message;
}

TEST(PathProgram, IsRefusedWhereverAByteIsAltered) {
  const Folder folder;
  ASSERT_TRUE(compile_to(folder.file("p.grv"), eased_line(20, 5000), all_pulses(0.01, 1000), straight_targets(20, 50)));
  const auto whole = grv_test::load(folder.file("p.grv"));
  for (std::size_t at = 0; at < whole.size(); at += whole.size() / 150) {
    auto bytes = whole;
    bytes[at] ^= std::byte{0x10};
    grv_test::save(folder.file("q.grv"), bytes);
    auto source = open_grv(folder.file("q.grv"));
    if (source) {  // in a chunk of lines, which is verified when it is read
      const auto chunk = source.value()->fetch({0, 0});
      std::vector<std::byte> bits(static_cast<std::size_t>(source.value()->header().line_bytes() * 5000));
      EXPECT_FALSE(source.value()->decode(chunk.value(), bits)) << at;
    }
  }
}

}  // namespace
}  // namespace gravure
