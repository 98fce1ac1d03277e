#pragma once

#include <string>

namespace gravure::test {

/// Every key of the format once.
inline std::string sample_machine() {
  return R"([machine]
title = "two joints"
joints = ["x", "c"]

[x]
kind = "prismatic"
carries = "tool"
axis = [2, 0, 0]
origin_mm = [1.5, 0, 0]
least_mm = -5
most_mm = 505.25
max_speed_mm_s = 300
max_acceleration_mm_s2 = 2_000
max_jerk_mm_s3 = 1e5

[c]
kind = "revolute"
carries = "workpiece"
axis = [1, 0, 0]
origin_mm = [0, 0.25, -3]
least_deg = -90
most_deg = 36_000
max_speed_deg_s = 720
max_acceleration_deg_s2 = 3600
max_jerk_deg_s3 = 36_000

[head]
lens = "f_theta"
tilt_deg_per_mm = 0.36
field_mm = 28.5
resolution_bits = 18
lag_us = 12.3
max_speed_mm_s = 40_000
max_acceleration_mm_s2 = 4e7
max_jerk_mm_s3 = 4e12
origin_mm = [0, 0, 35]
u_axis = [1, 0, 0]
v_axis = [0, -1, 0]
beam_axis = [0, 0, 1]
)";
}

}  // namespace gravure::test
