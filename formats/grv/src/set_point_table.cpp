#include "set_point_table.hpp"

#include <array>
#include <string>

#include "hdf5_data.hpp"
#include "hdf5_session.hpp"

namespace gravure::grv {
namespace {

constexpr const char* kGroup = "microvectors";

std::int64_t per_line(const Plan& plan) {
  return plan.line.slots / plan.line.slots_per_microvector;
}

std::vector<std::int32_t> flat(const std::vector<LineSetPoints>& lines,
                               std::vector<std::int32_t> LineSetPoints::*counts) {
  std::vector<std::int32_t> all;
  for (const LineSetPoints& line : lines) {
    all.insert(all.end(), (line.*counts).begin(), (line.*counts).end());
  }
  return all;
}

}  // namespace

Result<void> write_set_points(hid_t file, const std::vector<LineSetPoints>& lines) {
  if (lines.empty()) {
    return {};
  }
  GRAVURE_TRY(const Handle group, create_group(file, kGroup));
  const std::array<hsize_t, 1> rows = {lines.size()};
  const std::array<hsize_t, 2> shape = {lines.size(), lines.front().u_counts.size()};
  std::vector<std::uint8_t> reverse;
  std::vector<std::uint8_t> backwards;
  for (const LineSetPoints& line : lines) {
    reverse.push_back(line.reverse ? 1 : 0);
    backwards.push_back(line.backwards ? 1 : 0);
  }
  constexpr const char* kUnit = "counts, 2^resolution_bits over field_mm, 0 at the centre";
  GRAVURE_CHECK(write_table<std::uint8_t>(group.get(), "reverse", reverse, rows, "1 yes, 0 no"));
  GRAVURE_CHECK(write_table<std::uint8_t>(group.get(), "backwards", backwards, rows, "1 yes, 0 no"));
  GRAVURE_CHECK(write_table<std::int32_t>(group.get(), "u_count", flat(lines, &LineSetPoints::u_counts), shape, kUnit));
  return write_table<std::int32_t>(group.get(), "v_count", flat(lines, &LineSetPoints::v_counts), shape, kUnit);
}

Result<std::vector<LineSetPoints>> read_set_points(hid_t file, const Plan& plan) {
  if (H5Lexists(file, kGroup, H5P_DEFAULT) <= 0) {
    return std::vector<LineSetPoints>();
  }
  const Handle group(H5Gopen2(file, kGroup, H5P_DEFAULT), H5Gclose);
  if (!group.valid() || !plan.scanner) {
    return Error{ErrorCode::bad_file,
                 group.valid() ? "microvectors: there, but the plan has no scanner" : "microvectors: is no group"};
  }
  std::vector<LineSetPoints> lines = kinds_of_lines(plan);
  const auto count = static_cast<std::size_t>(per_line(plan));
  const std::array<hsize_t, 1> rows = {lines.size()};
  const std::array<hsize_t, 2> shape = {lines.size(), count};
  GRAVURE_TRY(const auto reverse, read_table<std::uint8_t>(group.get(), "reverse", rows));
  GRAVURE_TRY(const auto backwards, read_table<std::uint8_t>(group.get(), "backwards", rows));
  GRAVURE_TRY(const auto u, read_table<std::int32_t>(group.get(), "u_count", shape));
  GRAVURE_TRY(const auto v, read_table<std::int32_t>(group.get(), "v_count", shape));
  for (std::size_t row = 0; row < lines.size(); ++row) {
    LineSetPoints& line = lines[row];
    if (reverse[row] != (line.reverse ? 1 : 0) || backwards[row] != (line.backwards ? 1 : 0)) {
      return Error{ErrorCode::bad_file, "microvectors: row " + std::to_string(row) + " says reverse " +
                                            std::to_string(reverse[row]) + ", backwards " +
                                            std::to_string(backwards[row]) + ": not the lines of the plan"};
    }
    const auto begin = static_cast<std::ptrdiff_t>(row * count);
    const auto end = begin + static_cast<std::ptrdiff_t>(count);
    line.u_counts.assign(u.begin() + begin, u.begin() + end);
    line.v_counts.assign(v.begin() + begin, v.begin() + end);
  }
  return lines;
}

Result<void> check_set_points(const std::vector<LineSetPoints>& lines, const Plan& plan, ErrorCode code) {
  if (lines.empty()) {
    return {};
  }
  const std::vector<LineSetPoints> kinds = kinds_of_lines(plan);
  if (!plan.scanner || lines.size() != kinds.size()) {
    return Error{code, "set-points for " + std::to_string(lines.size()) + " kinds of lines: must be " +
                           std::to_string(plan.scanner ? kinds.size() : 0)};
  }
  for (std::size_t row = 0; row < kinds.size(); ++row) {
    const LineSetPoints& line = lines[row];
    const auto count = static_cast<std::size_t>(per_line(plan));
    if (line.reverse != kinds[row].reverse || line.backwards != kinds[row].backwards || line.u_counts.size() != count ||
        line.v_counts.size() != count) {
      return Error{code, "set-points, row " + std::to_string(row) + ": not the plan's lines, or not " +
                             std::to_string(count) + " of them"};
    }
  }
  return {};
}

}  // namespace gravure::grv
