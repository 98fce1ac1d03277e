#pragma once

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>

#include "gravure/core/error.hpp"

namespace gravure::usb {

using Deadline = std::chrono::steady_clock::time_point;

/// A time that can be waited for, whatever the patience.
inline Deadline deadline_after(std::chrono::milliseconds patience) {
  constexpr std::chrono::hours kMost{24 * 365};
  return std::chrono::steady_clock::now() + std::min<std::chrono::milliseconds>(patience, kMost);
}

/// What the threads of a link share. Everything below is read and written with `mutex` held, the transfers' own books
/// (StreamOut, StatusIn) as well; libusb calls its callbacks without locks that submitting or cancelling would take.
struct LinkState {
  std::mutex mutex;
  std::condition_variable changed;
  std::optional<Error> failure;  ///< the first; the link goes on failing with it
  bool closing = false;

  void fail(const Error& error) {
    if (!failure && !closing) {
      failure = error;
    }
    changed.notify_all();
  }
};

}  // namespace gravure::usb
