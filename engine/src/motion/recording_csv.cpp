#include "gravure/core/csv_rows.hpp"
#include "gravure/motion/identify.hpp"
#include "gravure/motion/ruled_blade.hpp"

namespace gravure::motion {

Result<Recording> parse_recording_csv(std::string_view text) {
  Recording recording;
  GRAVURE_CHECK(read_csv_rows(text, {"recording", "time in s and acceleration in mm/s^2, two numbers and no more", 2},
                              [&recording](std::span<const double> row) {
                                recording.time_s.push_back(row[0]);
                                recording.acceleration_mm_s2.push_back(row[1]);
                              }));
  return recording;
}

Result<std::vector<Vector3>> parse_points_csv(std::string_view text) {
  std::vector<Vector3> points;
  GRAVURE_CHECK(read_csv_rows(text, {"points", "x, y and z in mm, three numbers and no more", 3},
                              [&points](std::span<const double> row) {
                                points.push_back({row[0], row[1], row[2]});
                              }));
  if (points.empty()) {
    return Error{ErrorCode::bad_file, "points: there is none; give one a line, x, y and z in mm"};
  }
  return points;
}

}  // namespace gravure::motion
