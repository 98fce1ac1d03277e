#include "zones/zones_input.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>

#include "gravure/core/file_output.hpp"
#include "gravure/formats/contours.hpp"
#include "gravure/formats/image_files.hpp"
#include "gravure/formats/machine_file.hpp"
#include "gravure/zones/plan_zones.hpp"
#include "verb.hpp"

namespace gravure::cli {
namespace {

constexpr std::size_t kMostTransformBytes = std::size_t{1} << 20U;

/// What `gravure register` says of a transform beside its numbers.
Result<void> check_registration(const Json& document, const std::string& path, const std::string& contours) {
  const auto is = [&document](const char* key, bool value) {
    return document.contains(key) && document[key].is_boolean() && document[key] == value;
  };
  if (document.contains("contours_out_sha256")) {
    GRAVURE_TRY(const std::string hash, sha256_file(contours));
    if (document["contours_out_sha256"] == hash) {
      return Error{ErrorCode::bad_argument,
                   fmt::format("{}: {} are the contours that this registration has laid on the scan already, and would "
                               "be moved twice: give the contours of the CAD, or leave the transform out",
                               path, contours)};
    }
  }
  for (const auto& [key, wrong] : {std::pair("converged", false), std::pair("degenerate", true),
                                   std::pair("scale_refused", true), std::pair("ambiguous", true)}) {
    if (is(key, wrong)) {
      warn(fmt::format("{}: \"{}\" is {}: the registration is not sure of this pose; check it before you mark", path,
                       key, wrong));
    }
  }
  return {};
}

/// The 4 x 4 numbers of "transform": a similarity.
Result<Eigen::Matrix4d> read_transform(const std::string& path, const std::string& contours) {
  GRAVURE_TRY(const std::string text, read_file(path, kMostTransformBytes));
  const auto refuse = [&path](const std::string& problem) {
    return Error{ErrorCode::bad_file,
                 path + ": " + problem + "; give transform as four rows of four numbers, the last 0, 0, 0, 1"};
  };
  int times = 0;
  const auto count = [&times](int depth, Json::parse_event_t event, const Json& parsed) {
    times += event == Json::parse_event_t::key && depth == 1 && parsed == "transform" ? 1 : 0;
    return true;
  };
  const Json document = Json::parse(text, count, false);
  if (times > 1) {
    return refuse("has \"transform\" " + std::to_string(times) + " times");
  }
  if (!document.is_object() || !document.contains("transform") || !document["transform"].is_array() ||
      document["transform"].size() != 4) {
    return refuse("has no \"transform\" of four rows");
  }
  GRAVURE_CHECK(check_registration(document, path, contours));
  Eigen::Matrix4d matrix;
  for (int row = 0; row < 4; ++row) {
    const Json& numbers = document["transform"][static_cast<std::size_t>(row)];
    for (int column = 0; column < 4; ++column) {
      if (!numbers.is_array() || numbers.size() != 4 || !numbers[static_cast<std::size_t>(column)].is_number()) {
        return refuse(fmt::format("transform, row {}: must be four numbers", row));
      }
      matrix(row, column) = numbers[static_cast<std::size_t>(column)].get<double>();
    }
  }
  constexpr double kRounding = 1e-6;
  const Eigen::Matrix3d linear = matrix.topLeftCorner<3, 3>();
  const double scale = std::cbrt(linear.determinant());
  const bool is_similarity =
      matrix.allFinite() && scale > 0 && matrix.row(3).isApprox(Eigen::RowVector4d(0, 0, 0, 1)) &&
      (linear.transpose() * linear / (scale * scale) - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < kRounding;
  if (!is_similarity) {
    return refuse("transform: must turn, shift and scale, and nothing else");
  }
  return matrix;
}

void apply(const Eigen::Matrix4d& transform, Contour& contour) {
  const auto store = [](const Eigen::Vector3d& from, std::array<double, 3>& to) {
    to = {from.x(), from.y(), from.z()};
  };
  const Eigen::Matrix3d linear = transform.topLeftCorner<3, 3>();
  const Eigen::Vector3d shift = transform.topRightCorner<3, 1>();
  for (auto& point : contour.points_mm) {
    store(linear * Eigen::Vector3d(point[0], point[1], point[2]) + shift, point);
  }
  const auto& d = contour.direction;
  store((linear * Eigen::Vector3d(d[0], d[1], d[2])).normalized(), contour.direction);
}

}  // namespace

Result<std::vector<Contour>> load_contours(const std::string& path) {
  GRAVURE_TRY(formats::ContourFile file, formats::read_contours(path));
  for (const std::string& note : file.notes) {
    warn(path + ": " + note);
  }
  return std::move(file.contours);
}

Result<void> move_contours(const std::string& transform, const std::string& file, std::vector<Contour>& contours) {
  GRAVURE_TRY(const Eigen::Matrix4d matrix, read_transform(transform, file));
  for (Contour& contour : contours) {
    apply(matrix, contour);
  }
  return {};
}

Result<kinematics::Machine> load_zones_machine(const std::string& path, std::optional<double> field_mm) {
  kinematics::Machine machine = zones::example_machine();
  if (!path.empty()) {
    GRAVURE_TRY(machine, read_machine(path));
  }
  machine.head.field_mm = field_mm.value_or(machine.head.field_mm);
  return machine;
}

}  // namespace gravure::cli
