#include "zones/zones_job_loader.hpp"

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <utility>

#include "gravure/core/path_motion.hpp"
#include "gravure/kinematics/machines.hpp"
#include "placed_error.hpp"
#include "texture/texture_options.hpp"
#include "zones/zones_input.hpp"

namespace gravure::cli {
namespace {

using kinematics::Machine;
using kinematics::XyzacSigns;

/// Do both put the light in the same place, whatever the axes do?
bool are_alike(const Machine& machine, const std::array<std::size_t, 5>& joint_of, const Machine& known) {
  constexpr double kSame = 1e-9;  // mm, and of a unit vector
  for (int pose = 0; pose < 8; ++pose) {
    std::array<double, 5> axes{};
    kinematics::JointPositions joints(machine.joints.size());
    for (std::size_t axis = 0; axis < axes.size(); ++axis) {
      axes[axis] = pose == 0 ? 0 : static_cast<double>(pose) * 0.37 - 0.61 * static_cast<double>(axis);
      joints[joint_of[axis]] = axes[axis];
    }
    const kinematics::FieldPoint field{1.5 - pose, 0.5 * pose, 0.3};
    const kinematics::Spot one = kinematics::forward(machine, joints, field);
    const kinematics::Spot other = kinematics::forward(known, axes, field);
    if ((one.position_mm - other.position_mm).norm() > kSame ||
        (one.towards_head - other.towards_head).norm() > kSame) {
      return false;
    }
  }
  return true;
}

/// By which signs a program names the machine; the twin builds it again from them and from where A and C meet.
Result<std::string> signs_of(const Machine& machine) {
  std::array<std::size_t, 5> joint_of{};
  for (std::size_t axis = 0; axis < joint_of.size(); ++axis) {
    GRAVURE_TRY(joint_of[axis], kinematics::find_joint(machine, kPathAxes[axis]));
  }
  for (const auto& [signs, name] :
       {std::pair(XyzacSigns::texturing, "texturing"), std::pair(XyzacSigns::post_processor, "post_processor")}) {
    if (are_alike(machine, joint_of, kinematics::xyzac_machine(signs, machine.head.origin_mm, {}))) {
      return std::string(name);
    }
  }
  return Error{ErrorCode::bad_argument,
               "machine: a program of zones needs X, Y and Z under a telecentric head, C on A, which meet at "
               "[head] origin_mm, with the signs of one of the machines in docs/kinematics.md"};
}

Result<ZonesOptics> optics_of(const ZonesJob& job) {
  const ZonesBeam& beam = *job.beam;
  const double pulses_per_s =
      static_cast<double>(job.job.laser.seed_hz) / static_cast<double>(job.job.laser.pulse_divider);
  // Without a power the fluence is not asked for; the spot does not depend on it.
  const double power_w = beam.average_power_w ? to_double(*beam.average_power_w) : 1;
  ZonesOptics optics;
  GRAVURE_TRY(optics.spot,
              zones::focus({to_double(beam.wavelength_um), to_double(beam.m_squared), to_double(beam.diameter_mm),
                            to_double(beam.focal_length_mm), power_w, pulses_per_s}));
  if (beam.threshold_j_cm2) {
    const double threshold = to_double(*beam.threshold_j_cm2);
    optics.over_threshold = optics.spot.peak_fluence_j_cm2 / threshold;
    const double incidence_rad = to_double(job.max_incidence_deg) / kDegreesPerRad;
    if (!zones::ablated_ellipse(optics.spot, optics.over_threshold, incidence_rad)) {
      return Error{
          ErrorCode::out_of_range,
          fmt::format("[beam] threshold_j_cm2 = {:.6g}: pulses reach {:.6g} J/cm^2 and ablate nothing at {:.6g} "
                      "degrees of incidence: give more average_power_w, or focus more",
                      threshold, optics.spot.peak_fluence_j_cm2, to_double(job.max_incidence_deg))};
    }
  }
  return optics;
}

/// Pulses come at most one a slot.
Result<void> check_speed(const ZonesJob& job) {
  constexpr int kUmInMm = 1000;
  const Rational most =
      job.pulse_pitch_um * ratio(job.job.laser.seed_hz, job.job.laser.pulse_divider) / Rational(kUmInMm);
  if (job.mark_speed_mm_s > most) {
    return Error{
        ErrorCode::out_of_range,
        fmt::format("[marking] mark_speed_mm_s = {}: {} um apart, pulses of seed_hz / pulse_divider reach "
                    "{:.6g} mm/s at most: lower it, or raise pulse_pitch_um",
                    to_decimal_string(job.mark_speed_mm_s), to_decimal_string(job.pulse_pitch_um), to_double(most))};
  }
  return {};
}

Result<std::vector<Contour>> load_placed_contours(const ZonesJob& job, const ZonesFiles& files) {
  GRAVURE_TRY(std::vector<Contour> contours, placed(job.job, "contours.file", load_contours(files.contours)));
  if (!files.transform.empty()) {
    GRAVURE_CHECK(placed(job.job, "contours.transform", move_contours(files.transform, files.contours, contours)));
  }
  return contours;
}

}  // namespace

Result<LoadedZonesJob> load_zones_job(const std::string& path) {
  GRAVURE_TRY(ZonesJob job, read_zones_job(path));
  const auto beside = [&](const std::string& file) {
    return file.empty() ? file : (std::filesystem::path(path).parent_path() / file).string();
  };
  ZonesFiles files{beside(job.contours), beside(job.transform), beside(job.machine)};
  return load_zones_job(std::move(job), std::move(files));
}

Result<LoadedZonesJob> load_zones_job(ZonesJob given, ZonesFiles files) {
  LoadedZonesJob loaded;
  loaded.job = std::move(given);
  loaded.files = std::move(files);
  const ZonesJob& job = loaded.job;
  GRAVURE_CHECK(placed(job.job, "marking.mark_speed_mm_s", check_speed(job)));
  zones::ZonePlanRequest& request = loaded.request;
  GRAVURE_TRY(request.contours, load_placed_contours(job, loaded.files));
  const std::optional<double> field_mm = job.field_mm ? std::optional(to_double(*job.field_mm)) : std::nullopt;
  GRAVURE_TRY(request.machine, placed(job.job, "machine.file", load_zones_machine(loaded.files.machine, field_mm)));
  GRAVURE_TRY(loaded.machine, placed(job.job, "machine.file", signs_of(request.machine)));
  request.method = job.by_kmeans ? zones::Method::kmeans : zones::Method::cover;
  request.kmeans = {job.clusters, job.normalised, job.seed};
  request.max_incidence_rad = to_double(job.max_incidence_deg) / kDegreesPerRad;
  if (job.beam) {
    GRAVURE_TRY(loaded.optics, placed(job.job, "beam.threshold_j_cm2", optics_of(job)));
  }
  if (job.layer_mm) {
    request.max_layer_mm = to_double(*job.layer_mm);
  } else {
    GRAVURE_TRY(const double range_mm,
                placed(job.job, "beam.fluence_share",
                       zones::processing_range_mm(loaded.optics->spot, to_double(*job.beam->fluence_share))));
    request.max_layer_mm = 2 * range_mm;
  }
  return loaded;
}

}  // namespace gravure::cli
