#pragma once

#include "gravure/sync/make_plan.hpp"

namespace gravure::scan::test {

/// A job of the mode whose scanner is described: 82 MHz, every 41st pulse, 2 MHz slots, 8 um pixels; lines of 8 um on a
/// tube or panel 1.6 mm round or long; turns of 1800 slots.
inline Job scanner_job(Mode mode) {
  Job job;
  job.mode = mode;
  job.laser = {82'000'000, 41, 16'400'000};
  job.fpga = {2, 32, true};
  job.scanner.pixel_pitch_um = 8;
  job.scanner.slots_per_microvector = 20;
  job.scanner.turn_slots = 1800;
  job.scanner.field_mm = 40;
  job.scanner.max_speed_mm_s = 40'000;
  job.scanner.max_acceleration_mm_s2 = 40'000'000;
  job.scanner.max_jerk_mm_s3 = Integer(4'000'000'000'000);
  job.rotary.circumference_mm = ratio(16, 10);
  job.rotary.lines_per_revolution = 200;
  job.rotary.encoder_lines = 5000;
  job.rotary.interpolation_bits = 5;
  job.rotary.max_ab_hz = 20'000'000;
  job.stage.lines = 200;
  job.stage.line_pitch_um = 8;
  job.stage.encoder_pitch_um = 20;
  job.stage.interpolation_bits = 8;
  job.stage.max_ab_hz = 20'000'000;
  job.carriage.feed_pixels = ratio(333, 10);
  job.carriage.layers = 3;
  job.carriage.encoder_pitch_um = 20;
  job.carriage.interpolation_bits = 8;
  job.carriage.max_ab_hz = 20'000'000;
  job.limits.seam_um = 1;
  return job;
}

/// Two revolutions (passes), or as many layers as the carriage has, of images 150 columns wide.
inline Plan scanner_plan(const Job& job) {
  return make_plan(job, 150, job.mode == Mode::helical ? job.carriage.layers : 2).value();
}

}  // namespace gravure::scan::test
