#include "ordered_writer.hpp"

#include <utility>

namespace gravure {

void OrderedWriter::keep(Error error) {
  if (!error_) {
    error_ = std::move(error);
    failed_ = true;
  }
  turn_.notify_all();
}

void OrderedWriter::write(const StoredChunk& chunk) {
  if (error_) {
    return;
  }
  if (Result<void> written = sink_.put(chunk); !written) {
    keep(written.error());
  }
}

/// Moves on over every ticket that is complete, and writes what the next one has left here.
void OrderedWriter::advance() {
  ++current_;
  for (auto next = waiting_.find(current_); next != waiting_.end(); next = waiting_.find(current_)) {
    for (const StoredChunk& chunk : next->second.chunks) {
      waiting_bytes_ -= static_cast<std::int64_t>(chunk.bytes.size());
      write(chunk);
    }
    const bool closed = next->second.closed;
    waiting_.erase(next);
    if (!closed) {
      break;
    }
    ++current_;
  }
  turn_.notify_all();
}

bool OrderedWriter::put(std::int64_t ticket, StoredChunk chunk) {
  std::unique_lock lock(mutex_);
  const auto bytes = static_cast<std::int64_t>(chunk.bytes.size());
  turn_.wait(lock, [&] { return error_ || ticket == current_ || waiting_bytes_ + bytes <= ahead_bytes_; });
  if (error_) {
    return false;
  }
  if (ticket == current_) {
    write(chunk);
    return !error_;
  }
  waiting_bytes_ += bytes;
  waiting_[ticket].chunks.push_back(std::move(chunk));
  return true;
}

bool OrderedWriter::close(std::int64_t ticket) {
  const std::lock_guard lock(mutex_);
  if (ticket == current_) {
    advance();
  } else {
    waiting_[ticket].closed = true;
  }
  return !error_;
}

void OrderedWriter::fail(Error error) {
  const std::lock_guard lock(mutex_);
  keep(std::move(error));
}

std::optional<Error> OrderedWriter::error() const {
  const std::lock_guard lock(mutex_);
  return error_;
}

}  // namespace gravure
