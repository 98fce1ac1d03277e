// Do our registers put out exactly 320312.5 A-B edges in a second of 164 MHz, evenly spaced?
#include <cstdio>
#include <gravure/fpga/ab_edges.hpp>

int main() {
  auto edges = gravure::fpga::AbEdges::make({.bits = 32, .prescaler = 1, .increment = 1 << 21});
  std::uint64_t number = 0;
  bool even = edges.has_value();
  edges->run_to(2 * 164'000'000, [&](const auto& edge) { even = even && edge.clock == 512 * ++number; });
  std::printf("%llu edges in two seconds\n", static_cast<unsigned long long>(number));
  return even && number == 640'625 ? 0 : 1;
}
