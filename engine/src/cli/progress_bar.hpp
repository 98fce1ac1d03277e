#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "gravure/core/progress.hpp"

namespace gravure::cli {

/// " 45.3 %, 1234 of 2724 lines, 8.3e5 lines/s, 0:12 left": how far a job is `elapsed_s` after its start. Rate and time
/// are left out while nothing is done or no time has passed.
std::string progress_text(std::int64_t done, std::int64_t total, const std::string& unit, double elapsed_s);

/// "0:07", "12:30", "3:02:11"
std::string duration_text(double seconds);

/// How far a job is, on standard error: a bar on a terminal, ten times a second at most; else a line a minute, so that
/// a log shows that it goes on and a short job says nothing. GRAVURE_PROGRESS_S gives other seconds between the lines.
class ProgressBar final : public Progress {
 public:
  explicit ProgressBar(std::string what, std::string unit = "lines");
  ~ProgressBar() override;
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  void update(std::int64_t done, std::int64_t total) override;

 private:
  using Clock = std::chrono::steady_clock;
  std::string what_;
  std::string unit_;
  bool terminal_;
  std::chrono::duration<double> between_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point shown_ = start_;
  bool drawn_ = false;
};

}  // namespace gravure::cli
