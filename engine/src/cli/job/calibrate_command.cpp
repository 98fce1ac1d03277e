#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "gravure/core/file_output.hpp"
#include "gravure/scan/calibrate.hpp"
#include "program/program_files.hpp"
#include "text_output.hpp"
#include "verb.hpp"

namespace gravure::cli {
namespace {

constexpr std::size_t kMostPointBytes = std::size_t{1} << 26U;

struct CalibrateArguments {
  std::string points;
  std::string output;
  std::string field_mm;
  std::string smoothing = "0.0001";
  std::size_t columns = 17;
  std::size_t rows = 17;
};

Result<int> run_calibrate(const CalibrateArguments& options, const Command& command) {
  GRAVURE_CHECK(refuse_overwrite(options.output, {options.points}));
  GRAVURE_TRY(const Rational field_mm, decimal_option("--field-mm", options.field_mm));
  GRAVURE_TRY(const Rational smoothing, decimal_option("--smoothing", options.smoothing));
  GRAVURE_TRY(const std::string text, read_file(options.points, kMostPointBytes));
  const auto points = scan::parse_measured_points(text);
  if (!points) {
    return Error{points.error().code, options.points + ": " + points.error().message};
  }
  const auto calibration =
      scan::calibrate_field(points.value(), {to_double(field_mm), options.columns, options.rows, to_double(smoothing)});
  if (!calibration) {
    return Error{calibration.error().code, options.points + ": " + calibration.error().message};
  }
  const scan::Calibration& made = calibration.value();
  GRAVURE_CHECK(write_texts({{options.output, scan::field_grid_text(made.grid)}}));
  const scan::MeasuredPoint& worst = points.value()[made.worst];
  const double interpolation_um = rounded(made.grid.interpolation_error_um(), 6);
  if (command.json) {
    print_json({{"grid", options.output},
                {"points", points.value().size()},
                {"columns", made.grid.columns},
                {"rows", made.grid.rows},
                {"rms_um", rounded(made.rms_um, 6)},
                {"max_um", rounded(made.max_um, 6)},
                {"worst",
                 {{"point", made.worst},
                  {"u_mm", worst.order.u_mm},
                  {"v_mm", worst.order.v_mm},
                  {"alone_um", rounded(made.worst_alone_um, 6)}}},
                {"interpolation_um", interpolation_um}});
  } else {
    print(fmt::format(
        "{} marks on a grid of {} x {} in {}: misfit {:.4g} um rms, {:.4g} um at most; interpolation adds {:.4g} "
        "um\nmark {} at U {} mm, V {} mm stands out most: {:.4g} um from where the other marks say\n",
        points.value().size(), made.grid.columns, made.grid.rows, options.output, rounded(made.rms_um, 6),
        rounded(made.max_um, 6), interpolation_um, made.worst, worst.order.u_mm, worst.order.v_mm,
        rounded(made.worst_alone_um, 6)));
  }
  return kDone;
}

}  // namespace

void add_calibrate(CLI::App& app, Command& command) {
  CLI::App* verb = add_verb(app, command, "calibrate",
                            "Field grid from measured marks: CSV with u_order_mm, v_order_mm, u_landing_mm, "
                            "v_landing_mm, a mark a line");
  const auto options = std::make_shared<CalibrateArguments>();
  verb->add_option("POINTS", options->points, "Marks (CSV)")->required();
  verb->add_option("-o,--output", options->output, "Field grid to write, for scanner.field_grid")->required();
  verb->add_option("--field-mm", options->field_mm, "Side of the field that the grid covers")->required();
  constexpr std::int64_t kFewest = 2;
  add_integer(*verb, "--columns", options->columns, "Nodes along U", kFewest, scan::kMostCalibrationNodes);
  add_integer(*verb, "--rows", options->rows, "Nodes along V", kFewest, scan::kMostCalibrationNodes);
  verb->add_option("--smoothing", options->smoothing, "Weight of bending against misfit, 1e-12 to 1")
      ->capture_default_str();
  set_run(*verb, command, options, run_calibrate);
}

}  // namespace gravure::cli
