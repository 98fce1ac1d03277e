#include "texture/texture_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <string_view>

#include "gravure/kinematics/machines.hpp"
#include "texture/texture_following.hpp"

namespace gravure::cli {
namespace {

constexpr double kMostPlace_mm = 1e4;   ///< of a workpiece, as in jobs
constexpr double kMostOrigin_mm = 1e3;  ///< further off the stages would cross a hall to keep up with A and C

template <std::size_t count>
CLI::Validator one_of(const std::array<std::string_view, count>& words) {
  return CLI::IsMember(std::vector<std::string>(words.begin(), words.end()));
}

}  // namespace

double figure(double value) {
  return rounded(value, 9);
}

void add_texture_options(CLI::App& verb, TextureSettings& options) {
  verb.add_option("--surface", options.surface, "z in mm by x and y in mm: + - * / ^, sin, cos, exp, sqrt, pi ...");
  verb.add_option("--height-field", options.height_field, "Surface from a picture of 16 bits or floats");
  add_length(verb, "--pixel-um", options.pixel_um, 1e9, "Side of its pixels along x");
  add_length(verb, "--pixel-y-um", options.pixel_y_um, 1e9, "The same along y (default: as along x)");
  verb.add_option("--height-mm", options.height_mm, "z of its sample 0 and of its largest one, or of 1.0")
      ->expected(2)
      ->check(number_from(-kMostPlace_mm, kMostPlace_mm));
  verb.add_option("--mesh", options.mesh, "Surface from the triangles of an STL or PLY file, seen along z");
  add_length(verb, "--max-slope-deg", options.max_slope_deg, 90, "Steepest slope of the surface that is taken")
      ->capture_default_str();
  verb.add_option("--hilbert-order", options.hilbert_order, "Hilbert curve of 4^N points as path")
      ->check(integer_from(1, kMostHilbertOrder));
  add_length(verb, "--size-mm", options.size_mm, kMostPlace_mm, "Side of the square of that curve")
      ->capture_default_str();
  verb.add_option("--path", options.path, "Path from a file: CSV with x_mm, y_mm, a corner a line");
  verb.add_option("--svg", options.svg, "Path from the strokes of an SVG drawing, dark between them");
  add_length(verb, "--tolerance-um", options.tolerance_um, 1e6, "How far its curves may be cut")->capture_default_str();
  verb.add_option("--bitmap", options.bitmap, "Picture as lines to and fro, a pulse above every pixel that fires");
  add_length(verb, "--pitch-um", options.pitch_um, 1e9, "Its pixels along the lines, in the plane");
  add_length(verb, "--line-pitch-um", options.line_pitch_um, 1e9, "Its lines (default: as the pixels)");
  verb.add_option("--run-out-um", options.run_out_um, "Dark way before and behind each line, at least")
      ->check(number_from(0, 1e9))
      ->capture_default_str();
  verb.add_option("--fires", options.fires, "Which pixels of it fire")->check(CLI::IsMember({"white", "black"}));
  verb.add_option("--threshold", options.threshold, "Grey picture: a sample of so much or more is white")
      ->check(integer_from(0, 65535));
  add_length(verb, "--step-um", options.step_um, 1e9,
             "Distance of the points along --path and --svg; at most that along --bitmap (default 100)");
}

void add_split_options(CLI::App& verb, SplitSettings& options, const std::string& without_sigma) {
  verb.add_option("--split", options.method, "How the stages' path is made")
      ->check(one_of(kSplitMethods))
      ->capture_default_str();
  verb.add_flag("--focus-axis", options.focus_axis, "An axis W takes up the focus offset, which has no limit then");
  add_length(verb, "--focus-mm", options.focus_mm, 1e6, "What that axis reaches from its middle");
  add_length(verb, "--sigma-um", options.sigma_um, 1e9,
             "Sigma of the Gaussian along the path; left out: " + without_sigma);
  add_length(verb, "--cut", options.cut, 38, "Where the Gaussian ends, in sigma")->capture_default_str();
  add_length(verb, "--fod-um", options.fod_um, 1e9, "Limit of the focus offset")->capture_default_str();
  add_length(verb, "--bia-deg", options.bia_deg, 90, "Limit of the angle of incidence")->capture_default_str();
  add_length(verb, "--displacement-mm", options.displacement_mm, 1e6, "Limit of what the galvo reaches")
      ->capture_default_str();
}

texture::DeviationLimits limits_of(const SplitSettings& options) {
  return {options.focus_axis ? options.focus_mm.value_or(std::numeric_limits<double>::infinity())
                             : options.fod_um / kUmPerMm,
          options.bia_deg / kDegreesPerRad, options.displacement_mm};
}

std::unique_ptr<texture::Splitter> splitter_of(const SplitSettings& options) {
  using texture::SplitMethod;
  auto method = SplitMethod::gaussian;
  for (const SplitMethod each :
       {SplitMethod::savitzky_golay, SplitMethod::fft, SplitMethod::adaptive, SplitMethod::optimal}) {
    method = split_method_name(each) == options.method ? each : method;
  }
  return texture::make_splitter(method, {.sigma_mm = 0, .cut = options.cut});
}

void add_axes_options(CLI::App& verb, AxesSettings& options) {
  verb.add_option("--branch", options.branch, "Sign of A")->check(one_of(kBranches))->capture_default_str();
  verb.add_option("--signs", options.signs, "Senses of the axes: of [A], or of [C2]'s post-processor")
      ->check(one_of(kSigns))
      ->capture_default_str();
  verb.add_option("--origin-mm", options.origin_mm, "Where A and C meet, in the workpiece: x y z")
      ->expected(3)
      ->check(number_from(-kMostOrigin_mm, kMostOrigin_mm));
  verb.add_option("--tilt-deg", options.tilt_deg, "Clamping: turned about x, then about y, by so much")
      ->expected(2)
      ->check(number_from(-180, 180));
}

void add_motion_options(CLI::App& verb, FreeformJob& job, std::vector<std::string>& limits) {
  verb.add_option("--rule", job.split.rule,
                  "Without --sigma-um: time, the smallest that costs no time, or published, the first of 30000 ...")
      ->check(one_of(kSigmaRules))
      ->capture_default_str();
  verb.add_option("--time-share-percent", job.split.time_share_percent,
                  "How much longer than the fastest, for --rule time")
      ->check(number_from(0, 1000))
      ->capture_default_str();
  verb.add_option("--stops", job.motion.stops,
                  "Where the spot rests: points or corners; left out: points of a Hilbert curve, else corners")
      ->check(one_of(kStops));
  verb.add_option("--limit", limits,
                  "AXIS=SPEED,ACCELERATION,JERK of one axis, mm or rad per s, s^2, s^3; as often as needed");
  verb.add_option("--servo-us", job.motion.servo_us, "Servo period: for a program a whole number of pulse slots")
      ->check(number_from(1, 1e5))
      ->capture_default_str();
}

Result<void> set_limits(const std::vector<std::string>& limits, MotionSettings& motion) {
  std::array<bool, kPathAxes.size()> given{};
  for (const std::string& limit : limits) {
    GRAVURE_TRY(const AxisSetting setting, axis_setting("--limit", limit, "AXIS=SPEED,ACCELERATION,JERK"));
    GRAVURE_CHECK(refuse_twice("--limit", setting.axis, given));
    motion.limits[setting.axis] = {setting.numbers[0], setting.numbers[1], setting.numbers[2]};
  }
  return {};
}

texture::Clamping clamping_of(const AxesSettings& options) {
  return {options.tilt_deg[0] / kDegreesPerRad, options.tilt_deg[1] / kDegreesPerRad};
}

kinematics::Machine machine_of(const AxesSettings& options) {
  const auto signs =
      options.signs == "texturing" ? kinematics::XyzacSigns::texturing : kinematics::XyzacSigns::post_processor;
  const kinematics::Vector3 origin_mm(options.origin_mm[0], options.origin_mm[1], options.origin_mm[2]);
  return kinematics::xyzac_machine(signs, origin_mm, {});
}

kinematics::Branch branch_of(const AxesSettings& options) {
  return options.branch == "positive" ? kinematics::Branch::positive : kinematics::Branch::negative;
}

Result<std::vector<texture::SevenAxes>> axes_of(const AxesSettings& options, const texture::Split& split) {
  const texture::Split lying = texture::clamped(split, clamping_of(options));
  return texture::seven_axes(machine_of(options), lying.targets, lying.stages, branch_of(options));
}

void add_points_option(CLI::App& verb, std::string& file) {
  verb.add_option("--points", file, "CSV of every point, its stages' point, axes and deviations");
}

Result<std::optional<TextOutput>> staged(TextOutput output) {
  GRAVURE_CHECK(check_not_stopped());
  GRAVURE_CHECK(output.finish());
  return std::optional(std::move(output));
}

Result<std::optional<TextOutput>> stage_points(const std::string& file, const texture::Split& split,
                                               std::span<const texture::SevenAxes> axes, bool focus_axis) {
  if (file.empty()) {
    return std::optional<TextOutput>();
  }
  GRAVURE_TRY(TextOutput output, TextOutput::create(file));
  output.text() += "i,x,y,z,xp,yp,zp,X,Y,Z,A,C,U,V,fod_um,bia_deg";
  output.text() += focus_axis ? ",W\n" : "\n";
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const auto& p = split.targets[i].position_mm;
    const auto& q = split.stages[i].position_mm;
    const texture::SevenAxes& at = axes[i];
    const texture::Deviation off = texture::deviation(split.targets[i], split.stages[i]);
    const auto add = [&output](int decimals, std::initializer_list<double> values) {
      for (const double value : values) {
        output.text() += fmt::format(",{:.{}f}", rounded(value, decimals), decimals);
      }
    };
    output.text() += std::to_string(i);
    add(9, {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), at.x_mm, at.y_mm, at.z_mm});
    add(12, {at.a_rad, at.c_rad});
    add(9, {at.u_mm, at.v_mm});
    add(6, {off.focus_mm * kUmPerMm});
    add(9, {off.incidence_rad * kDegreesPerRad});
    output.text() += focus_axis ? fmt::format(",{:.9f}\n", rounded(at.w_mm, 9)) : "\n";
    if (!output.flush(false) || cancel_token().cancelled()) {
      break;
    }
  }
  return staged(std::move(output));
}

Json split_json(const std::string& surface, const texture::TexturePath& path, const texture::Split& split,
                const SplitSettings& options) {
  const texture::DeviationSummary& most = split.most;
  return {{"surface", surface},
          {"split", options.method},
          {"points", split.targets.size()},
          {"step_um", figure(path.step_mm * kUmPerMm)},
          {"sigma_um", options.method == "optimal" ? Json(nullptr) : Json(figure(split.sigma_mm * kUmPerMm))},
          {"tries", split.tries},
          {"fod_um", {{"max", figure(most.max_focus_mm * kUmPerMm)}, {"rms", figure(most.rms_focus_mm * kUmPerMm)}}},
          {"bia_deg", {{"max", figure(most.max_incidence_rad * kDegreesPerRad)}}},
          {"displacement_mm", {{"max", figure(most.max_displacement_mm)}}}};
}

std::string split_text(const texture::TexturePath& path, const texture::Split& split, const SplitSettings& options,
                       const std::string& how_sigma) {
  const texture::DeviationSummary& most = split.most;
  const double length_mm = static_cast<double>(path.points_mm.size() - 1) * path.step_mm;
  std::string text = fmt::format("path          {} points, {:.6g} um apart, {:.6g} m in the plane\n",
                                 split.targets.size(), path.step_mm * kUmPerMm, length_mm / 1000);
  if (options.method != "optimal") {
    text += fmt::format("sigma         {:.3f} um of arc length{}\n", split.sigma_mm * kUmPerMm, how_sigma);
  }
  text += fmt::format("focus offset  {:.3f} um at most, {:.3f} um rms ({})\n", most.max_focus_mm * kUmPerMm,
                      most.rms_focus_mm * kUmPerMm,
                      !options.focus_axis ? fmt::format("allowed {:.6g}", options.fod_um)
                      : options.focus_mm  ? fmt::format("taken up by W, which reaches {:.6g} mm", *options.focus_mm)
                                          : "taken up by W");
  text += fmt::format("incidence     {:.5f} deg at most (allowed {:.6g})\n", most.max_incidence_rad * kDegreesPerRad,
                      options.bia_deg);
  text += fmt::format("galvo         {:.6f} mm at most (allowed {:.6g})\n", most.max_displacement_mm,
                      options.displacement_mm);
  return text;
}

}  // namespace gravure::cli
