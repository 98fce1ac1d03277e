#include "emulate/emulate_runs.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "emulate/emulate.hpp"
#include "gravure/core/spin_phase.hpp"

namespace gravure::cli {
namespace {

/// Edges that marking puts out in the first `ticks` ticks of a run.
Integer edges_of_run(const Plan& plan, std::int64_t ticks) {
  const SpinStart start = spin_start(plan.ab, plan.spin);
  const SpinPhase phase = phase_after(plan.ab, plan.ab.increment, ticks, {Integer(start.counts), start.accumulator});
  return phase.counts / (Integer(1) << static_cast<unsigned>(plan.ab.counter_bits - 2));
}

/// How far a run has taken the axis: ramps included, where it came to rest.
std::int64_t way_of(const EmulatedRun& run) {
  return run.status.axis_at_rest ? run.status.axis_at_rest->edges : run.status.axis.edges;
}

}  // namespace

Integer edges_to_tick(const Plan& plan, std::int64_t tick) {
  const std::int64_t run_ticks = run_with(plan, 0).ticks;
  const std::int64_t whole = tick / run_ticks;
  return edges_of_run(plan, run_ticks) * whole + edges_of_run(plan, tick % run_ticks);
}

Json run_axis_json(const Plan& plan, const EmulatedRun& run) {
  const fpga::AbRegisters registers{plan.ab.counter_bits, plan.ab.prescaler, plan.ab.increment, plan.ab.fraction_num,
                                    plan.ab.fraction_den};
  Json axis = axis_json(registers, static_cast<std::uint64_t>(run.status.tick - run.run.first_tick));
  if (run.run.backward) {
    std::swap(axis["a"], axis["b"]);
  }
  axis["counts"] = json_integer(counts_of(run.status.axis));
  axis["edges"] = json_integer(Integer(run.status.axis.edges));
  return axis;
}

Json runs_json(const Plan& plan, const std::vector<EmulatedRun>& runs) {
  Json list = Json::array();
  for (const EmulatedRun& each : runs) {
    Json one = {{"first_revolution", each.run.first_revolution},
                {"revolutions", each.run.revolutions},
                {"direction", each.run.backward ? "backward" : "forward"},
                {"band", each.run.band},
                {"axial_mm", json_ratio(each.run.axial_mm)},
                {"first_tick", json_integer(Integer(each.run.first_tick))},
                {"end_tick", json_integer(Integer(each.status.tick))},
                {"edges", json_integer(Integer(each.status.axis.edges))}};
    if (plan.spin) {
      one["spin_up_edges"] = json_integer(Integer(each.status.axis_spun_up.edges));
    }
    if (each.status.axis_at_rest) {
      one["rest_edges"] = json_integer(Integer(each.status.axis_at_rest->edges));
    }
    list.push_back(std::move(one));
  }
  return list;
}

std::string runs_text(const Plan& plan, const std::vector<EmulatedRun>& runs) {
  if (runs.size() < 2) {
    return {};
  }
  const auto backward =
      std::count_if(runs.begin(), runs.end(), [](const EmulatedRun& each) { return each.run.backward; });
  std::int64_t way = 0;
  for (const EmulatedRun& each : runs) {
    way += way_of(each);
  }
  return fmt::format("{} runs of the board{}, {}; {}{} A-B edges from the first to the last\n", runs.size(),
                     backward > 0 ? fmt::format(", {} of them backward", backward) : "",
                     plan.spin ? "each from rest to rest" : "the counter at 0 at the first line of each",
                     way > 0 ? "+" : "", way);
}

}  // namespace gravure::cli
