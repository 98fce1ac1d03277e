#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "control_answer.hpp"
#include "gravure/core/device_link.hpp"
#include "gravure/protocol/control.hpp"
#include "usb_board.hpp"
#include "usb_fault.hpp"

namespace gravure::test {

/// One transfer between submit and reap, whoever asked for it.
struct Urb {
  const void* client = nullptr;  ///< who may reap it
  std::uint64_t address = 0;     ///< its name at the client
  std::uint8_t endpoint = 0;     ///< 0, 01, 81
  protocol::Setup setup;         ///< endpoint 0
  std::size_t length = 0;        ///< asked for
  std::vector<std::byte> data;   ///< what goes out; what came in
  int status = 0;                ///< negative errno
  std::size_t actual = 0;        ///< bytes that went over
  std::shared_ptr<void> memory;  ///< of the one who submits
};

/// The endpoints of a board: a thread of its own moves what is submitted, breaks what it is told to break, and keeps
/// what is done until it is reaped. Ordered in each endpoint unless a fault says otherwise.
class BoardEndpoints {
 public:
  /// `set_ready(true)` where something can be reaped, false where that was the last; called with a lock held.
  /// `on_unplug` comes from the thread of the endpoints, once.
  BoardEndpoints(UsbBoard& board, DeviceTexts texts, std::function<void(bool)> set_ready,
                 std::function<void()> on_unplug);
  ~BoardEndpoints();
  BoardEndpoints(const BoardEndpoints&) = delete;
  BoardEndpoints& operator=(const BoardEndpoints&) = delete;

  /// 0 or an errno. Once unplugged, everything gives ENODEV but reaping what is left.
  int submit(Urb urb);
  std::optional<Urb> reap(const void* client);
  int discard(const void* client, std::uint64_t address);
  int clear_halt(std::uint8_t endpoint);
  int claim(const void* client);
  int release(const void* client);
  void forget(const void* client);  ///< its file is closed

  void inject(std::uint8_t endpoint, const UsbFault& fault);
  void unplug();
  bool unplugged();
  std::size_t pending_faults();  ///< injected and not yet struck

 private:
  using Clock = std::chrono::steady_clock;
  /// Of the first transfer that waits.
  struct Progress {
    bool struck = false;  ///< the faults have been asked
    bool altered = false;
    std::optional<UsbFault> fault;
    std::optional<Clock::time_point> not_before;
    std::size_t moved = 0;  ///< bytes
  };
  struct Endpoint {
    std::deque<Urb> waiting;
    std::deque<UsbFault> faults;
    bool halted = false;
    bool stuck = false;  ///< NAK for ever
    Progress now;
  };
  struct Held {
    Urb urb;
    std::size_t transfers = 0;
    Clock::time_point until;
  };

  void run();
  void serve_control();
  void serve_stream();
  void serve_status();
  std::optional<UsbFault> strike(Endpoint& endpoint);
  bool must_wait(const Endpoint& endpoint) const;
  void finish(Endpoint& endpoint, int status, std::size_t actual);
  void put_done(Urb urb);
  void release_held(std::uint8_t endpoint);
  void retire_all();
  bool move_out(Endpoint& endpoint, std::size_t most);
  std::optional<std::vector<std::byte>> next_message();

  UsbBoard& board_;
  DeviceTexts texts_;
  std::function<void(bool)> set_ready_;
  std::function<void()> on_unplug_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::uint8_t, Endpoint> endpoints_;
  std::list<Held> held_;
  std::list<Urb> done_;
  const void* owner_ = nullptr;  ///< of the interface
  std::optional<BoardStatus> sent_;
  Clock::time_point sent_at_;
  std::uint32_t messages_ = 0;
  bool gone_ = false;
  bool told_ = false;
  bool stop_ = false;
  std::thread thread_;
};

}  // namespace gravure::test
