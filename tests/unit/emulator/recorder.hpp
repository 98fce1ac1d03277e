#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <vector>

#include "gravure/emulator/emulated_device.hpp"

namespace gravure::emulator::test {

/// Keeps what the pins showed.
class Recorder final : public PinObserver {
 public:
  struct Line {
    std::int64_t start_tick = 0;
    std::int64_t ordinal = 0;
    std::int64_t first_slot = 0;
    std::vector<std::byte> fired;
    AxisState axis;
    AxisState carriage;
    bool dark() const {
      for (const std::byte byte : fired) {
        if (byte != std::byte{0}) {
          return false;
        }
      }
      return true;
    }
  };
  void on_line(const ExecutedLine& line) override {
    lines.push_back({line.start_tick,
                     line.ordinal,
                     line.first_slot,
                     {line.fired.begin(), line.fired.end()},
                     line.axis_at_start,
                     line.carriage_at_start});
  }
  std::vector<Line> lines;
};

inline constexpr std::int64_t kLineTicks = 60;  ///< of small_setup()

/// 3 revolutions of 4 lines of 20 slots, 13 of them in the window; 3 ticks a slot.
inline DeviceSetup small_setup() {
  return {.counter_bits = 16,
          .prescaler = 2,
          .increment = 1234,
          .fraction_num = 5,
          .fraction_den = 7,
          .ticks_per_slot = 3,
          .slots_per_line = 20,
          .window_slots = 13,
          .lines_per_revolution = 4,
          .end_revolution = 3};
}

/// A frame with bits of its own and a good checksum.
class Frame {
 public:
  Frame(std::int64_t revolution, std::int64_t line)
      : bits_{static_cast<std::byte>(0x81 + revolution), static_cast<std::byte>(0xF8 - 8 * line)} {
    frame_ = {.revolution = revolution, .line = line, .first_slot = 3 + line, .bits = bits_};
    sign();
  }
  Frame(const Frame&) = delete;
  Frame& operator=(const Frame&) = delete;

  std::vector<std::byte>& bits() { return bits_; }
  LineFrame& operator*() { return frame_; }
  LineFrame* operator->() { return &frame_; }
  Frame& sign() {
    frame_.bits = bits_;
    frame_.crc32c = frame_crc32c(frame_);
    return *this;
  }

 private:
  std::vector<std::byte> bits_;
  LineFrame frame_;
};

inline Result<void> send(EmulatedDevice& device, std::int64_t revolution, std::int64_t line) {
  Frame frame(revolution, line);
  return device.send(*frame);
}

/// The call failed with ErrorCode::device and a message that has every one of `parts`.
inline void expect_refused(const Result<void>& result, std::initializer_list<std::string> parts) {
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::device);
  for (const std::string& part : parts) {
    EXPECT_NE(result.error().message.find(part), std::string::npos)
        << "\"" << part << "\" is missing from: " << result.error().message;
  }
}

}  // namespace gravure::emulator::test
