#include "gravure/formats/plan_json.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <nlohmann/json.hpp>

#include "sync_support.hpp"

namespace gravure {
namespace {

using nlohmann::ordered_json;
using sync_test::planned;
using sync_test::Random;
using sync_test::roller_job;
using sync_test::seed_note;
using sync_test::tube_job;

Plan roller_plan() {
  Job job = roller_job();
  job.title = "honeycomb \"A\" \xC3\xA4\n";
  job.scanner.bidirectional_offset_ticks = -250;
  return planned(job, 3500, 100);
}

ordered_json roller_json() {
  return ordered_json::parse(plan_to_json(roller_plan()));
}

std::vector<std::string> keys_of(const ordered_json& object) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : object.items()) {
    keys.push_back(key);
  }
  return keys;
}

/// The first keys of a section are the documented ones, in their order.
void expect_first_keys(const ordered_json& object, const std::vector<std::string>& expected) {
  std::vector<std::string> keys = keys_of(object);
  ASSERT_GE(keys.size(), expected.size());
  keys.resize(expected.size());
  EXPECT_EQ(keys, expected);
}

TEST(PlanJson, HasTheDocumentedKeysInTheirOrder) {
  const ordered_json json = roller_json();
  EXPECT_EQ(keys_of(json),
            (std::vector<std::string>{"title", "mode", "clock", "line", "rotary", "ab", "job", "warnings"}));
  expect_first_keys(json["clock"], {"seed_hz", "fpga_hz", "pulse_hz", "ticks_per_slot"});
  expect_first_keys(json["line"], {"pixels", "slots", "ticks", "rate_hz", "scan_speed_m_s", "marking_first_slot"});
  EXPECT_EQ(keys_of(json["line"]["marking_first_slot"]), (std::vector<std::string>{"forward", "reverse"}));
  expect_first_keys(json["rotary"], {"lines_per_revolution", "line_pitch_um", "ticks_per_revolution", "rpm"});
  expect_first_keys(json["ab"], {"prescaler", "increment", "fraction", "output_hz", "wanted_hz", "exact",
                                 "drift_lines_per_revolution", "drift_um_per_revolution", "lines_until_limit",
                                 "revolutions_until_limit", "bound_lines_until_limit"});
  EXPECT_EQ(keys_of(json["ab"]["fraction"]), (std::vector<std::string>{"num", "den"}));
  EXPECT_EQ(keys_of(json["ab"]["drift_lines_per_revolution"]), (std::vector<std::string>{"num", "den"}));
  expect_first_keys(json["job"], {"revolutions", "ticks", "duration_s"});
}

TEST(PlanJson, WritesReadableNumbers) {
  const ordered_json json = roller_json();
  EXPECT_EQ(json["clock"]["pulse_hz"].dump(), "2000000");
  EXPECT_EQ(json["line"]["scan_speed_m_s"].dump(), "16");
  EXPECT_EQ(json["line"]["rate_hz"].dump(), "511.63980557687387");
  EXPECT_EQ(json["rotary"]["line_pitch_um"].dump(), "7.999981292563772");
  EXPECT_EQ(json["ab"]["increment"].dump(), "141835289");
  EXPECT_EQ(json["ab"]["drift_lines_per_revolution"]["den"].dump(), "\"208291482765885440\"");
  EXPECT_EQ(json["ab"]["ratios"]["wanted_increment"]["num"].dump(), "\"208291482765885440\"");
  EXPECT_EQ(json["warnings"].size(), 1U);
}

TEST(PlanJson, WritesNullForNever) {
  Job job = roller_job();
  job.fpga.fractional = true;
  const ordered_json json = ordered_json::parse(plan_to_json(planned(job, 3500, 1)));
  EXPECT_TRUE(json["ab"]["lines_until_limit"].is_null());
  EXPECT_TRUE(json["ab"]["revolutions_until_limit"].is_null());
  EXPECT_TRUE(json["ab"]["exact"].get<bool>());
}

TEST(PlanJson, SwitchesToStringsAbove2To53) {
  Plan plan = roller_plan();
  plan.ab.bound_lines_until_limit = Integer(1) << 53U;
  EXPECT_NE(plan_to_json(plan).find("\"bound_lines_until_limit\": 9007199254740992,"), std::string::npos);
  plan.ab.bound_lines_until_limit += 1;
  EXPECT_NE(plan_to_json(plan).find("\"bound_lines_until_limit\": \"9007199254740993\","), std::string::npos);
}

// Comparisons of their own, field by field: were one left out of the JSON, reading would leave its default.
void expect_equal(const AbPlan& a, const AbPlan& b) {
  EXPECT_EQ(a.counter_bits, b.counter_bits);
  EXPECT_EQ(a.prescaler, b.prescaler);
  EXPECT_EQ(a.increment, b.increment);
  EXPECT_EQ(a.fraction_num, b.fraction_num);
  EXPECT_EQ(a.fraction_den, b.fraction_den);
  EXPECT_EQ(a.wanted_increment, b.wanted_increment);
  EXPECT_EQ(a.wanted_hz, b.wanted_hz);
  EXPECT_EQ(a.output_hz, b.output_hz);
  EXPECT_EQ(a.max_output_hz, b.max_output_hz);
  EXPECT_EQ(a.exact, b.exact);
  EXPECT_EQ(a.drift_lines_per_revolution, b.drift_lines_per_revolution);
  EXPECT_EQ(a.drift_um_per_revolution, b.drift_um_per_revolution);
  EXPECT_EQ(a.seam_limit_um, b.seam_limit_um);
  EXPECT_EQ(a.lines_until_limit, b.lines_until_limit);
  EXPECT_EQ(a.revolutions_until_limit, b.revolutions_until_limit);
  EXPECT_EQ(a.bound_lines_until_limit, b.bound_lines_until_limit);
}

void expect_equal(const CarriagePlan& a, const CarriagePlan& b) {
  EXPECT_EQ(a.feed_pixels, b.feed_pixels);
  EXPECT_EQ(a.feed_um, b.feed_um);
  EXPECT_EQ(a.layers, b.layers);
  EXPECT_EQ(a.columns, b.columns);
  EXPECT_EQ(a.window_columns, b.window_columns);
  EXPECT_EQ(a.revolutions, b.revolutions);
  EXPECT_EQ(a.travel_mm, b.travel_mm);
  EXPECT_EQ(a.speed_mm_s, b.speed_mm_s);
  EXPECT_EQ(a.encoder_pitch_um, b.encoder_pitch_um);
  EXPECT_EQ(a.interpolation_bits, b.interpolation_bits);
  EXPECT_EQ(a.edges_per_revolution, b.edges_per_revolution);
  expect_equal(a.ab, b.ab);
}

void expect_equal(const ScannerPlan& a, const ScannerPlan& b) {
  EXPECT_EQ(a.field_mm, b.field_mm);
  EXPECT_EQ(a.resolution_bits, b.resolution_bits);
  EXPECT_EQ(a.lag_us, b.lag_us);
  EXPECT_EQ(a.compensate_lag, b.compensate_lag);
  EXPECT_EQ(a.max_speed_mm_s, b.max_speed_mm_s);
  EXPECT_EQ(a.max_acceleration_mm_s2, b.max_acceleration_mm_s2);
  EXPECT_EQ(a.max_jerk_mm_s3, b.max_jerk_mm_s3);
  EXPECT_EQ(a.cross_scan_correction, b.cross_scan_correction);
  EXPECT_EQ(a.offset_deg, b.offset_deg);
  EXPECT_EQ(a.tilt_deg_per_mm, b.tilt_deg_per_mm);
  EXPECT_EQ(a.field_grid, b.field_grid);
}

void expect_equal(const Plan& a, const Plan& b) {
  EXPECT_EQ(a.title, b.title);
  EXPECT_EQ(a.mode, b.mode);
  EXPECT_EQ(a.clock.seed_hz, b.clock.seed_hz);
  EXPECT_EQ(a.clock.fpga_hz, b.clock.fpga_hz);
  EXPECT_EQ(a.clock.pulse_divider, b.clock.pulse_divider);
  EXPECT_EQ(a.clock.pulse_hz, b.clock.pulse_hz);
  EXPECT_EQ(a.clock.ticks_per_slot, b.clock.ticks_per_slot);
  EXPECT_EQ(a.line.pixels, b.line.pixels);
  EXPECT_EQ(a.line.slots, b.line.slots);
  EXPECT_EQ(a.line.slots_per_microvector, b.line.slots_per_microvector);
  EXPECT_EQ(a.line.ticks, b.line.ticks);
  EXPECT_EQ(a.line.bidirectional, b.line.bidirectional);
  EXPECT_EQ(a.line.forward_first_slot, b.line.forward_first_slot);
  EXPECT_EQ(a.line.reverse_first_slot, b.line.reverse_first_slot);
  EXPECT_EQ(a.line.offset_slots, b.line.offset_slots);
  EXPECT_EQ(a.line.offset_remainder_ticks, b.line.offset_remainder_ticks);
  EXPECT_EQ(a.line.rate_hz, b.line.rate_hz);
  EXPECT_EQ(a.line.pixel_pitch_um, b.line.pixel_pitch_um);
  EXPECT_EQ(a.line.scan_speed_m_s, b.line.scan_speed_m_s);
  EXPECT_EQ(a.rotary.lines_per_revolution, b.rotary.lines_per_revolution);
  EXPECT_EQ(a.rotary.circumference_um, b.rotary.circumference_um);
  EXPECT_EQ(a.rotary.line_pitch_um, b.rotary.line_pitch_um);
  EXPECT_EQ(a.rotary.ticks_per_revolution, b.rotary.ticks_per_revolution);
  EXPECT_EQ(a.rotary.rpm, b.rotary.rpm);
  EXPECT_EQ(a.rotary.surface_speed_mm_s, b.rotary.surface_speed_mm_s);
  EXPECT_EQ(a.rotary.encoder_lines, b.rotary.encoder_lines);
  EXPECT_EQ(a.rotary.interpolation_bits, b.rotary.interpolation_bits);
  EXPECT_EQ(a.rotary.gear_encoder_turns, b.rotary.gear_encoder_turns);
  EXPECT_EQ(a.rotary.gear_workpiece_turns, b.rotary.gear_workpiece_turns);
  EXPECT_EQ(a.rotary.encoder_pitch_um, b.rotary.encoder_pitch_um);
  EXPECT_EQ(a.rotary.edges_per_revolution, b.rotary.edges_per_revolution);
  expect_equal(a.ab, b.ab);
  ASSERT_EQ(a.carriage.has_value(), b.carriage.has_value());
  if (a.carriage) {
    expect_equal(*a.carriage, *b.carriage);
  }
  ASSERT_EQ(a.bands.has_value(), b.bands.has_value());
  if (a.bands) {
    EXPECT_EQ(a.bands->count, b.bands->count);
    EXPECT_EQ(a.bands->columns, b.bands->columns);
    EXPECT_EQ(a.bands->revolutions_per_band, b.bands->revolutions_per_band);
    EXPECT_EQ(a.bands->step_mm, b.bands->step_mm);
  }
  EXPECT_EQ(a.job.revolutions, b.job.revolutions);
  EXPECT_EQ(a.job.ticks, b.job.ticks);
  EXPECT_EQ(a.job.duration_s, b.job.duration_s);
  EXPECT_EQ(a.warnings, b.warnings);
  ASSERT_EQ(a.scanner.has_value(), b.scanner.has_value());
  if (a.scanner) {
    expect_equal(*a.scanner, *b.scanner);
  }
}

TEST(PlanJson, ReadsBackEveryField) {
  const Plan plan = roller_plan();
  const Result<Plan> again = plan_from_json(plan_to_json(plan));
  ASSERT_TRUE(again) << again.error().message;
  expect_equal(plan, again.value());
}

TEST(PlanJson, ReadsBackRandomPlansOfAnySize) {
  SCOPED_TRACE(seed_note());
  Random random;
  int planned_jobs = 0;
  for (int trial = 0; trial < 300; ++trial) {
    Job job = random.chance(2) ? roller_job() : tube_job();
    job.laser.pulse_divider = random.count(16, 200);
    job.fpga.counter_bits = static_cast<int>(random.between(8, 64));
    job.fpga.fractional = random.chance(2);
    job.fpga.max_prescaler = random.between(1, std::numeric_limits<std::uint64_t>::max());
    job.scanner.pixel_pitch_um = ratio(random.count(1, 100'000), 1009);
    job.scanner.bidirectional = random.chance(2);
    job.rotary.gear_encoder_turns = random.count(1, 100);
    job.rotary.gear_workpiece_turns = random.count(90, 200);
    job.limits.seam_um = ratio(1, random.count(1, 1'000'000));
    job.mode = static_cast<Mode>(random.between(0, 2));
    job.carriage = {ratio(random.count(1, 100'000), random.count(1, 1009)),
                    random.count(1, 9),
                    ratio(random.count(1, 1'000'000), 1009),
                    static_cast<int>(random.between(0, 12)),
                    2'000'000,
                    {}};
    job.stage = {random.count(1, 100'000),
                 ratio(random.count(1, 100'000), 1009),
                 ratio(random.count(1, 1'000'000), 1009),
                 static_cast<int>(random.between(0, 12)),
                 2'000'000,
                 {}};
    if (random.chance(2) && job.mode != Mode::helical) {
      job.scanner.field_mm = ratio(random.count(1, 100'000), 1009);
    }
    job.scanner.resolution_bits = static_cast<int>(random.between(8, 26));
    job.scanner.lag_us = ratio(random.count(0, 100'000), 1009);
    job.scanner.compensate_lag = random.chance(2);
    job.scanner.cross_scan_correction = random.chance(2);
    job.scanner.tilt_deg_per_mm = ratio(random.count(0, 1009), 1009);
    job.scanner.field_grid_text = random.chance(2) ? "gravure-field-grid 1\n\"\t" : "";
    if (random.chance(2)) {
      job.scanner.max_speed_mm_s = ratio(random.count(1, 100'000), 1009);
      job.scanner.max_jerk_mm_s3 = random.count(1, 1'000'000'000'000'000'000);
    }
    if (job.mode != Mode::flat) {
      job.scanner.offset_deg = ratio(random.count(0, 170) - 85, 7);
    }
    const std::int64_t exposures = job.mode == Mode::helical ? job.carriage.layers : random.count(1, 1000);
    const Result<Plan> plan = make_plan(job, random.count(1, 5000), exposures);
    if (!plan) {
      continue;
    }
    ++planned_jobs;
    const std::string text = plan_to_json(plan.value());
    const Result<Plan> again = plan_from_json(text);
    ASSERT_TRUE(again) << again.error().message;
    EXPECT_EQ(plan_to_json(again.value()), text);
    expect_equal(plan.value(), again.value());
  }
  EXPECT_GT(planned_jobs, 100);
}

TEST(PlanJson, ReadsWholeNumbersInBothFormsAndSkipsUnknownKeys) {
  ordered_json json = roller_json();
  json["clock"]["seed_hz"] = "82000000";
  json["ab"]["drift_lines_per_revolution"]["den"] = 208'291'482'765'885'440;
  json["later"] = {{"anything", 1}};
  const Result<Plan> plan = plan_from_json(json.dump());
  ASSERT_TRUE(plan) << plan.error().message;
  expect_equal(plan.value(), roller_plan());
}

TEST(PlanJson, HasTheSectionsOfItsMode) {
  Job job = roller_job();
  job.mode = Mode::helical;
  job.rotary.interpolation_bits = 7;
  job.carriage = {64, 8, 20, 8, 2'000'000, {}};
  const ordered_json helical = ordered_json::parse(plan_to_json(planned(job, 15'000, 8)));
  EXPECT_EQ(helical["mode"], "helical");
  expect_first_keys(helical["carriage"],
                    {"feed_pixels", "feed_um", "layers", "window_columns", "revolutions", "ab", "columns"});
  for (const auto& [key, value] : helical["ab"].items()) {
    EXPECT_TRUE(helical["carriage"]["ab"].contains(key)) << key;
  }
  EXPECT_FALSE(helical.contains("bands"));
  job.mode = Mode::flat;
  job.stage = {5000, 8, 20, 8, 2'000'000, {}};
  job.scanner.field_mm = 30;
  const ordered_json flat = ordered_json::parse(plan_to_json(planned(job, 5000, 2)));
  EXPECT_FALSE(flat.contains("rotary") || flat.contains("carriage"));
  expect_first_keys(flat["stage"], {"lines", "line_pitch_um", "ticks_per_pass", "length_um", "speed_mm_s"});
  expect_first_keys(flat["bands"], {"count", "columns", "revolutions_per_band"});
  EXPECT_EQ(flat["bands"]["count"], 2);
  EXPECT_FALSE(roller_json().contains("bands") || roller_json().contains("carriage"));
  expect_first_keys(flat["scanner"], {"field_mm", "resolution_bits", "lag_us", "compensate_lag", "max_speed_mm_s"});
  EXPECT_TRUE(flat["scanner"]["max_speed_mm_s"].is_null());
  EXPECT_FALSE(roller_json().contains("scanner"));
}

TEST(PlanJson, RefusesScannersThatCannotBe) {
  Job job = roller_job();
  job.scanner.field_mm = 30;
  const ordered_json good = ordered_json::parse(plan_to_json(planned(job, 3500, 2)));
  const auto refusal = [&good](const std::string& key, const ordered_json& value) {
    ordered_json json = good;
    json["scanner"][key] = value;
    if (value.is_number()) {
      json["scanner"]["ratios"][key] = {{"num", value}, {"den", 1}};
    }
    const Result<Plan> plan = plan_from_json(json.dump());
    return plan ? std::string() : plan.error().message;
  };
  EXPECT_EQ(refusal("lag_us", 3), "");
  EXPECT_EQ(refusal("field_mm", 27), "plan: scanner.field_mm does not hold the pixels of a line");
  EXPECT_EQ(refusal("field_mm", 0).rfind("plan: scanner.field_mm", 0), 0U);
  EXPECT_EQ(refusal("resolution_bits", 27), "plan: scanner.resolution_bits must be 8 to 26");
  EXPECT_EQ(refusal("lag_us", -1), "plan: scanner.lag_us must be 0 or more");
  EXPECT_EQ(refusal("offset_deg", 86), "plan: scanner.offset_deg must be -85 to 85, 0 in flat mode");
  EXPECT_EQ(refusal("tilt_deg_per_mm", -1), "plan: scanner.tilt_deg_per_mm must be 0 or more");
  EXPECT_EQ(refusal("max_jerk_mm_s3", 0), "plan: scanner.max_jerk_mm_s3 = 0: must be greater than 0");
  EXPECT_EQ(refusal("field_grid", std::string(kMostPlanGridBytes + 1, '1')),
            "plan: scanner.field_grid has more than 524288 bytes");
  EXPECT_EQ(refusal("max_speed_mm_s", "fast").rfind("plan: scanner.", 0), 0U);
}

TEST(PlanJson, RefusesCarriagesAndBandsThatContradictThePlan) {
  Job job = roller_job();
  job.mode = Mode::helical;
  job.rotary.interpolation_bits = 7;
  job.carriage = {64, 8, 20, 8, 2'000'000, {}};
  const ordered_json helical = ordered_json::parse(plan_to_json(planned(job, 15'000, 8)));
  job.mode = Mode::rotary;
  job.scanner.field_mm = 30;
  const ordered_json bands = ordered_json::parse(plan_to_json(planned(job, 5000, 2)));
  const auto refused = [](ordered_json json, const std::function<void(ordered_json&)>& change,
                          const std::string& part) {
    change(json);
    const Result<Plan> plan = plan_from_json(json.dump());
    ASSERT_FALSE(plan) << part;
    EXPECT_EQ(plan.error().code, ErrorCode::bad_file);
    EXPECT_NE(plan.error().message.find(part), std::string::npos) << plan.error().message;
  };
  refused(
      helical, [](auto& j) { j.erase("carriage"); }, "carriage must be there in helical mode");
  refused(
      bands, [&](auto& j) { j["carriage"] = helical["carriage"]; }, "carriage must be there in helical mode");
  refused(
      helical, [&](auto& j) { j["bands"] = bands["bands"]; }, "bands are none in helical mode");
  refused(
      helical, [](auto& j) { j["carriage"]["layers"] = 7; }, "carriage.window_columns = 512");
  refused(
      helical, [](auto& j) { j["carriage"]["layers"] = 0; }, "carriage.layers = 0: must be at least 1");
  refused(
      helical, [](auto& j) { j["carriage"]["columns"] = 0; }, "carriage.columns = 0: must be at least 1");
  refused(
      helical, [](auto& j) { j["carriage"]["revolutions"] = 242; }, "carriage.revolutions = 242");
  refused(
      helical, [](auto& j) { j["carriage"]["ab"]["increment"] = 1; }, "carriage.ab.output_hz");
  refused(
      helical, [](auto& j) { j["carriage"]["ab"]["prescaler"] = 0; }, "carriage.ab.prescaler = 0");
  refused(
      helical, [](auto& j) { j["carriage"]["interpolation_bits"] = 64; }, "carriage.interpolation_bits");
  refused(
      bands, [](auto& j) { j["bands"]["count"] = 3; }, "bands.count = 3");
  refused(
      bands, [](auto& j) { j["bands"]["revolutions_per_band"] = 3; }, "job.revolutions = 4");
  refused(
      bands, [](auto& j) { j["bands"]["columns"] = 5; }, "bands.columns fit one band");
}

// --- refusals ---

struct Damage {
  std::string name;
  std::function<void(ordered_json&)> change;
  std::string part;
};

void PrintTo(const Damage& damage, std::ostream* out) {
  *out << damage.name;
}

const Damage kDamages[] = {
    {"TextForANumber", [](ordered_json& j) { j["clock"]["seed_hz"] = "fast"; }, "clock.seed_hz must be a whole number"},
    {"FractionForAWholeNumber", [](ordered_json& j) { j["line"]["slots"] = 3909.5; }, "line.slots must be a whole"},
    {"OctalDigits", [](ordered_json& j) { j["line"]["slots"] = "03909"; }, "line.slots must be a whole number"},
    {"EmptyDigits", [](ordered_json& j) { j["line"]["slots"] = "-"; }, "line.slots must be a whole number"},
    {"TooManyDigits", [](ordered_json& j) { j["ab"]["ratios"]["wanted_hz"]["num"] = std::string(5000, '9'); },
     "ab.ratios.wanted_hz must be a whole number"},
    {"Beyond64Bits", [](ordered_json& j) { j["job"]["ticks"] = "9223372036854775808"; },
     "job.ticks = 9223372036854775808 is beyond 64-bit integers"},
    {"NegativeIncrement", [](ordered_json& j) { j["ab"]["increment"] = -1; },
     "ab.increment = -1 must be 0 to 2^64 - 1"},
    {"NegativeBits", [](ordered_json& j) { j["ab"]["counter_bits"] = -1; }, "ab.counter_bits = -1 is out of range"},
    {"NumberForATruth", [](ordered_json& j) { j["ab"]["exact"] = 1; }, "ab.exact must be true or false"},
    {"NumberForAText", [](ordered_json& j) { j["title"] = 1; }, "title must be a string"},
    {"UnknownMode", [](ordered_json& j) { j["mode"] = "spiral"; }, "mode = \"spiral\" is none of the known modes"},
    {"TextForAList", [](ordered_json& j) { j["warnings"] = "x"; }, "warnings must be a list of strings"},
    {"NumberInAListOfTexts", [](ordered_json& j) { j["warnings"] = {1}; }, "warnings must be a list of strings"},
    {"NumberForASection", [](ordered_json& j) { j["clock"] = 1; }, "clock must be an object"},
    {"NumberForARatio", [](ordered_json& j) { j["clock"]["ratios"]["pulse_hz"] = 1; },
     R"(clock.ratios.pulse_hz must be {"num": .., "den": ..})"},
    {"DenominatorOfZero", [](ordered_json& j) { j["clock"]["ratios"]["pulse_hz"]["den"] = 0; },
     "clock.ratios.pulse_hz has den = 0"},
    {"TextForAPlainRatio", [](ordered_json& j) { j["line"]["rate_hz"] = "x"; }, "line.rate_hz must be a number"},
    {"PlainAndExactDisagree", [](ordered_json& j) { j["line"]["rate_hz"] = 511.7; },
     "line.rate_hz = 511.7 is not ratios.rate_hz = 2000000/3909"},
    {"SeedOfZero", [](ordered_json& j) { j["clock"]["seed_hz"] = 0; }, "clock.seed_hz = 0: must be at least 1"},
    {"NoLines", [](ordered_json& j) { j["rotary"]["lines_per_revolution"] = 0; },
     "rotary.lines_per_revolution = 0: must be at least 1"},
    {"OddClock", [](ordered_json& j) { j["clock"]["fpga_hz"] = 164'000'001; }, "clock.fpga_hz is not a multiple"},
    {"OtherDivider", [](ordered_json& j) { j["clock"]["pulse_divider"] = 40; }, "clock.pulse_hz = 2000000"},
    {"OtherSlots", [](ordered_json& j) { j["line"]["slots"] = 3910; }, "line.offset_slots = -3"},
    {"OtherTicks", [](ordered_json& j) { j["line"]["ticks"] = 320'539; }, "line.ticks = 320539: the rest of the plan"},
    {"WindowOutOfTheLine", [](ordered_json& j) { j["line"]["marking_first_slot"]["reverse"] = 410; },
     "line.marking_first_slot.reverse puts the marking window out"},
    {"RemainderOfASlot", [](ordered_json& j) { j["line"]["offset_remainder_ticks"] = 82; },
     "line.offset_remainder_ticks must be less than a slot"},
    {"OtherEncoder", [](ordered_json& j) { j["rotary"]["encoder_lines"] = 11'841; }, "rotary.edges_per_revolution"},
    {"HugeInterpolation", [](ordered_json& j) { j["rotary"]["interpolation_bits"] = 2'000'000'000; },
     "rotary.interpolation_bits must be 0 to 63"},
    {"OtherRevolutions", [](ordered_json& j) { j["job"]["revolutions"] = 101; }, "job.ticks"},
    {"WrongIncrement", [](ordered_json& j) { j["ab"]["increment"] = 141'835'290; }, "ab.output_hz"},
    {"WrongPrescaler", [](ordered_json& j) { j["ab"]["prescaler"] = 4; }, "ab.output_hz"},
    {"IncrementThatSkipsEdges", [](ordered_json& j) { j["ab"]["increment"] = (1 << 30) + 1; },
     "ab.increment lets A and B change together"},
    {"NoIncrement", [](ordered_json& j) { j["ab"]["increment"] = 0; }, "ab.increment = 0: the axis would stand still"},
    {"FractionOfOne", [](ordered_json& j) { j["ab"]["fraction"]["num"] = 1; }, "ab.fraction.num must be less than"},
    {"SixtyFiveBits", [](ordered_json& j) { j["ab"]["counter_bits"] = 65; }, "ab.counter_bits must be 2 to 64"},
    {"OverTheFrequencyLimit", [](ordered_json& j) { j["ab"]["max_output_hz"] = 1'000'000; }, "ab.output_hz is above"},
    {"ClaimedExact", [](ordered_json& j) { j["ab"]["exact"] = true; }, "ab.exact does not follow"},
    {"ClaimedDrift", [](ordered_json& j) { j["ab"]["drift_lines_per_revolution"]["num"] = 0; },
     "ab.drift_lines_per_revolution = 0: the rest of the plan gives"},
    {"ClaimedNever", [](ordered_json& j) { j["ab"]["lines_until_limit"] = nullptr; },
     "ab.lines_until_limit is null, but the limit is reached"},
    {"ClaimedLines", [](ordered_json& j) { j["ab"]["lines_until_limit"] = 1; }, "ab.lines_until_limit = 1: the rest"},
    {"ClaimedBound", [](ordered_json& j) { j["ab"]["bound_lines_until_limit"] = 1; }, "ab.bound_lines_until_limit = 1"},
};

class PlanJsonDamage : public testing::TestWithParam<Damage> {};

TEST_P(PlanJsonDamage, IsRefusedNamingTheKey) {
  ordered_json json = roller_json();
  GetParam().change(json);
  const Result<Plan> plan = plan_from_json(json.dump());
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().code, ErrorCode::bad_file);
  EXPECT_NE(plan.error().message.find("plan: " + GetParam().part), std::string::npos) << plan.error().message;
}

INSTANTIATE_TEST_SUITE_P(EachKind, PlanJsonDamage, testing::ValuesIn(kDamages),
                         [](const auto& damage) { return damage.param.name; });

/// Every key but the readable title and warnings is needed: without it, or with null for it, the plan is refused.
void expect_needed(const ordered_json& root, const nlohmann::json::json_pointer& at, const ordered_json& object) {
  for (const auto& [key, value] : object.items()) {
    ordered_json without = root;
    without[ordered_json::json_pointer(at.to_string())].erase(key);
    const Result<Plan> plan = plan_from_json(without.dump());
    ASSERT_FALSE(plan) << at.to_string() << "/" << key;
    EXPECT_EQ(plan.error().code, ErrorCode::bad_file);
    EXPECT_NE(plan.error().message.find(key), std::string::npos) << plan.error().message;
    ordered_json nothing = root;
    nothing[ordered_json::json_pointer(at.to_string())][key] = nullptr;
    EXPECT_FALSE(plan_from_json(nothing.dump())) << at.to_string() << "/" << key;
    if (value.is_object()) {
      expect_needed(root, at / key, value);
    }
  }
}

TEST(PlanJson, RefusesAPlanWithoutOneOfItsKeys) {
  const ordered_json json = roller_json();
  expect_needed(json, nlohmann::json::json_pointer(), json);
}

TEST(PlanJson, RefusesWhatIsNoJsonObject) {
  const std::string whole = plan_to_json(roller_plan());
  for (const std::string& text : {std::string(), std::string("[]"), std::string("null"), std::string("{"),
                                  whole.substr(0, whole.size() / 2), std::string(100'000, '[')}) {
    const Result<Plan> plan = plan_from_json(text);
    ASSERT_FALSE(plan);
    EXPECT_EQ(plan.error().code, ErrorCode::bad_file);
    EXPECT_NE(plan.error().message.find("is not a JSON object"), std::string::npos);
  }
  const Result<Plan> large = plan_from_json(std::string(kLargestPlanJson + 1, ' '));
  ASSERT_FALSE(large);
  EXPECT_NE(large.error().message.find("at most 1048576"), std::string::npos);
}

TEST(PlanJson, NeverThrowsOnChangedBytes) {
  SCOPED_TRACE(seed_note());
  Random random;
  const std::string whole = plan_to_json(roller_plan());
  for (int trial = 0; trial < 3000; ++trial) {
    std::string text = whole;
    for (std::uint64_t change = random.between(1, 4); change > 0; --change) {
      text[random.between(0, text.size() - 1)] = static_cast<char>(random.between(0, 255));
    }
    const Result<Plan> plan = plan_from_json(text);
    if (!plan) {
      EXPECT_EQ(plan.error().code, ErrorCode::bad_file);
    }
  }
}

TEST(PlanJson, ReplacesBytesThatAreNotUtf8) {
  Plan plan = roller_plan();
  plan.title = "\xFF";
  EXPECT_NE(plan_to_json(plan).find("\xEF\xBF\xBD"), std::string::npos);
}

}  // namespace
}  // namespace gravure
