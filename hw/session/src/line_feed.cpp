#include "line_feed.hpp"

#include <algorithm>
#include <new>
#include <utility>

#include "gravure/twin/exposure.hpp"

namespace gravure::session {

LineFeed::LineFeed(LineSource& program, std::int64_t first, std::int64_t end, std::int64_t memory_bytes)
    : program_(program),
      first_(first),
      end_(end),
      most_bytes_(static_cast<std::size_t>(
          std::max(memory_bytes, 2 * program.lines_per_chunk() * program.header().line_bytes()))),
      reader_([this] { read_ahead(); }) {}

LineFeed::~LineFeed() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  room_.notify_all();
  reader_.join();
}

void LineFeed::read_ahead() {
  Result<void> read;
  try {
    read = read_blocks();
  } catch (const std::bad_alloc&) {
    read = Error{ErrorCode::io, "out of memory while reading the program ahead: lower --memory"};
  }
  const std::lock_guard lock(mutex_);
  if (!read) {
    error_ = read.error();
  }
}

Result<void> LineFeed::read_blocks() {
  const ProgramHeader& header = program_.header();
  const std::int64_t per_revolution = header.plan.rotary.lines_per_revolution;
  const std::int64_t bytes = header.line_bytes();
  ProgramChunk chunk;
  for (std::int64_t line = first_; line < end_;) {
    const std::int64_t revolution = line / per_revolution;
    const std::int64_t within = line % per_revolution;
    const std::int64_t layer = header.layer_of_revolution[static_cast<std::size_t>(revolution)];
    GRAVURE_CHECK(chunk.load(program_, {layer, within / program_.lines_per_chunk()}));
    const std::int64_t skipped = within - chunk.first_line();
    const std::int64_t lines = std::min(chunk.lines() - skipped, end_ - line);
    const std::span<const std::byte> bits =
        chunk.lines_for(header, revolution)
            .subspan(static_cast<std::size_t>(skipped * bytes), static_cast<std::size_t>(lines * bytes));
    if (!put({line, lines, {bits.begin(), bits.end()}})) {
      return {};
    }
    line += lines;
  }
  return {};
}

/// False: nobody wants more.
bool LineFeed::put(Block block) {
  std::unique_lock lock(mutex_);
  room_.wait(lock, [&] { return stop_ || ahead_.empty() || ahead_bytes_ + block.bits.size() <= most_bytes_; });
  if (stop_) {
    return false;
  }
  ahead_bytes_ += block.bits.size();
  ahead_.push_back(std::move(block));
  return true;
}

Result<std::optional<FeedLine>> LineFeed::next() {
  if (!current_ || at_ == current_->lines) {
    current_.reset();
    const std::lock_guard lock(mutex_);
    if (ahead_.empty()) {
      return error_ ? Result<std::optional<FeedLine>>(*error_) : std::optional<FeedLine>();
    }
    current_ = std::move(ahead_.front());
    ahead_.pop_front();
    ahead_bytes_ -= current_->bits.size();
    at_ = 0;
    room_.notify_all();
  }
  const ProgramHeader& header = program_.header();
  const auto bytes = static_cast<std::size_t>(header.line_bytes());
  const std::int64_t line = current_->first + at_;
  FeedLine next;
  next.revolution = line / header.plan.rotary.lines_per_revolution;
  next.line = line % header.plan.rotary.lines_per_revolution;
  const bool reverse = line_is_reverse(header.plan, next.revolution, next.line);
  next.first_slot = reverse ? header.plan.line.reverse_first_slot : header.plan.line.forward_first_slot;
  next.backward = (line & 1) != 0;
  next.bits = std::span(current_->bits).subspan(static_cast<std::size_t>(at_) * bytes, bytes);
  ++at_;
  return std::optional(next);
}

}  // namespace gravure::session
