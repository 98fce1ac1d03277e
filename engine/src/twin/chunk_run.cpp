#include "chunk_run.hpp"

#include <string>

namespace gravure {

ChunkRun::ChunkRun(LineSource& program, const DeviceFactory& devices, const CancelToken* cancel)
    : program_(program), cancel_(cancel), watcher_(program.header().plan), device_(devices(watcher_)) {}

Result<std::span<const std::byte>> ChunkRun::run(std::int64_t revolution, std::int64_t chunk, bool invert) {
  if (cancel_ != nullptr && cancel_->cancelled()) {
    return Error{ErrorCode::cancelled, "stopped before the picture was complete; nothing was written"};
  }
  const ProgramHeader& header = program_.header();
  const Plan& plan = header.plan;
  GRAVURE_CHECK(chunk_.load(program_, {header.layer_of_revolution.at(static_cast<std::size_t>(revolution)), chunk}));
  watcher_.landing.start(chunk_.lines());
  GRAVURE_CHECK(device_->configure(device_setup(plan, revolution, chunk_.first_line())));
  GRAVURE_CHECK(chunk_.send(header, revolution, *device_));
  if (watcher_.misplaced || watcher_.landing.lines() != chunk_.lines()) {
    return Error{ErrorCode::device, "revolution " + std::to_string(revolution) + ", lines from " +
                                        std::to_string(chunk_.first_line()) +
                                        ": the device marked outside the window the plan gives"};
  }
  return watcher_.landing.turn_back(chunk_.first_line(), line_is_reverse(plan, revolution, 0), invert);
}

}  // namespace gravure
