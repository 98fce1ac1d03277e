#include "event_thread.hpp"

#include <chrono>

namespace gravure::usb {
namespace {

constexpr timeval kSlice{0, 100'000};  // should an interrupt be lost, closing takes no longer
constexpr std::chrono::milliseconds kAfterError{10};

}  // namespace

EventThread::EventThread(libusb_context* context) : context_(context), thread_([this] { run(); }) {}

EventThread::~EventThread() {
  stop_ = true;
  libusb_interrupt_event_handler(context_);
  thread_.join();
}

void EventThread::run() noexcept {
  while (!stop_) {
    timeval slice = kSlice;
    const int code = libusb_handle_events_timeout_completed(context_, &slice, nullptr);
    if (code != LIBUSB_SUCCESS && code != LIBUSB_ERROR_INTERRUPTED) {
      std::this_thread::sleep_for(kAfterError);  // whoever waits for a transfer has a time-out of its own
    }
  }
}

}  // namespace gravure::usb
