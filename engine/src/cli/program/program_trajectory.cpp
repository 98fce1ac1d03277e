#include "program/program_trajectory.hpp"

namespace gravure::cli {

Result<ProgramTrajectory> open_trajectory(const std::string& path) {
  GRAVURE_TRY(std::unique_ptr<LineSource> program, open_grv(path));
  const ProgramHeader& header = program->header();
  if (header.plan.path) {
    return Error{ErrorCode::bad_argument,
                 path + ": follows a path: `export --nc` writes its axes and the frames of its galvo"};
  }
  if (!header.plan.scanner) {
    return Error{ErrorCode::bad_argument, path +
                                              ": its plan has no scanner: give scanner.field_mm in the job, or a "
                                              "machine file, and compile it again"};
  }
  GRAVURE_TRY(scan::JobTrajectory trajectory, scan::JobTrajectory::make(header.plan));
  if (const Result<void> checked = trajectory.check_stored(header.set_points); !checked) {
    return Error{checked.error().code, path + ": " + checked.error().message};
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
