#pragma once

#include <cstdint>
#include <vector>

#include "gravure/core/line_device.hpp"
#include "gravure/core/plan.hpp"

namespace gravure {

/// Lines that the board puts out without a break. Its A-B counters are loaded before a run and begin at 0; where the
/// plan has ramps, the axes come from rest before its first line and go back to rest after its last. What the machine
/// does between two runs (the stage along the axis goes to another band) is not timed by the board.
struct BoardRun {
  std::int64_t first_revolution = 0;  ///< of the job; flat: pass
  std::int64_t revolutions = 0;
  bool backward = false;        ///< flat, odd passes: axis 0 steps backwards, pins A and B of it exchanged
  std::int64_t band = 0;        ///< 0 where the image fits the field
  Rational axial_mm = 0;        ///< where the stage along the axis stands, from the place of band 0
  std::int64_t first_tick = 0;  ///< of its first line, in the ticks of the job, which count marking alone
  std::int64_t ticks = 0;       ///< of its lines

  std::int64_t end_revolution() const noexcept { return first_revolution + revolutions; }
};

/// Rotary: one for each band, with all its revolutions; helical: one; flat: one for each pass. In order of time.
std::vector<BoardRun> runs_of(const Plan& plan);

/// The run that has a revolution of the job.
BoardRun run_with(const Plan& plan, std::int64_t revolution);

/// Registers and schedules of the run that has line `line` of revolution `revolution`, starting there.
DeviceSetup device_setup(const Plan& plan, std::int64_t revolution, std::int64_t line);

}  // namespace gravure
