#pragma once

#include <algorithm>
#include <condition_variable>
#include <limits>
#include <map>
#include <mutex>
#include <vector>

#include "gravure/fpga/register_map.hpp"
#include "gravure/protocol/status_message.hpp"
#include "usb_board.hpp"

namespace gravure::test {

/// A board that remembers what it was given and does nothing with it: the stream stays in its buffer until taken out.
/// The test looks at it from its own thread.
class FakeBoard final : public UsbBoard {
 public:
  explicit FakeBoard(std::size_t capacity = std::numeric_limits<std::uint32_t>::max()) : capacity_(capacity) {
    registers_[fpga::kMagicRegister.address] = static_cast<std::uint32_t>(fpga::kMagicRegister.reset);
    registers_[fpga::kVersionRegister.address] = static_cast<std::uint32_t>(fpga::kVersionRegister.reset);
    status_.protocol_version = protocol::kProtocolVersion;
    status_.power_up = 1;
    status_.capacity_bytes = static_cast<std::uint32_t>(capacity);
  }

  /// 0xFF is one the board refuses to touch.
  static constexpr std::uint8_t kRefused = 0xFF;
  Result<std::uint32_t> read_register(std::uint8_t address) override {
    const std::lock_guard lock(mutex_);
    return address == kRefused ? Result<std::uint32_t>(Error{ErrorCode::device, "refused"}) : registers_[address];
  }
  Result<void> write_register(std::uint8_t address, std::uint32_t value) override {
    const std::lock_guard lock(mutex_);
    registers_[address] = value;
    return address == kRefused ? Result<void>(Error{ErrorCode::device, "refused"}) : Result<void>();
  }
  std::size_t take(std::span<const std::byte> stream) override {
    const std::lock_guard lock(mutex_);
    const std::size_t size = std::min(stream.size(), capacity_ - waiting_);
    taken_.insert(taken_.end(), stream.begin(), stream.begin() + static_cast<std::ptrdiff_t>(size));
    waiting_ += size;
    return size;
  }
  BoardStatus status() override {
    const std::lock_guard lock(mutex_);
    status_.level_bytes = static_cast<std::uint32_t>(waiting_);
    return status_;
  }

  /// What the test makes of it.
  void set(std::uint8_t address, std::uint32_t value) {
    const std::lock_guard lock(mutex_);
    registers_[address] = value;
  }
  void say(auto change) {
    const std::lock_guard lock(mutex_);
    change(status_);
  }
  void free(std::size_t bytes) {  ///< of the buffer
    const std::lock_guard lock(mutex_);
    waiting_ -= std::min(bytes, waiting_);
  }
  std::vector<std::byte> taken() {
    const std::lock_guard lock(mutex_);
    return taken_;
  }

 private:
  std::mutex mutex_;
  std::size_t capacity_;
  std::size_t waiting_ = 0;
  std::map<std::uint8_t, std::uint32_t> registers_;
  std::vector<std::byte> taken_;
  BoardStatus status_;
};

}  // namespace gravure::test
