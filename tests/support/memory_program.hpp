#pragma once

#include <algorithm>
#include <atomic>
#include <bit>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "gravure/core/program.hpp"

namespace gravure::test {

/// A program that lies in memory: what a sink has taken and a source gives back.
struct MemoryProgram {
  ProgramHeader header;
  std::int64_t lines_per_chunk = 1;
  std::map<std::pair<std::int64_t, std::int64_t>, StoredChunk> chunks;
  std::vector<std::pair<std::int64_t, std::int64_t>> order;  ///< of put()
  int finished = 0;

  /// A line of a layer as it is stored, in time order.
  std::vector<std::byte> line(std::int64_t layer, std::int64_t number) const {
    const StoredChunk& chunk = chunks.at({layer, number / lines_per_chunk});
    const std::int64_t bytes = header.line_bytes();
    const auto first = chunk.bytes.begin() + number % lines_per_chunk * bytes;
    return {first, first + bytes};
  }
};

class MemorySink final : public LineSink {
 public:
  explicit MemorySink(MemoryProgram& program) : program_(program) {}
  std::optional<std::int64_t> fail_at_put;     ///< this put() fails with io
  std::optional<std::int64_t> fail_at_encode;  ///< so does this encode(), counted over all threads
  bool keep = true;                            ///< false: only count the bytes, hold none
  std::int64_t bytes_put = 0;
  bool put_at_once_by_two = false;

  std::int64_t lines_per_chunk() const noexcept override { return program_.lines_per_chunk; }

  Result<StoredChunk> encode(ChunkAddress address, std::span<const std::byte> lines) const override {
    if (encoded_++ == fail_at_encode.value_or(-1)) {
      return Error{ErrorCode::io, "the packer fails here"};
    }
    StoredChunk chunk;
    chunk.address = address;
    chunk.bytes.assign(lines.begin(), lines.end());
    for (const std::byte byte : lines) {
      chunk.fired_pixels += std::popcount(std::to_integer<unsigned>(byte));
    }
    return chunk;
  }
  Result<void> put(const StoredChunk& chunk) override {
    put_at_once_by_two = inside_.exchange(true) || put_at_once_by_two;
    const bool fails = puts_++ == fail_at_put.value_or(-1);
    if (!fails) {
      program_.order.emplace_back(chunk.address.layer, chunk.address.chunk);
      bytes_put += static_cast<std::int64_t>(chunk.bytes.size());
      if (keep) {
        program_.chunks[program_.order.back()] = chunk;
      }
    }
    inside_ = false;
    return fails ? Result<void>(Error{ErrorCode::io, "the disk is full here"}) : Result<void>();
  }
  Result<void> finish(const ProgramHeader& header) override {
    program_.header = header;
    ++program_.finished;
    return {};
  }

 private:
  MemoryProgram& program_;
  mutable std::atomic<std::int64_t> encoded_{0};
  std::int64_t puts_ = 0;
  std::atomic<bool> inside_{false};
};

/// Gives the program back, damaged on the way if asked.
class MemorySource final : public LineSource {
 public:
  using Damage = std::function<void(ChunkAddress, std::span<std::byte>)>;
  explicit MemorySource(const MemoryProgram& program, Damage damage = {})
      : program_(program), damage_(std::move(damage)) {}
  const ProgramHeader& header() const noexcept override { return program_.header; }
  std::int64_t lines_per_chunk() const noexcept override { return program_.lines_per_chunk; }
  Result<StoredChunk> fetch(ChunkAddress address) override {
    const auto found = program_.chunks.find({address.layer, address.chunk});
    if (found == program_.chunks.end()) {
      return Error{ErrorCode::bad_file, "layer " + std::to_string(address.layer) + ", chunk " +
                                            std::to_string(address.chunk) + " is missing"};
    }
    return found->second;
  }
  Result<void> decode(const StoredChunk& chunk, std::span<std::byte> out) const override {
    if (chunk.bytes.size() != out.size()) {
      return Error{ErrorCode::bad_file, "a chunk of another size"};
    }
    std::copy(chunk.bytes.begin(), chunk.bytes.end(), out.begin());
    if (damage_) {
      damage_(chunk.address, out);
    }
    return {};
  }

 private:
  const MemoryProgram& program_;
  Damage damage_;
};

}  // namespace gravure::test
