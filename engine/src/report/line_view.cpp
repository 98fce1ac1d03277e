#include "gravure/report/line_view.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <string_view>

#include "gravure/core/as_size.hpp"
#include "gravure/core/board_runs.hpp"
#include "gravure/core/path_motion.hpp"
#include "gravure/core/spin_phase.hpp"
#include "gravure/scan/job_trajectory.hpp"
#include "gravure/twin/exposure.hpp"

namespace gravure::report {
namespace {

bool bit(std::span<const std::byte> bits, std::int64_t at) {
  return ((static_cast<unsigned>(bits[as_size(at / 8)]) >> (7 - at % 8)) & 1U) != 0;
}

/// The bits of one line in time order; valid until `chunk` loads another.
Result<std::span<const std::byte>> bits_of_line(LineSource& program, ProgramChunk& chunk, std::int64_t revolution,
                                                std::int64_t line) {
  const ProgramHeader& header = program.header();
  GRAVURE_CHECK(
      chunk.load(program, {header.layer_of_revolution[as_size(revolution)], line / program.lines_per_chunk()}));
  const std::size_t bytes = as_size(header.line_bytes());
  return chunk.lines_for(header, revolution).subspan(as_size(line - chunk.first_line()) * bytes, bytes);
}

void add_gate(std::span<const std::byte> bits, std::int64_t pixels, LineView& view) {
  for (std::int64_t pixel = 0; pixel < pixels; ++pixel) {
    if (!bit(bits, pixel)) {
      continue;
    }
    ++view.fired;
    const std::int64_t slot = view.first_slot + pixel;
    if (!view.gate.empty() && view.gate.back().first_slot + view.gate.back().slots == slot) {
      ++view.gate.back().slots;
    } else if (view.gate.size() < kMostGateRuns) {
      view.gate.push_back({slot, 1});
    } else {
      view.gate_cut = true;
    }
  }
}

void add_edges(const Plan& plan, LineView& view) {
  const BoardRun run = run_with(plan, view.revolution);
  const std::int64_t begin =
      (view.revolution - run.first_revolution) * plan.rotary.ticks_per_revolution + view.line * plan.line.ticks;
  EdgesIn edges = edges_in(plan.ab, plan.spin, begin, begin + plan.line.ticks, kMostEdges);
  view.backward = run.backward;
  // Gray code of the count; a run that steps backwards begins at 00, too, and counts down.
  const Integer spun_up = plan.spin ? spin_edges(plan.ab, plan.spin->up) : Integer(0);
  const int quarter = static_cast<int>(Integer((edges.before + spun_up) % 4));
  const int phase = run.backward ? (4 - quarter) % 4 : quarter;
  view.ab_state_at_start = phase ^ (phase >> 1);
  view.edges_cut = edges.cut;
  view.edge_ticks = std::move(edges.ticks);
  for (std::int64_t& tick : view.edge_ticks) {
    tick -= begin;
  }
}

void add_mirrors(const Plan& plan, LineView& view) {
  if (!plan.scanner) {
    view.no_mirrors = "the job does not describe the scanner: give scanner.field_mm, or a machine file";
    return;
  }
  const Result<scan::JobTrajectory> trajectory = scan::JobTrajectory::make(plan);
  if (!trajectory) {
    view.no_mirrors = trajectory.error().message;
    return;
  }
  const scan::LandingModel model = scan::landing_model(trajectory.value().of_revolution(view.revolution));
  const std::int64_t samples = std::min(plan.line.slots, kMostMirrorSamples);
  for (std::int64_t i = 0; i < samples; ++i) {
    const std::int64_t slot = samples == 1 ? 0 : i * (plan.line.slots - 1) / (samples - 1);
    const Result<scan::SlotState> state = trajectory.value().at({view.revolution, view.line}, slot, model);
    if (!state) {
      view.no_mirrors = state.error().message;
      view.mirrors.clear();
      return;
    }
    view.mirrors.push_back({slot, state.value().mirrors.u_mm, state.value().mirrors.v_mm});
  }
}

/// The galvo of a path program: ordered at the begin and at the end of a servo period.
Result<void> add_set_points(LineSource& program, LineView& view) {
  const Plan& plan = program.header().plan;
  std::array<PathSetPoint, 2> points;
  GRAVURE_CHECK(program.read_set_points(view.line, points));
  const auto at_mm = [&](const PathSetPoint& point, std::string_view name) {
    const auto axis = static_cast<std::size_t>(std::find(kPathAxes.begin(), kPathAxes.end(), name) - kPathAxes.begin());
    return static_cast<double>(point.counts[axis]) / to_double(plan.path->axes[axis].counts_per_unit);
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    view.mirrors.push_back({i == 0 ? 0 : plan.line.slots, at_mm(points[i], "U"), at_mm(points[i], "V")});
  }
  return {};
}

}  // namespace

EdgesIn edges_in(const AbPlan& ab, const std::optional<AxisSpin>& spin, std::int64_t begin, std::int64_t end,
                 std::size_t most) {
  // All in counts * fraction_den, so that the fraction's carries need no rounding: after s steps the counter and its
  // second accumulator together stand at `start` + s * `step`, and its whole part over a quarter is an edge.
  const SpinStart phase = spin_start(ab, spin);
  const Integer den = ab.fraction_den;
  const Integer start = Integer(phase.counts) * den + phase.accumulator;
  const Integer step = Integer(ab.increment) * den + ab.fraction_num;
  const Integer quarter = (Integer(1) << static_cast<unsigned>(ab.counter_bits - 2)) * den;
  const auto edges_after = [&](std::int64_t ticks) {
    return Integer((start + step * Integer(static_cast<std::uint64_t>(ticks) / ab.prescaler)) / quarter);
  };
  EdgesIn edges;
  edges.before = edges_after(begin);
  const Integer last = edges_after(end);
  for (Integer edge = edges.before + 1; edge <= last; ++edge) {
    if (edges.ticks.size() == most) {
      edges.cut = true;
      break;
    }
    const Integer steps = (edge * quarter - start + step - 1) / step;
    edges.ticks.push_back(static_cast<std::int64_t>(Integer(steps * ab.prescaler)));
  }
  return edges;
}

Result<std::int64_t> first_firing_line(LineSource& program, std::int64_t revolution, std::int64_t line) {
  const ProgramHeader& header = program.header();
  ProgramChunk chunk;
  for (std::int64_t l = line; l < header.plan.rotary.lines_per_revolution; ++l) {
    GRAVURE_TRY(const std::span<const std::byte> bits, bits_of_line(program, chunk, revolution, l));
    if (std::any_of(bits.begin(), bits.end(), [](std::byte byte) { return byte != std::byte{0}; })) {
      return l;
    }
  }
  return line;
}

Result<LineView> line_view(LineSource& program, std::int64_t revolution, std::int64_t line) {
  const Plan& plan = program.header().plan;
  LineView view;
  view.revolution = revolution;
  view.line = line;
  view.reverse = line_is_reverse(plan, revolution, line);
  view.first_slot = view.reverse ? plan.line.reverse_first_slot : plan.line.forward_first_slot;
  ProgramChunk chunk;
  GRAVURE_TRY(const std::span<const std::byte> bits, bits_of_line(program, chunk, revolution, line));
  add_gate(bits, plan.line.pixels, view);
  if (plan.path) {
    GRAVURE_CHECK(add_set_points(program, view));
    return view;
  }
  add_edges(plan, view);
  add_mirrors(plan, view);
  return view;
}

}  // namespace gravure::report
