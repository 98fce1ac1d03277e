// What a shop's own test would do: plan a job, run the counter, look at an edge.
#include <cstdio>

#include "gravure/formats/grv.hpp"
#include "gravure/formats/job_file.hpp"
#include "gravure/fpga/ab_edges.hpp"
#include "gravure/sync/make_plan.hpp"

int main() {
  const auto job = gravure::parse_job(gravure::starter_job(gravure::Mode::rotary), "starter.toml");
  if (!job) {
    return 1;
  }
  const auto plan = gravure::make_plan(job.value(), gravure::kStarterPixels, 2);
  if (!plan) {
    return 1;
  }
  const gravure::AbPlan& ab = plan.value().ab;
  auto edges =
      gravure::fpga::AbEdges::make({ab.counter_bits, ab.prescaler, ab.increment, ab.fraction_num, ab.fraction_den});
  const auto first = edges->next_edge();
  std::printf("first edge on clock %llu\n", static_cast<unsigned long long>(first->clock));
  return gravure::open_grv("missing.grv") ? 1 : 0;
}
