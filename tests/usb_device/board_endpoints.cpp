#include "board_endpoints.hpp"

#include <algorithm>
#include <cerrno>
#include <utility>

#include "gravure/protocol/status_message.hpp"

namespace gravure::test {
namespace {

using protocol::kStatusEndpoint;
using protocol::kStreamEndpoint;
using std::chrono::milliseconds;
using Kind = UsbFault::Kind;

constexpr milliseconds kPoll{2};           // of the board, while somebody waits for it
constexpr milliseconds kMostSilence{100};  // between status messages

bool same_news(BoardStatus one, const BoardStatus& other) {
  one.sequence = other.sequence;
  one.tick = other.tick;
  return protocol::encode_status(one) == protocol::encode_status(other);
}

/// What the system says of a transfer that ended so; 0: nothing.
int error_of(Kind kind) {
  switch (kind) {
    case Kind::stall:
      return -EPIPE;
    case Kind::bus_error:
      return -EPROTO;
    case Kind::babble:
      return -EOVERFLOW;
    default:
      return 0;
  }
}

/// Ends a transfer before its end.
bool cuts(Kind kind) {
  return error_of(kind) != 0 || kind == Kind::cut_short || kind == Kind::unplug;
}

void alter(std::vector<std::byte>& data, const UsbFault& fault) {
  if (fault.kind == Kind::corrupt && fault.bytes < data.size()) {
    data[fault.bytes] ^= std::byte{1};
  } else if (fault.kind == Kind::twice) {
    const std::vector<std::byte> once = data;
    data.insert(data.end(), once.begin(), once.end());
  }
}

}  // namespace

BoardEndpoints::BoardEndpoints(UsbBoard& board, DeviceTexts texts, std::function<void(bool)> set_ready,
                               std::function<void()> on_unplug)
    : board_(board),
      texts_(std::move(texts)),
      set_ready_(std::move(set_ready)),
      on_unplug_(std::move(on_unplug)),
      thread_([this] { run(); }) {}

BoardEndpoints::~BoardEndpoints() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

int BoardEndpoints::submit(Urb urb) {
  const std::lock_guard lock(mutex_);
  if (gone_) {
    return ENODEV;
  }
  if (urb.endpoint != 0 && urb.endpoint != kStreamEndpoint && urb.endpoint != kStatusEndpoint) {
    return ENOENT;
  }
  Endpoint& endpoint = endpoints_[urb.endpoint];
  if (!endpoint.faults.empty() && endpoint.faults.front().kind == Kind::refuse && endpoint.faults.front().skip-- == 0) {
    endpoint.faults.pop_front();
    return ENOMEM;
  }
  endpoint.waiting.push_back(std::move(urb));
  changed_.notify_all();
  return 0;
}

std::optional<Urb> BoardEndpoints::reap(const void* client) {
  const std::lock_guard lock(mutex_);
  const auto mine = std::find_if(done_.begin(), done_.end(), [&](const Urb& urb) { return urb.client == client; });
  if (mine == done_.end()) {
    return std::nullopt;
  }
  Urb urb = std::move(*mine);
  done_.erase(mine);
  if (done_.empty()) {
    set_ready_(false);
  }
  return urb;
}

int BoardEndpoints::discard(const void* client, std::uint64_t address) {
  const std::lock_guard lock(mutex_);
  const auto is_it = [&](const Urb& urb) { return urb.client == client && urb.address == address; };
  for (auto& [number, endpoint] : endpoints_) {
    const auto found = std::find_if(endpoint.waiting.begin(), endpoint.waiting.end(), is_it);
    if (found != endpoint.waiting.end()) {
      Urb urb = std::move(*found);
      urb.status = -ENOENT;
      if (found == endpoint.waiting.begin()) {
        urb.actual = number == kStreamEndpoint ? std::min(endpoint.now.moved, urb.length) : 0;
        endpoint.now = {};
      }
      endpoint.waiting.erase(found);
      put_done(std::move(urb));
      return 0;
    }
  }
  const auto held = std::find_if(held_.begin(), held_.end(), [&](const Held& one) { return is_it(one.urb); });
  if (held == held_.end()) {
    return gone_ ? ENODEV : EINVAL;
  }
  held->urb.status = -ENOENT;
  put_done(std::move(held->urb));
  held_.erase(held);
  return 0;
}

int BoardEndpoints::clear_halt(std::uint8_t endpoint) {
  const std::lock_guard lock(mutex_);
  endpoints_[endpoint].halted = false;
  endpoints_[endpoint].stuck = false;
  changed_.notify_all();
  return gone_ ? ENODEV : 0;
}

int BoardEndpoints::claim(const void* client) {
  const std::lock_guard lock(mutex_);
  if (gone_) {
    return ENODEV;
  }
  if (owner_ != nullptr && owner_ != client) {
    return EBUSY;
  }
  owner_ = client;
  return 0;
}

int BoardEndpoints::release(const void* client) {
  const std::lock_guard lock(mutex_);
  if (owner_ != client) {
    return gone_ ? ENODEV : EINVAL;
  }
  owner_ = nullptr;
  return gone_ ? ENODEV : 0;
}

void BoardEndpoints::forget(const void* client) {
  const std::lock_guard lock(mutex_);
  const auto is_its = [&](const Urb& urb) { return urb.client == client; };
  for (auto& [number, endpoint] : endpoints_) {
    if (!endpoint.waiting.empty() && is_its(endpoint.waiting.front())) {
      endpoint.now = {};
    }
    endpoint.waiting.erase(std::remove_if(endpoint.waiting.begin(), endpoint.waiting.end(), is_its),
                           endpoint.waiting.end());
  }
  held_.remove_if([&](const Held& one) { return is_its(one.urb); });
  done_.remove_if(is_its);
  if (done_.empty()) {
    set_ready_(false);
  }
  if (owner_ == client) {
    owner_ = nullptr;
  }
}

void BoardEndpoints::inject(std::uint8_t endpoint, const UsbFault& fault) {
  const std::lock_guard lock(mutex_);
  endpoints_[endpoint].faults.push_back(fault);
}

void BoardEndpoints::unplug() {
  const std::lock_guard lock(mutex_);
  retire_all();
  changed_.notify_all();
}

bool BoardEndpoints::unplugged() {
  const std::lock_guard lock(mutex_);
  return gone_;
}

std::size_t BoardEndpoints::pending_faults() {
  const std::lock_guard lock(mutex_);
  std::size_t count = 0;
  for (const auto& [number, endpoint] : endpoints_) {
    count += endpoint.faults.size();
  }
  return count;
}

void BoardEndpoints::run() {
  std::unique_lock lock(mutex_);
  while (!stop_) {
    if (!gone_) {
      board_.pass_time();
      serve_control();
      serve_stream();
      serve_status();
      const auto now = Clock::now();
      for (const std::uint8_t endpoint : {std::uint8_t{0}, kStreamEndpoint, kStatusEndpoint}) {
        if (std::any_of(held_.begin(), held_.end(), [&](const Held& one) { return one.until <= now; })) {
          release_held(endpoint);
        }
      }
    }
    if (gone_ && !std::exchange(told_, true)) {
      lock.unlock();
      on_unplug_();
      lock.lock();
      continue;
    }
    const bool idle = gone_ || std::all_of(endpoints_.begin(), endpoints_.end(),
                                           [](const auto& each) { return each.second.waiting.empty(); });
    if (idle && held_.empty()) {
      changed_.wait(lock);
    } else {
      changed_.wait_for(lock, kPoll);
    }
  }
}

/// Asks, once for each transfer, whether a fault strikes it.
std::optional<UsbFault> BoardEndpoints::strike(Endpoint& endpoint) {
  Progress& now = endpoint.now;
  if (std::exchange(now.struck, true) || endpoint.faults.empty() || endpoint.faults.front().kind == Kind::refuse) {
    return now.fault;
  }
  if (endpoint.faults.front().skip > 0) {
    --endpoint.faults.front().skip;
    return now.fault;
  }
  now.fault = endpoint.faults.front();
  endpoint.faults.pop_front();
  if (now.fault->kind == Kind::delay) {
    now.not_before = Clock::now() + now.fault->delay;
  }
  endpoint.stuck = endpoint.stuck || now.fault->kind == Kind::never;
  return now.fault;
}

bool BoardEndpoints::must_wait(const Endpoint& endpoint) const {
  return endpoint.stuck || (endpoint.now.not_before && Clock::now() < *endpoint.now.not_before);
}

void BoardEndpoints::finish(Endpoint& endpoint, int status, std::size_t actual) {
  Urb urb = std::move(endpoint.waiting.front());
  endpoint.waiting.pop_front();
  urb.status = status;
  urb.actual = actual;
  const std::optional<UsbFault> fault = std::exchange(endpoint.now, {}).fault;
  const std::uint8_t number = urb.endpoint;
  if (fault && fault->kind == Kind::hold) {
    held_.push_back({std::move(urb), fault->transfers, Clock::now() + fault->delay});
    return;
  }
  put_done(std::move(urb));
  for (Held& held : held_) {
    if (held.urb.endpoint == number && held.transfers > 0) {
      --held.transfers;
    }
  }
  release_held(number);
}

void BoardEndpoints::put_done(Urb urb) {
  done_.push_back(std::move(urb));
  set_ready_(true);
}

void BoardEndpoints::release_held(std::uint8_t endpoint) {
  const auto now = Clock::now();
  for (auto held = held_.begin(); held != held_.end();) {
    if (held->urb.endpoint == endpoint && (held->transfers == 0 || held->until <= now)) {
      put_done(std::move(held->urb));
      held = held_.erase(held);
    } else {
      ++held;
    }
  }
}

/// The system gives every transfer back before the file says ENODEV.
void BoardEndpoints::retire_all() {
  if (std::exchange(gone_, true)) {
    return;
  }
  for (auto& [number, endpoint] : endpoints_) {
    for (bool first = true; !endpoint.waiting.empty(); first = false) {
      Urb urb = std::move(endpoint.waiting.front());
      endpoint.waiting.pop_front();
      urb.status = -ESHUTDOWN;
      urb.actual = first && number == kStreamEndpoint ? std::min(endpoint.now.moved, urb.length) : 0;
      put_done(std::move(urb));
    }
  }
  for (Held& held : held_) {
    put_done(std::move(held.urb));
  }
  held_.clear();
}

void BoardEndpoints::serve_stream() {
  Endpoint& endpoint = endpoints_[kStreamEndpoint];
  while (!gone_ && !endpoint.waiting.empty()) {
    if (endpoint.halted) {
      finish(endpoint, -EPIPE, 0);
      continue;
    }
    const std::optional<UsbFault> fault = strike(endpoint);
    if (must_wait(endpoint)) {
      return;
    }
    const std::size_t length = endpoint.waiting.front().length;
    if (fault && fault->kind == Kind::lose) {
      finish(endpoint, 0, length);
      continue;
    }
    if (fault && !std::exchange(endpoint.now.altered, true)) {
      alter(endpoint.waiting.front().data, *fault);
    }
    const bool cut = fault && cuts(fault->kind);
    if (!move_out(endpoint, cut ? std::min(fault->bytes, length) : endpoint.waiting.front().data.size())) {
      return;  // the board is full
    }
    if (cut && fault->kind == Kind::unplug) {
      return retire_all();
    }
    endpoint.halted = cut && fault->kind == Kind::stall;
    finish(endpoint, cut ? error_of(fault->kind) : 0, std::min(endpoint.now.moved, length));
  }
}

/// False where the board has no room for all of it.
bool BoardEndpoints::move_out(Endpoint& endpoint, std::size_t most) {
  const Urb& urb = endpoint.waiting.front();
  while (endpoint.now.moved < most) {
    const std::size_t taken = board_.take(std::span(urb.data).subspan(endpoint.now.moved, most - endpoint.now.moved));
    if (taken == 0) {
      return false;
    }
    endpoint.now.moved += taken;
  }
  return true;
}

std::optional<std::vector<std::byte>> BoardEndpoints::next_message() {
  BoardStatus status = board_.status();
  const auto now = Clock::now();
  if (sent_ && same_news(status, *sent_) && now < sent_at_ + kMostSilence) {
    return std::nullopt;
  }
  status.sequence = ++messages_;
  sent_ = status;
  sent_at_ = now;
  const auto message = protocol::encode_status(status);
  return std::vector<std::byte>(message.begin(), message.end());
}

void BoardEndpoints::serve_status() {
  Endpoint& endpoint = endpoints_[kStatusEndpoint];
  while (!gone_ && !endpoint.waiting.empty()) {
    if (endpoint.halted) {
      finish(endpoint, -EPIPE, 0);
      continue;
    }
    const std::optional<UsbFault> fault = strike(endpoint);
    if (must_wait(endpoint)) {
      return;
    }
    if (fault && fault->kind == Kind::unplug) {
      return retire_all();
    }
    if (fault && error_of(fault->kind) != 0) {
      endpoint.halted = fault->kind == Kind::stall;
      finish(endpoint, error_of(fault->kind), 0);
      continue;
    }
    auto message = next_message();
    if (!message) {
      return;
    }
    if (fault && fault->kind == Kind::lose) {
      endpoint.now.fault.reset();
      continue;
    }
    if (fault && fault->kind == Kind::corrupt) {
      alter(*message, *fault);
    }
    if (fault && fault->kind == Kind::twice) {
      sent_.reset();  // the next transfer brings the same under the same number
      --messages_;
    }
    Urb& urb = endpoint.waiting.front();
    const bool cut = fault && fault->kind == Kind::cut_short;
    const std::size_t size = std::min(cut ? fault->bytes : message->size(), urb.length);
    urb.data.assign(message->begin(), message->begin() + static_cast<std::ptrdiff_t>(size));
    finish(endpoint, 0, size);
  }
}

void BoardEndpoints::serve_control() {
  Endpoint& endpoint = endpoints_[0];
  while (!gone_ && !endpoint.waiting.empty()) {
    const std::optional<UsbFault> fault = strike(endpoint);
    endpoint.stuck = fault && fault->kind == Kind::never;  // this one alone: each setup stage begins anew
    if (must_wait(endpoint)) {
      return;
    }
    if (fault && fault->kind == Kind::unplug) {
      return retire_all();
    }
    if (fault && error_of(fault->kind) != 0) {
      finish(endpoint, error_of(fault->kind), 0);
      continue;
    }
    Urb& urb = endpoint.waiting.front();
    const bool to_host = (urb.setup.request_type & 0x80U) != 0;
    auto data = answer_control(board_, texts_, messages_, urb.setup, urb.data);
    if (!data) {
      finish(endpoint, -EPIPE, 0);
      continue;
    }
    std::size_t size = to_host ? std::min(data.value().size(), urb.length) : urb.length;
    if (fault && fault->kind == Kind::cut_short) {
      size = std::min(size, fault->bytes);
    }
    if (to_host) {
      urb.data.assign(data.value().begin(), data.value().begin() + static_cast<std::ptrdiff_t>(size));
    }
    finish(endpoint, 0, size);
  }
}

}  // namespace gravure::test
