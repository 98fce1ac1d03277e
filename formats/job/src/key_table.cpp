#include "src/key_table.hpp"

#include <algorithm>
#include <array>

namespace gravure::job_file {
namespace {

using Store = void (*)(Job&, const Value&);

constexpr std::array<std::string_view, 9> kSections = {"job",      "laser", "fpga",  "scanner", "rotary",
                                                       "carriage", "stage", "image", "limits"};
constexpr std::array<std::string_view, 3> kModes = {"rotary", "helical", "flat"};  // as Mode counts them
constexpr std::array<std::string_view, 2> kLaterModes = {"freeform", "zones"};
constexpr std::array<std::string_view, 2> kFires = {"white", "black"};
constexpr std::array<std::string_view, 2> kLinesAlong = {"rows", "columns"};
constexpr std::array<std::string_view, 3> kOrders = {"sequence", "cycle", "hold"};

constexpr std::string_view kRequired = "required";

constexpr Presence presence_of(std::string_view fallback) {
  return fallback == kRequired ? Presence::required : Presence::optional;
}

constexpr KeySpec integer(std::string_view section, std::string_view key, std::string_view unit, std::string_view low,
                          std::string_view high, std::string_view fallback, Store store) {
  return {section, key, Type::integer, unit, low, high, {}, presence_of(fallback), fallback, store};
}

constexpr KeySpec decimal(std::string_view section, std::string_view key, std::string_view unit, std::string_view low,
                          std::string_view high, std::string_view fallback, Store store) {
  return {section, key, Type::decimal, unit, low, high, {}, presence_of(fallback), fallback, store};
}

constexpr KeySpec word(std::string_view section, std::string_view key, std::span<const std::string_view> words,
                       std::string_view fallback, Store store) {
  return {section, key, Type::word, "", "", "", words, presence_of(fallback), fallback, store};
}

constexpr KeySpec other(std::string_view section, std::string_view key, Type type, std::string_view fallback,
                        Store store) {
  return {section, key, type, "", "", "", {}, presence_of(fallback), fallback, store};
}

/// The same key, present or not as other keys decide.
constexpr KeySpec decided(KeySpec spec) {
  spec.presence = Presence::decided;
  return spec;
}

template <class Enum>
Enum enum_of(std::span<const std::string_view> words, const Value& value) {
  return static_cast<Enum>(std::find(words.begin(), words.end(), value.text) - words.begin());
}

constexpr std::string_view kOneOfSizes = "one of diameter_mm, circumference_mm";
constexpr std::string_view kOneOfPitches = "one of line_pitch_um, lines_per_revolution";
constexpr std::string_view kOneOfImages = "one of files, depth_map";
constexpr std::string_view kBiggestHz = "10_000_000_000";

// Bounds keep every figure physical and every tick count far inside 64 bits where they are multiplied one by one;
// make_plan() checks the products.
constexpr std::array kTable = {
    other("job", "title", Type::title, "\"\"", [](Job& j, const Value& v) { j.title = v.text; }),
    word("job", "mode", kModes, kRequired, [](Job& j, const Value& v) { j.mode = enum_of<Mode>(kModes, v); }),

    integer("laser", "seed_hz", "Hz", "1", kBiggestHz, kRequired,
            [](Job& j, const Value& v) { j.laser.seed_hz = v.integer; }),
    integer("laser", "pulse_divider", "seed pulses", "1", "1_000_000", kRequired,
            [](Job& j, const Value& v) { j.laser.pulse_divider = v.integer; }),
    integer("laser", "max_pulse_on_demand_hz", "Hz", "1", kBiggestHz, kRequired,
            [](Job& j, const Value& v) { j.laser.max_pulse_on_demand_hz = v.integer; }),

    integer("fpga", "clock_multiplier", "FPGA ticks per seed pulse", "1", "1_000", kRequired,
            [](Job& j, const Value& v) { j.fpga.clock_multiplier = v.integer; }),
    integer("fpga", "counter_bits", "bits", "8", "64", kRequired,
            [](Job& j, const Value& v) { j.fpga.counter_bits = static_cast<int>(v.integer); }),
    other("fpga", "fractional", Type::boolean, "false", [](Job& j, const Value& v) { j.fpga.fractional = v.boolean; }),
    integer("fpga", "max_prescaler", "FPGA ticks", "1", "9_223_372_036_854_775_807", "4_294_967_295",
            [](Job& j, const Value& v) { j.fpga.max_prescaler = static_cast<std::uint64_t>(v.integer); }),

    decimal("scanner", "pixel_pitch_um", "um", "0.001", "10_000", kRequired,
            [](Job& j, const Value& v) { j.scanner.pixel_pitch_um = v.number; }),
    integer("scanner", "slots_per_microvector", "pulse slots", "1", "1_000_000", "1",
            [](Job& j, const Value& v) { j.scanner.slots_per_microvector = v.integer; }),
    integer("scanner", "turn_slots", "pulse slots", "0", "10_000_000", kRequired,
            [](Job& j, const Value& v) { j.scanner.turn_slots = v.integer; }),
    integer("scanner", "max_extra_slots", "pulse slots", "0", "100_000", "0",
            [](Job& j, const Value& v) { j.scanner.max_extra_slots = v.integer; }),
    other("scanner", "bidirectional", Type::boolean, "true",
          [](Job& j, const Value& v) { j.scanner.bidirectional = v.boolean; }),
    integer("scanner", "bidirectional_offset_ticks", "FPGA ticks", "-1_000_000_000", "1_000_000_000", "0",
            [](Job& j, const Value& v) { j.scanner.bidirectional_offset_ticks = v.integer; }),
    decimal("scanner", "field_mm", "mm", "0.001", "10_000", "none: the image fits",
            [](Job& j, const Value& v) { j.scanner.field_mm = v.number; }),

    decided(decimal("rotary", "diameter_mm", "mm", "0.01", "10_000", kOneOfSizes,
                    [](Job& j, const Value& v) { j.rotary.diameter_mm = v.number; })),
    decided(decimal("rotary", "circumference_mm", "mm", "0.03", "32_000", kOneOfSizes,
                    [](Job& j, const Value& v) { j.rotary.circumference_mm = v.number; })),
    decided(decimal("rotary", "line_pitch_um", "um", "0.001", "10_000", kOneOfPitches,
                    [](Job& j, const Value& v) { j.rotary.line_pitch_um = v.number; })),
    decided(integer("rotary", "lines_per_revolution", "lines", "1", "1_000_000_000", kOneOfPitches,
                    [](Job& j, const Value& v) { j.rotary.lines_per_revolution = v.integer; })),
    integer("rotary", "encoder_lines", "lines per encoder turn", "1", "1_000_000_000", kRequired,
            [](Job& j, const Value& v) { j.rotary.encoder_lines = v.integer; }),
    integer("rotary", "interpolation_bits", "bits", "0", "32", kRequired,
            [](Job& j, const Value& v) { j.rotary.interpolation_bits = static_cast<int>(v.integer); }),
    KeySpec{"rotary",
            "gear",
            Type::two_integers,
            "turns",
            "1",
            "1_000_000",
            {},
            Presence::optional,
            "[1, 1]",
            [](Job& j, const Value& v) {
              j.rotary.gear_encoder_turns = v.items[0].integer;
              j.rotary.gear_workpiece_turns = v.items[1].integer;
            }},
    integer("rotary", "max_ab_hz", "Hz", "1", kBiggestHz, kRequired,
            [](Job& j, const Value& v) { j.rotary.max_ab_hz = v.integer; }),

    decimal("carriage", "feed_pixels", "columns per turn", "0.001", "1_000_000", kRequired,
            [](Job& j, const Value& v) { j.carriage.feed_pixels = v.number; }),
    integer("carriage", "layers", "layers", "1", "65_536", kRequired,
            [](Job& j, const Value& v) { j.carriage.layers = v.integer; }),
    decimal("carriage", "encoder_pitch_um", "um", "0.001", "1_000_000", kRequired,
            [](Job& j, const Value& v) { j.carriage.encoder_pitch_um = v.number; }),
    integer("carriage", "interpolation_bits", "bits", "0", "32", kRequired,
            [](Job& j, const Value& v) { j.carriage.interpolation_bits = static_cast<int>(v.integer); }),
    integer("carriage", "max_ab_hz", "Hz", "1", kBiggestHz, kRequired,
            [](Job& j, const Value& v) { j.carriage.max_ab_hz = v.integer; }),

    integer("stage", "lines", "lines", "1", "1_000_000_000", kRequired,
            [](Job& j, const Value& v) { j.stage.lines = v.integer; }),
    decimal("stage", "line_pitch_um", "um", "0.001", "10_000", kRequired,
            [](Job& j, const Value& v) { j.stage.line_pitch_um = v.number; }),
    decimal("stage", "encoder_pitch_um", "um", "0.001", "1_000_000", kRequired,
            [](Job& j, const Value& v) { j.stage.encoder_pitch_um = v.number; }),
    integer("stage", "interpolation_bits", "bits", "0", "32", kRequired,
            [](Job& j, const Value& v) { j.stage.interpolation_bits = static_cast<int>(v.integer); }),
    integer("stage", "max_ab_hz", "Hz", "1", kBiggestHz, kRequired,
            [](Job& j, const Value& v) { j.stage.max_ab_hz = v.integer; }),

    decided(other("image", "files", Type::paths, kOneOfImages,
                  [](Job& j, const Value& v) {
                    for (const Value& item : v.items) {
                      j.image.files.push_back(item.text);
                    }
                  })),
    decided(other("image", "depth_map", Type::path, kOneOfImages,
                  [](Job& j, const Value& v) { j.image.depth_map = v.text; })),
    decided(integer("image", "levels", "layers", "1", "65_536", "required with depth_map",
                    [](Job& j, const Value& v) { j.image.levels = v.integer; })),
    decimal("image", "depth_min", "", "-1_000_000_000_000", "1_000_000_000_000", "0",
            [](Job& j, const Value& v) { j.image.depth_min = v.number; }),
    decimal("image", "depth_max", "", "-1_000_000_000_000", "1_000_000_000_000", "1, or the largest integer sample",
            [](Job& j, const Value& v) { j.image.depth_max = v.number; }),
    integer("image", "threshold", "", "1", "65_535", "none: layers are bilevel",
            [](Job& j, const Value& v) { j.image.threshold = v.integer; }),
    word("image", "fires", kFires, kRequired,
         [](Job& j, const Value& v) { j.image.fires = enum_of<Fires>(kFires, v); }),
    word("image", "lines_along", kLinesAlong, "\"rows\"",
         [](Job& j, const Value& v) { j.image.lines_along = enum_of<LinesAlong>(kLinesAlong, v); }),
    integer("image", "revolutions", "turns", "1", "1_000_000", "one per layer",
            [](Job& j, const Value& v) { j.image.revolutions = v.integer; }),
    word("image", "order", kOrders, "\"sequence\"",
         [](Job& j, const Value& v) { j.image.order = enum_of<LayerOrder>(kOrders, v); }),
    decided(integer("image", "pixels_per_line", "pixels", "1", "1_000_000_000", "from the images",
                    [](Job& j, const Value& v) { j.image.pixels_per_line = v.integer; })),

    decimal("limits", "seam_um", "um", "0.000_001", "1_000_000", kRequired,
            [](Job& j, const Value& v) { j.limits.seam_um = v.number; }),
};

std::string either(std::span<const std::string_view> words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    text += i == 0 ? "" : i + 1 == words.size() ? " or " : ", ";
    text += "\"" + std::string(words[i]) + "\"";
  }
  return text;
}

std::string with_unit(const std::string& text, std::string_view unit) {
  return unit.empty() ? text : text + " " + std::string(unit);
}

}  // namespace

std::span<const KeySpec> key_table() {
  return kTable;
}

std::span<const std::string_view> section_names() {
  return kSections;
}

std::span<const std::string_view> later_modes() {
  return kLaterModes;
}

std::optional<Mode> mode_of(std::string_view word) {
  const auto found = std::find(kModes.begin(), kModes.end(), word);
  return found == kModes.end() ? std::nullopt : std::optional(static_cast<Mode>(found - kModes.begin()));
}

bool section_is_of(std::string_view section, Mode mode) {
  if (section == "carriage") {
    return mode == Mode::helical;
  }
  return section == "stage" ? mode == Mode::flat : section != "rotary" || mode != Mode::flat;
}

const KeySpec* find_key(std::string_view section, std::string_view key) {
  const auto found = std::find_if(kTable.begin(), kTable.end(),
                                  [&](const KeySpec& spec) { return spec.section == section && spec.key == key; });
  return found == kTable.end() ? nullptr : &*found;
}

std::string range_text(const KeySpec& spec) {
  switch (spec.type) {
    case Type::boolean:
      return "true or false";
    case Type::integer:
    case Type::decimal:
    case Type::two_integers:
      return std::string(spec.low) + " to " + std::string(spec.high);
    case Type::title:
      return "at most " + std::to_string(kMaxTitleBytes) + " bytes, no control characters";
    case Type::path:
    case Type::paths:
      return "1 to " + std::to_string(kMaxPathBytes) + " bytes, no control characters";
    case Type::word:
      return either(spec.words);
  }
  return "";
}

std::string expectation(const KeySpec& spec) {
  switch (spec.type) {
    case Type::boolean:
    case Type::word:
      return range_text(spec);
    case Type::integer:
      return with_unit("an integer from " + range_text(spec), spec.unit);
    case Type::decimal:
      return with_unit("a number from " + range_text(spec), spec.unit);
    case Type::two_integers:
      return "[encoder turns, workpiece turns], two integers from " + range_text(spec);
    case Type::title:
    case Type::path:
      return "a string of " + range_text(spec);
    case Type::paths:
      return "a list of one or more file patterns such as [\"layers/*.tif\"], each " + range_text(spec);
  }
  return "";
}

}  // namespace gravure::job_file
