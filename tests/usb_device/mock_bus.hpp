#pragma once

#include <cstdint>
#include <list>
#include <memory>
#include <string>

#include "board_endpoints.hpp"
#include "gravure/core/error.hpp"
#include "usb_board.hpp"

namespace gravure::test {

/// A USB bus of this process, and of those it starts with the same preloaded library, that holds nothing but what is
/// plugged in here: libusb above it is the real one (umockdev). One at a time.
class MockBus {
 public:
  struct Plug {
    std::string serial = "TEST-1";
    std::string product = "gravure test board";
    int megabits_per_s = 480;
    std::uint16_t vendor_id = protocol::kVendorId;
    std::uint16_t product_id = protocol::kProductId;
  };
  class Device;

  /// device where libumockdev-preload is not in this process.
  static Result<std::unique_ptr<MockBus>> create();
  ~MockBus();
  MockBus(const MockBus&) = delete;
  MockBus& operator=(const MockBus&) = delete;

  /// A device on the bus; it stays until unplugged.
  Device& plug(UsbBoard& board, const Plug& plug);
  Device& plug(UsbBoard& board) { return this->plug(board, Plug{}); }

  /// The folder with the bus' own /dev and /sys.
  const std::string& root() const noexcept { return root_; }

 private:
  struct Testbed;
  explicit MockBus(std::unique_ptr<Testbed> testbed);

  std::unique_ptr<Testbed> testbed_;
  std::string root_;
  std::list<std::unique_ptr<Device>> devices_;
  int next_number_ = 1;
};

/// What is plugged in.
class MockBus::Device {
 public:
  Device(Testbed& testbed, const std::string& root, int number, UsbBoard& board, const Plug& plug);
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  /// What goes wrong on its wire.
  void inject(std::uint8_t endpoint, const UsbFault& fault);
  std::size_t pending_faults();
  /// Pulled out, transfers on their way or not.
  void unplug();
  /// Its node below MockBus::root(), a terminal that says when there is something to reap.
  const std::string& node_path() const noexcept;

 private:
  class Node;
  class Handler;
  std::unique_ptr<Node> node_;
  std::unique_ptr<Handler> handler_;
};

}  // namespace gravure::test
