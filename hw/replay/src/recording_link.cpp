#include "gravure/replay/recording_link.hpp"

#include <cerrno>
#include <cstring>
#include <utility>

#include "gravure/core/crc32c.hpp"

namespace gravure::replay {
namespace {

/// The error into the exchange, or the value by way of `keep`.
template <class T>
void note(Exchange& exchange, const Result<T>& result, auto keep) {
  if (result) {
    keep();
  } else {
    exchange.error = result.error();
  }
}

Error io_error(const std::string& path, int reason) {
  return {ErrorCode::io, path + ": cannot record the session: " + std::strerror(reason)};
}

}  // namespace

RecordingLink::RecordingLink(std::unique_ptr<DeviceLink> link, std::string path, File file)
    : link_(std::move(link)), path_(std::move(path)), file_(std::move(file)) {
  write(head_text(link_->identity()));
}

Result<std::unique_ptr<RecordingLink>> RecordingLink::create(std::unique_ptr<DeviceLink> link,
                                                             const std::string& path) {
  File file(std::fopen(path.c_str(), "wxe"));
  if (!file) {
    return errno == EEXIST
               ? Error{ErrorCode::bad_argument,
                       path + ": is there already, and a recording is written over nothing: give a new name"}
               : io_error(path, errno);
  }
  return std::unique_ptr<RecordingLink>(new RecordingLink(std::move(link), path, std::move(file)));
}

/// Line by line: what was said last is what one wants to know of a host that is no more.
void RecordingLink::write(const std::string& text) {
  if (failed_ == 0 && (std::fputs(text.c_str(), file_.get()) < 0 || std::fflush(file_.get()) != 0)) {
    failed_ = errno;
  }
}

Result<void> RecordingLink::written() const {
  return failed_ == 0 ? Result<void>() : io_error(path_, failed_);
}

Result<std::uint32_t> RecordingLink::read_register(std::uint8_t address) {
  Exchange exchange{.request = Request::read, .address = address};
  auto result = link_->read_register(address);
  note(exchange, result, [&] { exchange.value = result.value(); });
  write(exchange_text(exchange));
  return result;
}

Result<void> RecordingLink::write_register(std::uint8_t address, std::uint32_t value) {
  Exchange exchange{.request = Request::write, .address = address, .value = value};
  auto result = link_->write_register(address, value);
  note(exchange, result, [] {});
  write(exchange_text(exchange));
  return result;
}

Result<std::size_t> RecordingLink::send(std::span<const std::byte> stream, Milliseconds patience) {
  Exchange exchange{
      .request = Request::send, .bytes = stream.size(), .checksum = ~crc32c_continue(kCrc32cStart, stream)};
  auto result = link_->send(stream, patience);
  note(exchange, result, [&] { exchange.taken = result.value(); });
  write(exchange_text(exchange));
  return result;
}

Result<bool> RecordingLink::drain(Milliseconds patience) {
  Exchange exchange{.request = Request::drain};
  auto result = link_->drain(patience);
  note(exchange, result, [&] { exchange.drained = result.value(); });
  write(exchange_text(exchange));
  return result;
}

Result<void> RecordingLink::abandon() {
  Exchange exchange{.request = Request::abandon};
  auto result = link_->abandon();
  note(exchange, result, [] {});
  write(exchange_text(exchange));
  return result;
}

Result<std::optional<BoardStatus>> RecordingLink::next_status(Milliseconds patience) {
  Exchange exchange{.request = Request::status};
  auto result = link_->next_status(patience);
  note(exchange, result, [&] { exchange.status = result.value(); });
  write(exchange_text(exchange));
  return result;
}

}  // namespace gravure::replay
