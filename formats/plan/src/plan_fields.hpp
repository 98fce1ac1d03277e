#pragma once

#include <optional>
#include <type_traits>

#include "gravure/core/plan.hpp"

namespace gravure::plan_json {

// The one list of what stands where. Archive is the writer or the reader; P is const Plan or Plan. Keys that others
// rely on come first in each section, in their documented order.

template <class Archive, class P>
void describe_clock(Archive& archive, P& clock) {
  archive.field("seed_hz", clock.seed_hz);
  archive.field("fpga_hz", clock.fpga_hz);
  archive.field("pulse_hz", clock.pulse_hz);
  archive.field("ticks_per_slot", clock.ticks_per_slot);
  archive.field("pulse_divider", clock.pulse_divider);
}

template <class Archive, class P>
void describe_line(Archive& archive, P& line) {
  archive.field("pixels", line.pixels);
  archive.field("slots", line.slots);
  archive.field("ticks", line.ticks);
  archive.field("rate_hz", line.rate_hz);
  archive.field("scan_speed_m_s", line.scan_speed_m_s);
  archive.section("marking_first_slot", [&] {
    archive.field("forward", line.forward_first_slot);
    archive.field("reverse", line.reverse_first_slot);
  });
  archive.field("slots_per_microvector", line.slots_per_microvector);
  archive.field("pixel_pitch_um", line.pixel_pitch_um);
  archive.field("bidirectional", line.bidirectional);
  archive.field("offset_slots", line.offset_slots);
  archive.field("offset_remainder_ticks", line.offset_remainder_ticks);
}

template <class Archive, class P>
void describe_rotary(Archive& archive, P& rotary) {
  archive.field("lines_per_revolution", rotary.lines_per_revolution);
  archive.field("line_pitch_um", rotary.line_pitch_um);
  archive.field("ticks_per_revolution", rotary.ticks_per_revolution);
  archive.field("rpm", rotary.rpm);
  archive.field("circumference_um", rotary.circumference_um);
  archive.field("surface_speed_mm_s", rotary.surface_speed_mm_s);
  archive.field("encoder_lines", rotary.encoder_lines);
  archive.field("interpolation_bits", rotary.interpolation_bits);
  archive.field("gear_encoder_turns", rotary.gear_encoder_turns);
  archive.field("gear_workpiece_turns", rotary.gear_workpiece_turns);
  archive.field("edges_per_revolution", rotary.edges_per_revolution);
}

/// The axis part of a flat plan: a pass is what a revolution is elsewhere.
template <class Archive, class P>
void describe_stage(Archive& archive, P& rotary) {
  archive.field("lines", rotary.lines_per_revolution);
  archive.field("line_pitch_um", rotary.line_pitch_um);
  archive.field("ticks_per_pass", rotary.ticks_per_revolution);
  archive.field("length_um", rotary.circumference_um);
  archive.field("speed_mm_s", rotary.surface_speed_mm_s);
  archive.field("encoder_pitch_um", rotary.encoder_pitch_um);
  archive.field("interpolation_bits", rotary.interpolation_bits);
  archive.field("edges_per_pass", rotary.edges_per_revolution);
}

template <class Archive, class P>
void describe_ab(Archive& archive, P& ab) {
  archive.field("prescaler", ab.prescaler);
  archive.field("increment", ab.increment);
  archive.section("fraction", [&] {
    archive.field("num", ab.fraction_num);
    archive.field("den", ab.fraction_den);
  });
  archive.field("output_hz", ab.output_hz);
  archive.field("wanted_hz", ab.wanted_hz);
  archive.field("exact", ab.exact);
  archive.exact_field("drift_lines_per_revolution", ab.drift_lines_per_revolution);
  archive.field("drift_um_per_revolution", ab.drift_um_per_revolution);
  archive.field("lines_until_limit", ab.lines_until_limit);
  archive.field("revolutions_until_limit", ab.revolutions_until_limit);
  archive.field("bound_lines_until_limit", ab.bound_lines_until_limit);
  archive.field("counter_bits", ab.counter_bits);
  archive.field("wanted_increment", ab.wanted_increment);
  archive.field("max_output_hz", ab.max_output_hz);
  archive.field("seam_limit_um", ab.seam_limit_um);
}

template <class Archive, class P>
void describe_ramp(Archive& archive, P& ramp, bool linear) {
  archive.field("segments", ramp.segments);
  archive.field("ticks", ramp.ticks);
  archive.field("counts", ramp.counts);
  archive.field(linear ? "travel_mm" : "travel_deg", ramp.travel);
  archive.field("duration_s", ramp.duration_s);
  archive.field(linear ? "max_acceleration_mm_s2" : "max_acceleration_deg_s2", ramp.max_acceleration);
  archive.field(linear ? "max_jerk_mm_s3" : "max_jerk_deg_s3", ramp.max_jerk);
  archive.field(linear ? "speed_error_mm_s" : "speed_error_deg_s", ramp.speed_error);
}

template <class Archive, class P>
void describe_spin(Archive& archive, P& spin, bool linear) {
  archive.section("up", [&] { describe_ramp(archive, spin.up, linear); });
  archive.section("down", [&] { describe_ramp(archive, spin.down, linear); });
  if (!linear) {
    archive.field("start_deg", spin.start_deg);
    archive.field("start_error_deg", spin.start_error_deg);
  }
  archive.field("total_s", spin.total_s);
}

template <class Archive, class P>
void describe_carriage(Archive& archive, P& carriage) {
  archive.field("feed_pixels", carriage.feed_pixels);
  archive.field("feed_um", carriage.feed_um);
  archive.field("layers", carriage.layers);
  archive.field("window_columns", carriage.window_columns);
  archive.field("revolutions", carriage.revolutions);
  archive.section("ab", [&] { describe_ab(archive, carriage.ab); });
  archive.field("columns", carriage.columns);
  archive.field("travel_mm", carriage.travel_mm);
  archive.field("speed_mm_s", carriage.speed_mm_s);
  archive.field("encoder_pitch_um", carriage.encoder_pitch_um);
  archive.field("interpolation_bits", carriage.interpolation_bits);
  archive.field("edges_per_revolution", carriage.edges_per_revolution);
  archive.optional_section("spin", carriage.spin, [&](auto& spin) { describe_spin(archive, spin, true); });
}

template <class Archive, class P>
void describe_bands(Archive& archive, P& bands) {
  archive.field("count", bands.count);
  archive.field("columns", bands.columns);
  archive.field("revolutions_per_band", bands.revolutions_per_band);
  archive.field("step_mm", bands.step_mm);
}

template <class Archive, class P>
void describe_scanner(Archive& archive, P& scanner) {
  archive.field("field_mm", scanner.field_mm);
  archive.field("resolution_bits", scanner.resolution_bits);
  archive.field("lag_us", scanner.lag_us);
  archive.field("compensate_lag", scanner.compensate_lag);
  archive.field("max_speed_mm_s", scanner.max_speed_mm_s);
  archive.field("max_acceleration_mm_s2", scanner.max_acceleration_mm_s2);
  archive.field("max_jerk_mm_s3", scanner.max_jerk_mm_s3);
  archive.field("cross_scan_correction", scanner.cross_scan_correction);
  archive.field("offset_deg", scanner.offset_deg);
  archive.field("tilt_deg_per_mm", scanner.tilt_deg_per_mm);
  archive.field("field_grid", scanner.field_grid);
}

template <class Archive, class P>
void describe_path_axis(Archive& archive, P& axis, bool linear) {
  archive.field(linear ? "counts_per_mm" : "counts_per_rad", axis.counts_per_unit);
  archive.field(linear ? "max_speed_mm_s" : "max_speed_deg_s", axis.limits.max_speed);
  archive.field(linear ? "max_acceleration_mm_s2" : "max_acceleration_deg_s2", axis.limits.max_acceleration);
  archive.field(linear ? "max_jerk_mm_s3" : "max_jerk_deg_s3", axis.limits.max_jerk);
  archive.field(linear ? "least_mm" : "least_deg", axis.least);
  archive.field(linear ? "most_mm" : "most_deg", axis.most);
}

/// `rotary` counts the lines, which here are the periods of the servo.
template <class Archive, class P, class R>
void describe_path(Archive& archive, P& path, R& rotary) {
  archive.field("periods", rotary.lines_per_revolution);
  archive.field("ticks", rotary.ticks_per_revolution);
  archive.field("pulses", path.pulses);
  archive.field("targets", path.targets);
  archive.field("along_counts_per_mm", path.along_counts_per_mm);
  archive.section("axes", [&] {
    for (std::size_t i = 0; i < kFocusAxis; ++i) {
      const bool linear = kPathAxes[i] != "A" && kPathAxes[i] != "C";
      archive.section(kPathAxes[i].data(), [&] { describe_path_axis(archive, path.axes[i], linear); });
    }
    auto focus = path.has_focus_axis() ? std::optional(path.axes[kFocusAxis]) : std::nullopt;
    archive.optional_section(kPathAxes[kFocusAxis].data(), focus,
                             [&](auto& axis) { describe_path_axis(archive, axis, true); });
    if constexpr (!std::is_const_v<P>) {
      path.axes.resize(kFocusAxis);
      if (focus) {
        path.axes.push_back(*focus);
      }
    }
  });
  archive.optional_section("picture", path.picture, [&](auto& picture) {
    archive.field("width", picture.width);
    archive.field("height", picture.height);
    archive.field("row_pitch_um", rotary.line_pitch_um);
  });
  archive.field("max_focus_offset_um", path.max_focus_offset_um);
  archive.field("max_incidence_deg", path.max_incidence_deg);
  archive.field("max_displacement_mm", path.max_displacement_mm);
  archive.field("max_landing_um", path.max_landing_um);
  archive.field("machine", path.machine);
  archive.section("rotary_centre", [&] {
    archive.field("x_mm", path.rotary_centre_mm[0]);
    archive.field("y_mm", path.rotary_centre_mm[1]);
    archive.field("z_mm", path.rotary_centre_mm[2]);
  });
  archive.field("surface", path.surface);
  archive.field("texture", path.texture);
}

template <class Archive, class P>
void describe_job(Archive& archive, P& job) {
  archive.field("revolutions", job.revolutions);
  archive.field("ticks", job.ticks);
  archive.field("duration_s", job.duration_s);
}

template <class Archive, class P>
void describe_plan(Archive& archive, P& plan) {
  archive.field("title", plan.title);
  archive.field("mode", plan.mode);
  archive.section("clock", [&] { describe_clock(archive, plan.clock); });
  archive.section("line", [&] { describe_line(archive, plan.line); });
  if (follows_path(plan.mode)) {
    archive.optional_section("path", plan.path, [&](auto& path) { describe_path(archive, path, plan.rotary); });
  } else {
    if (plan.mode == Mode::flat) {
      archive.section("stage", [&] { describe_stage(archive, plan.rotary); });
    } else {
      archive.section("rotary", [&] { describe_rotary(archive, plan.rotary); });
    }
    archive.section("ab", [&] { describe_ab(archive, plan.ab); });
  }
  archive.optional_section("spin", plan.spin,
                           [&](auto& spin) { describe_spin(archive, spin, plan.mode == Mode::flat); });
  archive.optional_section("carriage", plan.carriage, [&](auto& carriage) { describe_carriage(archive, carriage); });
  archive.optional_section("bands", plan.bands, [&](auto& bands) { describe_bands(archive, bands); });
  archive.optional_section("scanner", plan.scanner, [&](auto& scanner) { describe_scanner(archive, scanner); });
  archive.section("job", [&] { describe_job(archive, plan.job); });
  archive.field("warnings", plan.warnings);
}

}  // namespace gravure::plan_json
