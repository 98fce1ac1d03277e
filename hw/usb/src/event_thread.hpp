#pragma once

#include <libusb.h>

#include <atomic>
#include <thread>

namespace gravure::usb {

/// Runs the callbacks of a context until it goes.
class EventThread {
 public:
  explicit EventThread(libusb_context* context);
  ~EventThread();
  EventThread(const EventThread&) = delete;
  EventThread& operator=(const EventThread&) = delete;

 private:
  void run() noexcept;

  libusb_context* context_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace gravure::usb
