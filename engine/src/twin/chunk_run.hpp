#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "gravure/core/progress.hpp"
#include "gravure/twin/exposure.hpp"

namespace gravure {

/// Runs chunks of a program on a device of its own, and gives what landed.
class ChunkRun {
 public:
  ChunkRun(LineSource& program, const DeviceFactory& devices, const CancelToken* cancel);
  /// The lines of a chunk of a revolution as the images have them, left to right, a one fired (or, with `invert`, did
  /// not); valid until the next run. device where something was marked outside the window the plan gives.
  Result<std::span<const std::byte>> run(std::int64_t revolution, std::int64_t chunk, bool invert);
  std::int64_t first_line() const noexcept { return chunk_.first_line(); }
  std::int64_t lines() const noexcept { return chunk_.lines(); }

 private:
  class Watcher final : public PinObserver {
   public:
    explicit Watcher(const Plan& plan) : landing(plan) {}
    void on_line(const ExecutedLine& line) override { misplaced = !landing.take(line) || misplaced; }
    Landing landing;
    bool misplaced = false;
  };

  LineSource& program_;
  const CancelToken* cancel_;
  Watcher watcher_;
  std::unique_ptr<LineDevice> device_;
  ProgramChunk chunk_;
};

}  // namespace gravure
