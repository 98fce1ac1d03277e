#include "progress_bar.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include "log.hpp"

namespace gravure::cli {
namespace {

double seconds_between_lines() {
  constexpr double kMinute = 60;
  const char* asked = std::getenv("GRAVURE_PROGRESS_S");
  if (asked == nullptr || *asked == '\0') {
    return kMinute;
  }
  char* end = nullptr;
  const double seconds = std::strtod(asked, &end);
  return *end == '\0' && seconds >= 0 ? seconds : kMinute;
}

}  // namespace

std::string duration_text(double seconds) {
  const auto whole = static_cast<std::int64_t>(std::ceil(seconds));
  const std::int64_t hours = whole / 3600;
  const std::int64_t minutes = whole / 60 % 60;
  return hours > 0 ? fmt::format("{}:{:02}:{:02}", hours, minutes, whole % 60)
                   : fmt::format("{}:{:02}", minutes, whole % 60);
}

std::string progress_text(std::int64_t done, std::int64_t total, const std::string& unit, double elapsed_s) {
  const double share = static_cast<double>(done) / static_cast<double>(total);
  std::string text = fmt::format("{:5.1f} %, {} of {} {}", std::floor(1000 * share) / 10, done, total, unit);
  if (done > 0 && elapsed_s > 0) {
    const double rate = static_cast<double>(done) / elapsed_s;
    text += fmt::format(", {:.3g} {}/s, {} left", rate, unit, duration_text(static_cast<double>(total - done) / rate));
  }
  return text;
}

ProgressBar::ProgressBar(std::string what, std::string unit)
    : what_(std::move(what)),
      unit_(std::move(unit)),
      terminal_(::isatty(STDERR_FILENO) == 1),
      between_(terminal_ ? 0.1 : seconds_between_lines()) {}

ProgressBar::~ProgressBar() {
  if (drawn_) {
    std::fputs("\r\033[K", stderr);
  }
}

void ProgressBar::update(std::int64_t done, std::int64_t total) {
  if (total <= 0 || !is_logged(LogLevel::info)) {
    return;
  }
  const Clock::time_point now = Clock::now();
  if (now - shown_ < between_) {
    return;
  }
  shown_ = now;
  const std::string text = progress_text(done, total, unit_, std::chrono::duration<double>(now - start_).count());
  if (!terminal_) {
    log(LogLevel::info, what_ + ": " + text.substr(text.find_first_not_of(' ')));
    return;
  }
  drawn_ = true;
  constexpr std::size_t kWidth = 24;
  const auto filled =
      static_cast<std::size_t>(static_cast<double>(done) / static_cast<double>(total) * static_cast<double>(kWidth));
  std::fprintf(stderr, "\r\033[K%s [%s%s] %s", what_.c_str(), std::string(filled, '#').c_str(),
               std::string(kWidth - filled, '.').c_str(), text.c_str());
}

}  // namespace gravure::cli
