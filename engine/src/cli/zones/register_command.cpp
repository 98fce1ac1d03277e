#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "gravure/formats/contours.hpp"
#include "gravure/formats/image_files.hpp"
#include "gravure/formats/points.hpp"
#include "gravure/registration/refine_contours.hpp"
#include "gravure/registration/register_scan.hpp"
#include "motion/motion_options.hpp"
#include "program/program_files.hpp"
#include "text_output.hpp"
#include "verb.hpp"

namespace gravure::cli {
namespace {

using registration::CadModel;
using registration::PlacedContour;
using registration::Registration;

constexpr std::size_t kScanMeshSamples = 100'000;

struct RegisterOptions {
  std::string cad;
  std::string scan;
  std::string output;
  std::string contours;
  std::string contours_output;
  std::string residuals;
  registration::RegistrationOptions pose;
  registration::ContourOptions around;
};

/// To 6 digits, whatever the size.
double six_digits(double value) {
  return std::isfinite(value) && value != 0 ? std::stod(fmt::format("{:.5e}", value)) : 0;
}

Result<PointFile> load(const std::string& path) {
  GRAVURE_TRY(PointFile file, read_point_file(path));
  if (file.dropped_points > 0 || file.dropped_triangles > 0) {
    warn(fmt::format("{}: {} points without finite coordinates{} and {} triangles without area dropped", path,
                     file.dropped_points, file.dropped_points > 0 ? " (the first: " + file.first_dropped + ")" : "",
                     file.dropped_triangles));
  }
  return file;
}

Result<CadModel> load_cad(const std::string& path) {
  GRAVURE_TRY(PointFile file, load(path));
  CadModel cad;
  if (file.triangles.empty()) {
    cad.samples = std::move(file.points);
  } else {
    cad.mesh = {std::move(file.points.points_mm), std::move(file.triangles)};
  }
  return cad;
}

/// Of triangles, samples: their corners may be few.
Result<PointSet> load_scan(const std::string& path) {
  GRAVURE_TRY(PointFile file, load(path));
  if (file.triangles.empty()) {
    return std::move(file.points);
  }
  const TriangleMesh mesh{std::move(file.points.points_mm), std::move(file.triangles)};
  return registration::sample_mesh(mesh, std::max(kScanMeshSamples, mesh.vertices_mm.size()));
}

Json weak_json(const Registration& found) {
  Json weak = Json::array();
  for (const registration::WeakDirection& direction : found.weak_directions) {
    weak.push_back({{"name", direction.name}, {"eigenvalue", six_digits(direction.eigenvalue)}});
  }
  return weak;
}

Json numbers_json(const std::vector<double>& values) {
  Json all = Json::array();
  for (const double value : values) {
    all.push_back(six_digits(value));
  }
  return all;
}

double share(const Registration& found) {
  return static_cast<double>(found.inliers) / static_cast<double>(found.scan_points);
}

/// Everything is held and nothing else fits nearly as well.
bool is_sure(const Registration& found) {
  return found.converged && !found.degenerate && !found.scale_refused && !found.ambiguous;
}

Json registration_json(const Registration& found) {
  Json transform = Json::array();
  const Eigen::Matrix4d matrix = found.cad_to_scan.matrix();
  for (int row = 0; row < 4; ++row) {
    transform.push_back({rounded(matrix(row, 0), 9), rounded(matrix(row, 1), 9), rounded(matrix(row, 2), 9),
                         rounded(matrix(row, 3), 9)});
  }
  return {{"transform", transform},
          {"scale", rounded(found.cad_to_scan.scale, 9)},
          {"rms_mm", rounded(found.rms_mm, 9)},
          {"inliers", rounded(share(found), 9)},
          {"inlier_points", found.inliers},
          {"scan_points", found.scan_points},
          {"iterations", found.iterations},
          {"converged", found.converged},
          {"degenerate", found.degenerate},
          {"kept_as_started", found.kept_as_started},
          {"scale_refused", found.scale_refused},
          {"ambiguous", found.ambiguous},
          {"sure", is_sure(found)},
          {"shape", found.shape},
          {"eigenvalues", numbers_json(found.eigenvalues)},
          {"deviations_mm", numbers_json(found.deviations_mm)},
          {"condition_number", six_digits(found.condition_number)},
          {"weak_directions", weak_json(found)}};
}

Json contours_json(const std::vector<PlacedContour>& placed) {
  Json all = Json::array();
  for (const PlacedContour& one : placed) {
    all.push_back({{"id", one.contour.id},
                   {"refined", one.refined},
                   {"scan_points", one.scan_points},
                   {"rms_mm", rounded(one.rms_mm, 9)},
                   {"moved_mm", rounded(one.moved_mm, 9)},
                   {"weak_directions", one.weak_directions}});
  }
  return all;
}

std::string registration_text(const Registration& found) {
  std::string text =
      fmt::format("rms {:.3f} um, {:.1f} % of {} scan points on the CAD, scale {:.6f}, {} iterations{}\n",
                  1e3 * found.rms_mm, 100 * share(found), found.scan_points, found.cad_to_scan.scale, found.iterations,
                  found.converged ? "" : ", not converged");
  const Eigen::Matrix4d matrix = found.cad_to_scan.matrix();
  for (int row = 0; row < 3; ++row) {
    text += fmt::format("{:12.9f} {:12.9f} {:12.9f} {:14.6f}\n", rounded(matrix(row, 0), 9), rounded(matrix(row, 1), 9),
                        rounded(matrix(row, 2), 9), rounded(matrix(row, 3), 9));
  }
  for (const registration::WeakDirection& weak : found.weak_directions) {
    text += fmt::format("not held: {}\n", weak.name);
  }
  text += found.ambiguous ? "AMBIGUOUS: another pose fits nearly as well\n" : "";
  return text;
}

std::string residuals_csv(const PointSet& scan, const Registration& found) {
  std::string csv = "x_mm,y_mm,z_mm,distance_mm\n";
  for (std::size_t i = 0; i < scan.points_mm.size(); ++i) {
    const auto& [x, y, z] = scan.points_mm[i];
    csv += fmt::format("{},{},{},", x, y, z);
    csv += std::isfinite(found.residuals_mm[i]) ? fmt::format("{:.6f}\n", rounded(found.residuals_mm[i], 9)) : "\n";
  }
  return csv;
}

void warn_of(const Registration& found) {
  if (!found.converged) {
    warn("the pose did not settle, or the scan lies further than 5 % of the part from the CAD: do not rely on it");
  }
  if (found.degenerate) {
    warn(fmt::format("the points do not hold {} direction{} of the CAD{}: {}", found.weak_directions.size(),
                     found.weak_directions.size() == 1 ? "" : "s", found.shape.empty() ? "" : " (" + found.shape + ")",
                     found.kept_as_started
                         ? "kept as the start had them"
                         : "as the start had them the scan would not lie on the CAD, so any will do"));
  }
  if (found.scale_refused) {
    warn("the points do not hold the scale: it is 1");
  }
  if (found.ambiguous) {
    warn("another pose fits nearly as well: is the part symmetric? Do not rely on this one before it is checked");
  }
}

struct LaidContours {
  std::vector<PlacedContour> placed;
  std::string json;  ///< the file of them
};

Result<LaidContours> place_contours(const RegisterOptions& options, const CadModel& cad, const PointSet& scan,
                                    const Registration& found, const formats::ContourFile& contours) {
  registration::ContourOptions around = options.around;
  around.with_scale = options.pose.with_scale && !found.scale_refused;
  Result<std::vector<PlacedContour>> laid = [&] {
    ProgressBar bar("contours", "contours");
    around.progress = &bar;
    return registration::refine_contours(cad, scan, found, contours.contours, around);
  }();
  GRAVURE_TRY(std::vector<PlacedContour> placed, std::move(laid));
  std::vector<Contour> there;
  std::size_t refined = 0;
  for (PlacedContour& one : placed) {
    for (Point3& point : one.contour.points_mm) {
      point = {rounded(point[0], 9), rounded(point[1], 9), rounded(point[2], 9)};
    }
    one.contour.direction = {rounded(one.contour.direction[0], 9), rounded(one.contour.direction[1], 9),
                             rounded(one.contour.direction[2], 9)};
    there.push_back(one.contour);
    refined += one.refined ? 1 : 0;
  }
  if (refined < placed.size()) {
    warn(fmt::format("{} of {} contours lie as the whole pose has them: too few points around them, or no agreement",
                     placed.size() - refined, placed.size()));
  }
  return LaidContours{std::move(placed), formats::contours_to_json(there)};
}

Result<formats::ContourFile> contours_to_move(const RegisterOptions& options) {
  if (options.contours.empty() != options.contours_output.empty()) {
    return Error{ErrorCode::bad_argument, "--contours and --contours-out belong together"};
  }
  if (options.contours.empty()) {
    return formats::ContourFile{};
  }
  GRAVURE_TRY(formats::ContourFile file, formats::read_contours(options.contours));
  for (const std::string& note : file.notes) {
    warn(note);
  }
  return file;
}

Result<int> run_register(const RegisterOptions& options, bool json) {
  GRAVURE_CHECK(refuse_overwrite(
      {{"--output", options.output}, {"--contours-out", options.contours_output}, {"--residuals", options.residuals}},
      {options.cad, options.scan, options.contours}));
  GRAVURE_TRY(const formats::ContourFile contours, contours_to_move(options));
  GRAVURE_TRY(const CadModel cad, load_cad(options.cad));
  GRAVURE_TRY(const PointSet scan, load_scan(options.scan));
  Result<Registration> registered = [&] {
    ProgressBar bar("register", "steps");
    registration::RegistrationOptions pose = options.pose;
    pose.progress = &bar;
    return registration::register_scan(cad, scan, pose);
  }();
  GRAVURE_TRY(const Registration found, std::move(registered));
  warn_of(found);
  Json document = registration_json(found);
  std::string text = registration_text(found);
  std::vector<TextFile> files;
  if (!contours.contours.empty()) {
    GRAVURE_TRY(LaidContours laid, place_contours(options, cad, scan, found, contours));
    document["contours"] = contours_json(laid.placed);
    document["contours_out_sha256"] = sha256_text(laid.json);
    text += fmt::format("{} contours written to {}\n", laid.placed.size(), options.contours_output);
    files.push_back({options.contours_output, std::move(laid.json)});
  }
  if (!options.residuals.empty()) {
    files.push_back({options.residuals, residuals_csv(scan, found)});
  }
  files.push_back({options.output, document.dump(2) + "\n"});
  GRAVURE_CHECK(write_texts(files));
  json ? print_json(document) : print(text);
  return is_sure(found) ? kDone : kLimitViolated;
}

}  // namespace

void add_register(CLI::App& app, Command& command) {
  CLI::App* verb = add_verb(app, command, "register", "Lay a CAD model, and contours on it, on a scan of the part");
  const auto options = std::make_shared<RegisterOptions>();
  verb->add_option("cad", options->cad, "CAD: mesh (STL, PLY) or points (PLY, PCD, XYZ, CSV), in mm")->required();
  verb->add_option("scan", options->scan, "Scan: points or mesh, in mm")->required();
  verb->add_option("-o,--output", options->output, "Write the result as JSON to this file");
  verb->add_flag("--scale", options->pose.with_scale, "The scan may be larger or smaller than the CAD");
  verb->add_option("--contours", options->contours, "Contours on the CAD (JSON or CSV)");
  verb->add_option("--contours-out", options->contours_output, "Write them as they lie on the scan, as JSON");
  const auto around_mm = number_from(registration::ContourOptions::kLeastMm, registration::ContourOptions::kMostMm);
  verb->add_option("--crop-mm", options->around.crop_mm, "Scan points so near a contour say where it lies")
      ->check(around_mm)
      ->capture_default_str();
  verb->add_flag("--bend", options->around.bend, "Bend contours out of the surface as the scan is bent");
  verb->add_option("--bend-mm", options->around.bend_mm, "Bending shorter than this is smoothed away")
      ->check(around_mm)
      ->capture_default_str();
  verb->add_option("--residuals", options->residuals, "Write each scan point's distance from the CAD as CSV");
  verb->callback(
      [&command, options] { command.run = [&command, options] { return run_register(*options, command.json); }; });
}

}  // namespace gravure::cli
