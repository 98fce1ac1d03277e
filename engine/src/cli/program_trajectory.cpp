#include "program_trajectory.hpp"

#include <cstdlib>

namespace gravure::cli {
namespace {

Result<void> check_counts(const std::string& path, const std::vector<std::int32_t>& stored,
                          const std::vector<std::int32_t>& planned) {
  for (std::size_t k = 0; k < stored.size(); ++k) {
    if (std::abs(std::int64_t{stored[k]} - planned[k]) > 1) {
      return Error{ErrorCode::bad_file, path + ": set-point " + std::to_string(k) + " is stored as " +
                                            std::to_string(stored[k]) + " counts, its plan gives " +
                                            std::to_string(planned[k]) + ": compile the job again"};
    }
  }
  return {};
}

}  // namespace

Result<ProgramTrajectory> open_trajectory(const std::string& path) {
  GRAVURE_TRY(std::unique_ptr<LineSource> program, open_grv(path));
  const ProgramHeader& header = program->header();
  if (!header.plan.scanner) {
    return Error{ErrorCode::bad_argument, path +
                                              ": its plan has no scanner: give scanner.field_mm in the job, or a "
                                              "machine file, and compile it again"};
  }
  GRAVURE_TRY(scan::JobTrajectory trajectory, scan::JobTrajectory::make(header.plan));
  const std::vector<LineSetPoints> planned = trajectory.stored_set_points();
  for (std::size_t row = 0; row < header.set_points.size(); ++row) {
    GRAVURE_CHECK(check_counts(path, header.set_points[row].u_counts, planned[row].u_counts));
    GRAVURE_CHECK(check_counts(path, header.set_points[row].v_counts, planned[row].v_counts));
  }
  return ProgramTrajectory{std::move(program), std::move(trajectory)};
}

Result<void> check_index(const char* option, std::int64_t value, std::int64_t count) {
  if (value < 0 || value >= count) {
    return Error{ErrorCode::out_of_range, std::string(option) + " " + std::to_string(value) +
                                              ": the program has 0 to " + std::to_string(count - 1)};
  }
  return {};
}

}  // namespace gravure::cli
