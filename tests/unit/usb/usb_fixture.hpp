#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <list>
#include <memory>
#include <string>
#include <vector>

#include "dice.hpp"
#include "fake_board.hpp"
#include "gravure/usb/usb_link.hpp"
#include "mock_bus.hpp"

namespace gravure::usb {

using namespace std::chrono_literals;
using test::FakeBoard;
using test::MockBus;
using test::UsbFault;

inline constexpr std::chrono::milliseconds kLong = 20s;  ///< far more than anything needs that comes

/// A bus with whatever a test plugs in.
class UsbTest : public testing::Test {
 protected:
  UsbTest() {
    auto bus = MockBus::create();
    if (!bus) {
      ADD_FAILURE() << bus.error().message;
      return;
    }
    bus_ = std::move(bus).value();
  }
  void SetUp() override { ASSERT_TRUE(bus_); }

  /// The only board, opened.
  std::unique_ptr<DeviceLink> open(const UsbOptions& options = {}) {
    auto link = open_usb_link(options);
    if (!link) {
      ADD_FAILURE() << link.error().message;
      return nullptr;
    }
    return std::move(link).value();
  }

  static std::vector<std::byte> random_bytes(std::size_t size) {
    test::Dice dice;
    std::vector<std::byte> bytes(size);
    for (std::byte& byte : bytes) {
      byte = static_cast<std::byte>(dice.word());
    }
    return bytes;
  }

  /// The first status that `fits`; none where none comes in a long time.
  static std::optional<BoardStatus> status_with(DeviceLink& link, const auto& fits) {
    const auto deadline = std::chrono::steady_clock::now() + kLong;
    for (;;) {
      const auto status = link.next_status(kLong);
      if (!status || !status.value() || std::chrono::steady_clock::now() > deadline) {
        ADD_FAILURE() << (status ? "no status in time" : status.error().message);
        return std::nullopt;
      }
      if (fits(*status.value())) {
        return status.value();
      }
    }
  }

  /// The error that a link ends with.
  static Error error_of(DeviceLink& link) {
    const auto deadline = std::chrono::steady_clock::now() + kLong;
    for (;;) {
      const auto status = link.next_status(kLong);
      if (!status) {
        return status.error();
      }
      if (!status.value() || std::chrono::steady_clock::now() > deadline) {
        ADD_FAILURE() << "the link does not fail";
        return {ErrorCode::timeout, ""};
      }
    }
  }

  std::list<FakeBoard> boards_;  ///< outlive the bus
  std::unique_ptr<MockBus> bus_;
};

inline bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace gravure::usb
