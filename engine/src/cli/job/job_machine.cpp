#include "job/job_machine.hpp"

#include <Eigen/Geometry>
#include <filesystem>
#include <string>

#include "gravure/core/file_output.hpp"
#include "gravure/scan/joint_reach.hpp"

namespace gravure::cli {
namespace {

using kinematics::Joint;
using kinematics::JointKind;

/// Takes values over from the machine file; what the job gives as well becomes a line of the error.
class Filling {
 public:
  Filling(const MachineFile& file, const Job& job) : file_(file), job_(job) {}

  /// The number of the machine file, where it gives one.
  const Rational* number(const std::string& place, const std::string& job_key) {
    const auto at = file_.numbers.find(place);
    if (at == file_.numbers.end()) {
      return nullptr;
    }
    refuse_twice(job_key, place);
    return &at->second;
  }
  void refuse_twice(const std::string& job_key, const std::string& place) {
    if (job_.places.count(job_key) != 0) {
      complain(job_.place_of(job_key) + job_key + ": the machine file gives " + place +
               "; take one of the two out, so that one place says it");
    }
  }
  /// Of the file as a whole.
  void refuse_file(const std::string& why) { complain(job_.place_of("machine.file") + "machine.file: " + why); }
  Result<void> result() const { return text_.empty() ? Result<void>() : Error{ErrorCode::bad_argument, text_}; }

 private:
  void complain(const std::string& text) { text_ += (text_.empty() ? "" : "\n") + text; }

  const MachineFile& file_;
  const Job& job_;
  std::string text_;
};

void fill(Filling& filling, const std::string& key, Rational& setting) {
  if (const Rational* number = filling.number("head." + key, "scanner." + key)) {
    setting = *number;
  }
}

void fill(Filling& filling, const std::string& key, std::optional<Rational>& setting) {
  if (const Rational* number = filling.number("head." + key, "scanner." + key)) {
    setting = *number;
  }
}

void fill_head(const MachineFile& file, Filling& filling, ScannerSettings& scanner) {
  fill(filling, "field_mm", scanner.field_mm);
  fill(filling, "lag_us", scanner.lag_us);
  fill(filling, "max_speed_mm_s", scanner.max_speed_mm_s);
  fill(filling, "max_acceleration_mm_s2", scanner.max_acceleration_mm_s2);
  fill(filling, "max_jerk_mm_s3", scanner.max_jerk_mm_s3);
  if (filling.number("head.resolution_bits", "scanner.resolution_bits") != nullptr) {
    scanner.resolution_bits = file.machine.head.resolution_bits;
  }
  if (file.machine.head.lens == kinematics::Lens::telecentric) {
    filling.refuse_twice("scanner.tilt_deg_per_mm", "head.lens = \"telecentric\"");
    scanner.tilt_deg_per_mm = 0;
  } else {
    fill(filling, "tilt_deg_per_mm", scanner.tilt_deg_per_mm);
  }
}

/// The one joint of this kind along a direction; none where there is none.
const Joint* axis_of(const MachineFile& file, JointKind kind, const kinematics::Vector3& along,
                     const std::string& section, Filling& filling) {
  const auto found = scan::joint_along(file.machine, kind, along, "[" + section + "]");
  if (!found) {
    filling.refuse_file(found.error().message);
  }
  return found && found.value() ? &file.machine.joints[*found.value()] : nullptr;
}

void fill_limits(Filling& filling, const Joint* joint, const std::string& section, AxisLimits& limits) {
  if (joint == nullptr) {
    return;
  }
  const std::string unit = joint->kind == JointKind::revolute ? "deg" : "mm";
  const auto take = [&](const std::string& key, std::optional<Rational>& limit) {
    if (const Rational* number = filling.number(joint->name + "." + key, section + "." + key)) {
      limit = *number;
    }
  };
  take("max_speed_" + unit + "_s", limits.max_speed);
  take("max_acceleration_" + unit + "_s2", limits.max_acceleration);
  take("max_jerk_" + unit + "_s3", limits.max_jerk);
}

}  // namespace

Result<void> apply_machine(const MachineFile& file, Job& job) {
  Filling filling(file, job);
  const kinematics::ScanHead& head = file.machine.head;
  if (head.u_axis.cross(head.v_axis).dot(head.beam_axis) < 0) {
    filling.refuse_file(
        "u_axis, v_axis and beam_axis of its head are left-handed: in the raster modes V counts from "
        "line to line; turn v_axis round");
  }
  fill_head(file, filling, job.scanner);
  const auto axis = [&](JointKind kind, const kinematics::Vector3& along, const char* section, AxisLimits& limits) {
    fill_limits(filling, axis_of(file, kind, along, section, filling), section, limits);
  };
  if (job.mode == Mode::flat) {
    axis(JointKind::prismatic, head.v_axis, "stage", job.stage.limits);
  } else {
    axis(JointKind::revolute, head.u_axis, "rotary", job.rotary.limits);
  }
  if (job.mode == Mode::helical) {
    axis(JointKind::prismatic, head.u_axis, "carriage", job.carriage.limits);
  }
  return filling.result();
}

Result<std::optional<kinematics::Machine>> read_machine_of(Job& job) {
  std::optional<kinematics::Machine> machine;
  if (!job.machine.file) {
    return machine;
  }
  const std::string path = (std::filesystem::path(job.path).parent_path() / *job.machine.file).string();
  const auto text = read_file(path, kMaxMachineBytes);
  if (!text) {
    return Error{text.error().code, job.place_of("machine.file") + text.error().message};
  }
  GRAVURE_TRY(const MachineFile file, parse_machine_file(text.value(), path));
  GRAVURE_CHECK(apply_machine(file, job));
  machine = file.machine;
  return machine;
}

Result<std::vector<scan::JointReach>> reach_of_machine(const std::optional<kinematics::Machine>& machine,
                                                       const Job& job, const Plan& plan) {
  if (!machine) {
    return std::vector<scan::JointReach>();
  }
  const auto at_key = [&job](const Error& error) {
    return Error{error.code, job.place_of("machine.file") + "machine.file: " + error.message};
  };
  Result<std::vector<scan::JointReach>> reach = scan::joint_reach(*machine, plan);
  if (!reach) {
    return at_key(reach.error());
  }
  if (const Result<void> checked = scan::check_reach(reach.value()); !checked) {
    return at_key(checked.error());
  }
  return reach;
}

}  // namespace gravure::cli
