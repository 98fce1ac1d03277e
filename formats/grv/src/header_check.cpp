#include "header_check.hpp"

#include <numeric>

#include "set_point_table.hpp"

namespace gravure::grv {
namespace {

std::string allowed(std::int64_t value, const std::string& range) {
  return " = " + std::to_string(value) + ": must be " + range;
}

Result<void> check_equal(const char* field, std::int64_t value, std::int64_t expected, const char* because,
                         ErrorCode code) {
  if (value != expected) {
    return Error{code, field + allowed(value, std::to_string(expected) + ", " + because)};
  }
  return {};
}

Result<void> check_index(const std::string& field, std::int64_t value, std::int64_t count, ErrorCode code) {
  if (value < 0 || value >= count) {
    return Error{code, field + allowed(value, "0 to " + std::to_string(count - 1))};
  }
  return {};
}

/// The revolutions whose layers the header tells.
Result<Shard> revolutions_of(const ProgramHeader& header, ErrorCode code) {
  const Shard range = header.shard.value_or(Shard{0, header.plan.job.revolutions, 1});
  if (range.image_layers < 1) {
    return Error{code, "layers of the image stack" + allowed(range.image_layers, "at least 1")};
  }
  if (range.first < 0 || range.end <= range.first || range.end > header.plan.job.revolutions) {
    return Error{code, "shard of revolutions " + std::to_string(range.first) + " to " + std::to_string(range.end) +
                           " (exclusive): must lie within 0 to " + std::to_string(header.plan.job.revolutions)};
  }
  return range;
}

/// Layers that share bits: numbered as they are first used, and alike in what the bits decide.
Result<void> check_shared_bits(const ProgramHeader& header, std::int64_t stored, ErrorCode code) {
  if (header.bits_of_layer.empty()) {
    return check_equal("layers in the header", static_cast<std::int64_t>(header.layers.size()), stored,
                       "the number of layers stored", code);
  }
  GRAVURE_CHECK(check_equal("layers in the header", static_cast<std::int64_t>(header.layers.size()),
                            static_cast<std::int64_t>(header.bits_of_layer.size()), "the rows of bits_of_layer", code));
  std::vector<std::size_t> first_user;
  for (std::size_t layer = 0; layer < header.layers.size(); ++layer) {
    const std::size_t bits = header.bits_of_layer[layer];
    if (bits > first_user.size()) {
      return Error{code, "bits_of_layer " + std::to_string(layer) + " = " + std::to_string(bits) +
                             ": must be at most " + std::to_string(first_user.size()) + ", the next one"};
    }
    if (bits == first_user.size()) {
      first_user.push_back(layer);
    } else if (header.layers[first_user[bits]].starts_reverse != header.layers[layer].starts_reverse) {
      return Error{code, "layer " + std::to_string(layer) + ": its bits are those of layer " +
                             std::to_string(first_user[bits]) + ", which starts the other way"};
    }
  }
  return check_equal("bits that layers use", static_cast<std::int64_t>(first_user.size()), stored,
                     "the number of layers stored", code);
}

Result<void> check_layer(const ProgramHeader& header, std::size_t number, std::int64_t fired, ErrorCode code) {
  const StoredLayer& layer = header.layers[number];
  const std::string name = "layer " + std::to_string(number) + ": ";
  if (layer.starts_reverse && !header.plan.line.bidirectional) {
    return Error{code, name + "starts right to left, but the plan has lines in one direction only"};
  }
  // A program may come without sources (a test pattern); then there is nothing to point at.
  if (!header.sources.empty()) {
    GRAVURE_CHECK(check_index(name + "source", layer.source, static_cast<std::int64_t>(header.sources.size()), code));
  }
  if (layer.fired_pixels != fired) {
    return Error{
        code, name + "fired_pixels" + allowed(layer.fired_pixels, std::to_string(fired) + ", the sum over its chunks")};
  }
  return {};
}

}  // namespace

Result<void> check_header(const ProgramHeader& header, const Layout& layout,
                          std::span<const std::int64_t> fired_of_chunks, ErrorCode code) {
  GRAVURE_CHECK(check_equal("lines per layer", layout.lines_per_layer, header.plan.rotary.lines_per_revolution,
                            "the plan's lines per revolution", code));
  GRAVURE_CHECK(check_equal("bytes per line", layout.line_bytes, header.line_bytes(), "for the plan's pixels", code));
  GRAVURE_CHECK(check_shared_bits(header, layout.layers, code));
  GRAVURE_TRY(const Shard range, revolutions_of(header, code));
  GRAVURE_CHECK(check_equal("revolutions in the table", static_cast<std::int64_t>(header.layer_of_revolution.size()),
                            range.end - range.first,
                            header.shard ? "the shard's revolutions" : "the plan's revolutions", code));
  const auto layers = static_cast<std::int64_t>(header.layers.size());
  for (std::size_t r = 0; r < header.layer_of_revolution.size(); ++r) {
    GRAVURE_CHECK(check_index("layer of revolution " + std::to_string(r), header.layer_of_revolution[r], layers, code));
  }
  GRAVURE_CHECK(check_set_points(header.set_points, header.plan, code));
  const auto chunks = static_cast<std::size_t>(layout.chunks_per_layer());
  for (std::size_t i = 0; i < header.layers.size(); ++i) {
    const std::size_t bits = header.bits_of_layer.empty() ? i : header.bits_of_layer[i];
    const auto of_layer = fired_of_chunks.subspan(bits * chunks, chunks);
    GRAVURE_CHECK(check_layer(header, i, std::accumulate(of_layer.begin(), of_layer.end(), std::int64_t{0}), code));
  }
  return {};
}

std::vector<PlanNumber> plan_numbers(const Plan& plan) {
  std::vector<PlanNumber> numbers = {
      {"seed_hz", plan.clock.seed_hz, "Hz"},
      {"fpga_hz", plan.clock.fpga_hz, "Hz"},
      {"pulse_divider", plan.clock.pulse_divider, "seed pulses per pulse slot"},
      {"ticks_per_slot", plan.clock.ticks_per_slot, "FPGA ticks per pulse slot"},
      {"pixels_per_line", plan.line.pixels, "pulse slots in the marking window"},
      {"slots_per_line", plan.line.slots, "pulse slots, run-in and run-out included"},
      {"ticks_per_line", plan.line.ticks, "FPGA ticks"},
      {"forward_first_slot", plan.line.forward_first_slot, "pulse slots"},
      {"reverse_first_slot", plan.line.reverse_first_slot, "pulse slots"},
      {"offset_slots", plan.line.offset_slots, "pulse slots"},
      {"offset_remainder_ticks", plan.line.offset_remainder_ticks, "FPGA ticks"},
      {"bidirectional", std::int64_t{plan.line.bidirectional}, "1 yes, 0 no"},
      {"lines_per_revolution", plan.rotary.lines_per_revolution, "lines"},
      {"ticks_per_revolution", plan.rotary.ticks_per_revolution, "FPGA ticks"},
      {"counter_bits", std::int64_t{plan.ab.counter_bits}, "bits"},
      {"prescaler", plan.ab.prescaler, "FPGA ticks per addition"},
      {"increment", plan.ab.increment, "counts per addition"},
      {"fraction_num", plan.ab.fraction_num, "counts / fraction_den per addition"},
      {"fraction_den", plan.ab.fraction_den, "1"},
      {"revolutions", plan.job.revolutions, "revolutions"},
      {"job_ticks", plan.job.ticks, "FPGA ticks"},
  };
  if (plan.carriage) {
    const CarriagePlan& carriage = *plan.carriage;
    numbers.insert(numbers.end(),
                   {{"columns", carriage.columns, "columns of the images"},
                    {"layers_per_line", carriage.layers, "layers exposed by a line"},
                    {"carriage_prescaler", carriage.ab.prescaler, "FPGA ticks per addition"},
                    {"carriage_increment", carriage.ab.increment, "counts per addition"},
                    {"carriage_fraction_num", carriage.ab.fraction_num, "counts / carriage_fraction_den per addition"},
                    {"carriage_fraction_den", carriage.ab.fraction_den, "1"}});
  }
  if (plan.bands) {
    numbers.insert(numbers.end(), {{"columns", plan.bands->columns, "columns of the images"},
                                   {"bands", plan.bands->count, "bands"},
                                   {"revolutions_per_band", plan.bands->revolutions_per_band, "revolutions"}});
  }
  return numbers;
}

}  // namespace gravure::grv
