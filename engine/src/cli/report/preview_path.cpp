#include "report/preview_path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "gravure/core/units.hpp"
#include "gravure/report/path_view.hpp"
#include "gravure/twin/verify_path.hpp"
#include "program/program_files.hpp"
#include "report/preview_canvas.hpp"
#include "text_output.hpp"

namespace gravure::cli {
namespace {

struct LandedPulses {
  report::PulseMap map;
  std::int64_t fired = 0;
};

Result<LandedPulses> land(LineSource& program) {
  LandedPulses landed;
  ProgressBar bar("preview");
  VerifyPathOptions options;
  options.cancel = &cancel_token();
  options.progress = &bar;
  options.landed = [&landed](const LandedPulse& pulse) -> Result<void> {
    const kinematics::Vector3& at = pulse.spot.position_mm;
    landed.map.take(at.x(), at.y(), at.z());
    return {};
  };
  GRAVURE_TRY(const PathReport report, verify_path(program, emulated_devices(), options));
  landed.fired = report.fired;
  return landed;
}

constexpr double kLightest = 0.25;  // of what is there: to be told from the ground

double visible_share(double share) {
  return kLightest + (1 - kLightest) * share;
}

/// Light where pulses are, darker where they are more.
std::vector<double> shares_of_pulses(std::vector<double> pulses, double most) {
  for (double& value : pulses) {
    value = value > 0 ? visible_share(value / most) : -1;
  }
  return pulses;
}

/// Low is dark, as depth is.
std::vector<double> shares_of_heights(const report::PulseMap& map) {
  const std::vector<double> pulses = map.pulses();
  std::vector<double> shares = map.heights();
  const double range_mm = map.highest_mm() - map.lowest_mm();
  for (std::size_t i = 0; i < shares.size(); ++i) {
    const double below_mm = map.highest_mm() - shares[i];
    shares[i] = pulses[i] > 0 ? visible_share(std::clamp(range_mm > 0 ? below_mm / range_mm : 0.0, 0.0, 1.0)) : -1;
  }
  return shares;
}

}  // namespace

Result<int> preview_path(LineSource& program, const std::string& output, std::int64_t width, const Command& command) {
  GRAVURE_TRY(const LandedPulses landed, land(program));
  const report::PulseMap& map = landed.map;
  if (landed.fired == 0) {
    return Error{ErrorCode::bad_argument, output + ": no pulse of this program fires: there is nothing to draw"};
  }
  std::vector<double> pulses = map.pulses();
  const double most = *std::max_element(pulses.begin(), pulses.end());
  const report::Extent size = size_in_frame(map.cells(), 1, width, width);
  const PicturePart number{map.cells(), size, 0,
                           shares_of_rows(shares_of_pulses(std::move(pulses), most), map.cells().width)};
  const PicturePart height{map.cells(), size, size.height + kPictureGap,
                           shares_of_rows(shares_of_heights(map), map.cells().width)};
  const report::Extent all{size.width, height.top + size.height};
  Canvas canvas(all);
  canvas.draw(number, Ramp::fired);
  canvas.draw(height, Ramp::depth);
  GRAVURE_CHECK(canvas.write(output));
  const double cell_um = map.cell_mm() * kUmPerMm;
  const double lowest_mm = rounded(map.lowest_mm(), 6);
  const double highest_mm = rounded(map.highest_mm(), 6);
  if (command.json) {
    print_json({{"picture", output},
                {"width", all.width},
                {"height", all.height},
                {"pulses", place_json(number)},
                {"heights", place_json(height)},
                {"cell_um", cell_um},
                {"left_mm", rounded(map.left_mm(), 6)},
                {"bottom_mm", rounded(map.bottom_mm(), 6)},
                {"fired_pulses", landed.fired},
                {"most_pulses", std::llround(most)},
                {"lowest_mm", lowest_mm},
                {"highest_mm", highest_mm}});
  } else {
    print(fmt::format(
        "{}: {} x {}: {} pulses where they landed, seen along z, at most {:.0f} on a cell of {:.6g} um; below, the "
        "height: {:.6g} to {:.6g} mm, low is dark\n",
        output, all.width, all.height, landed.fired, most, cell_um, lowest_mm, highest_mm));
  }
  return kDone;
}

}  // namespace gravure::cli
