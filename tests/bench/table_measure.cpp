#include "table_step.hpp"

#include <ctime>
#include <fstream>

namespace gravure::bench {
namespace {

double wall_ms() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

}  // namespace

double cpu_ms() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

double peak_mib() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("VmHWM:")) {
      return std::stod(line.substr(6)) / 1024;
    }
  }
  stop("/proc/self/status does not tell VmHWM");
}

void repeat(const std::function<void()>& step, double seconds) {
  constexpr double kLongMs = 150;  // beside this, what a first run costs more is nothing
  double start = cpu_ms();
  double wall = wall_ms();
  int times = 1;
  step();
  if (cpu_ms() - start <= kLongMs) {
    start = cpu_ms();
    wall = wall_ms();
    times = 0;
    do {
      step();
      ++times;
    } while (cpu_ms() - start < 1e3 * seconds);
  }
  std::printf("%.3f %.0f %.3f\n", (cpu_ms() - start) / times, peak_mib(), (wall_ms() - wall) / times);
}

}  // namespace gravure::bench
