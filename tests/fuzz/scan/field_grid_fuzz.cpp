// Any text is a field grid or an Error; a grid lives up to what it promises and is written as it was read. The same
// text as a list of measured points gives a calibration or an Error.

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "gravure/scan/calibrate.hpp"
#include "gravure/scan/field_grid.hpp"

namespace {

using gravure::scan::FieldGrid;
using gravure::scan::GridPoint;

void require(bool holds) {
  if (!holds) {
    std::abort();
  }
}

void check_error(const gravure::Error& error) {
  require(error.code == gravure::ErrorCode::bad_file || error.code == gravure::ErrorCode::out_of_range ||
          error.code == gravure::ErrorCode::bad_argument);
  for (const char c : error.message) {
    require(static_cast<unsigned char>(c) >= 0x20U);
  }
}

void check_grid(const FieldGrid& grid) {
  const std::string text = gravure::scan::field_grid_text(grid);
  const auto again = gravure::scan::parse_field_grid(text, "fuzz.grid");
  require(again && gravure::scan::field_grid_text(again.value()) == text);
  require(std::isfinite(grid.interpolation_error_um()));
  const GridPoint middle{(grid.u_first_mm + grid.u_last_mm) / 2, (grid.v_first_mm + grid.v_last_mm) / 2};
  const auto landing = grid.lands_at(middle);
  require(static_cast<bool>(landing));
  const auto order = grid.command_for(landing.value());
  require(order && std::hypot(order.value().u_mm - middle.u_mm, order.value().v_mm - middle.v_mm) < 1e-9);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto grid = gravure::scan::parse_field_grid(text, "fuzz.grid");
  grid ? check_grid(grid.value()) : check_error(grid.error());
  const auto points = gravure::scan::parse_measured_points(text);
  if (!points) {
    check_error(points.error());
  } else if (points.value().size() < 1000) {
    const auto calibration = gravure::scan::calibrate_field(points.value(), {30, 5, 5, 1e-4});
    if (!calibration) {
      check_error(calibration.error());
    } else {
      check_grid(calibration.value().grid);
    }
  }
  return 0;
}
