#include <fmt/format.h>

#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "gravure/twin/exposure.hpp"
#include "program/program_files.hpp"
#include "program/program_trajectory.hpp"
#include "text_output.hpp"
#include "verb.hpp"

namespace gravure::cli {
namespace {

struct TrajectoryArguments {
  std::string program;
  std::int64_t revolution = 0;
  std::int64_t line = 0;
  bool csv = false;
  bool ideal = false;
  std::string output;
};

/// The bits of one line in time order.
Result<std::vector<std::byte>> bits_of_line(LineSource& program, const scan::LineNumber& number) {
  const ProgramHeader& header = program.header();
  ProgramChunk chunk;
  GRAVURE_CHECK(chunk.load(program, {header.layer_of_revolution[static_cast<std::size_t>(number.revolution)],
                                     number.line / program.lines_per_chunk()}));
  const auto bytes = static_cast<std::size_t>(header.line_bytes());
  const std::span<const std::byte> lines = chunk.lines_for(header, number.revolution);
  const auto line = lines.subspan(static_cast<std::size_t>(number.line - chunk.first_line()) * bytes, bytes);
  return std::vector<std::byte>(line.begin(), line.end());
}

/// To 1e-9 of the unit, no negative zero: the same text from every compiler.
std::string decimals(double value) {
  return fmt::format("{:.9f}", rounded(value, 9));
}

/// What the slots of a line print, row by row.
class Rows {
 public:
  static Result<Rows> of(const TrajectoryArguments& options, ProgramTrajectory& opened) {
    Rows rows(opened.trajectory, {options.revolution, options.line});
    GRAVURE_TRY(rows.bits_, bits_of_line(*opened.program, rows.number_));
    const scan::LineTrajectory& line = opened.trajectory.of_revolution(options.revolution);
    rows.model_ = scan::landing_model(line);
    if (options.ideal) {  // lags by exactly what the orders are early
      rows.model_ = {static_cast<double>(line.lag_ticks) / static_cast<double>(rows.plan().clock.fpga_hz) * 1e6, false,
                     false};
    }
    return rows;
  }
  std::array<const char*, 10> columns() const {
    if (plan().mode == Mode::flat) {
      return {"slot", "tick", "u_mm", "v_mm", "x_mm", "y_mm", "spot_x_mm", "spot_y_mm", "spot_z_mm", "fired"};
    }
    return {"slot", "tick",      "u_mm",      "v_mm",      "c_accumulated_deg",
            "x_mm", "spot_x_mm", "spot_y_mm", "spot_z_mm", "fired"};
  }
  std::int64_t count() const { return plan().line.slots; }
  Result<std::string> row(std::int64_t slot) const {
    GRAVURE_TRY(const scan::SlotState state, trajectory_.at(number_, slot, model_));
    const bool flat = plan().mode == Mode::flat;
    const double first = flat ? state.joints[0] : state.joints[0] * kDegreesPerRad;
    return fmt::format("{},{},{},{},{},{},{},{},{},{}", slot, state.tick, decimals(state.mirrors.u_mm),
                       decimals(state.mirrors.v_mm), decimals(first), decimals(state.joints[1]),
                       decimals(state.spot_mm.x()), decimals(state.spot_mm.y()), decimals(state.spot_mm.z()),
                       fires(slot) ? 1 : 0);
  }

 private:
  Rows(const scan::JobTrajectory& trajectory, const scan::LineNumber& number)
      : trajectory_(trajectory), number_(number) {}
  const Plan& plan() const { return trajectory_.plan(); }
  bool fires(std::int64_t slot) const {
    const LinePlan& line = plan().line;
    const bool reverse = trajectory_.direction_of(number_) == scan::Direction::reverse;
    const std::int64_t pixel = slot - (reverse ? line.reverse_first_slot : line.forward_first_slot);
    if (pixel < 0 || pixel >= line.pixels) {
      return false;
    }
    const auto byte = static_cast<unsigned>(bits_[static_cast<std::size_t>(pixel / 8)]);
    return ((byte >> (7 - pixel % 8)) & 1U) != 0;
  }

  const scan::JobTrajectory& trajectory_;
  scan::LineNumber number_;
  std::vector<std::byte> bits_;
  scan::LandingModel model_;
};

std::string comma_separated(const Rows& rows, const char* quote) {
  std::string text;
  for (const char* column : rows.columns()) {
    text += (text.empty() ? "" : ",") + std::string(quote) + column + quote;
  }
  return text;
}

using Write = std::function<Result<void>(const std::string&)>;

Result<void> write_csv(const Rows& rows, const Write& write) {
  GRAVURE_CHECK(write(comma_separated(rows, "") + "\n"));
  for (std::int64_t slot = 0; slot < rows.count(); ++slot) {
    GRAVURE_TRY(const std::string row, rows.row(slot));
    GRAVURE_CHECK(write(row + "\n"));
  }
  return {};
}

/// The same rows as arrays, written one by one: a line may have millions of slots.
Result<void> write_json(const Rows& rows, const TrajectoryArguments& options, const scan::LineTrajectory& line,
                        bool reverse, const Write& write) {
  std::string head = Json{{"revolution", options.revolution},
                          {"line", options.line},
                          {"direction", direction_name(reverse)},
                          {"ideal", options.ideal},
                          {"set_points", line.forward.size()}}
                         .dump(2);
  head.resize(head.size() - 2);  // the closing brace
  GRAVURE_CHECK(write(head + ",\n  \"columns\": [" + comma_separated(rows, "\"") + "],\n  \"slots\": [\n"));
  for (std::int64_t slot = 0; slot < rows.count(); ++slot) {
    GRAVURE_TRY(const std::string row, rows.row(slot));
    GRAVURE_CHECK(write("    [" + row + (slot + 1 < rows.count() ? "],\n" : "]\n")));
  }
  return write("  ]\n}\n");
}

Result<int> run_trajectory(const TrajectoryArguments& options, const Command& command) {
  GRAVURE_TRY(ProgramTrajectory opened, open_trajectory(options.program));
  const Plan& plan = opened.trajectory.plan();
  GRAVURE_CHECK(check_index("--revolution", options.revolution, plan.job.revolutions));
  GRAVURE_CHECK(check_index("--line", options.line, plan.rotary.lines_per_revolution));
  const scan::LineTrajectory& line = opened.trajectory.of_revolution(options.revolution);
  for (const std::string& warning : line.warnings) {
    warn(warning);
  }
  GRAVURE_TRY(const Rows rows, Rows::of(options, opened));
  if (!options.output.empty()) {
    GRAVURE_CHECK(refuse_overwrite(options.output, inputs_of_program(options.program)));
    cancel_token();  // before there is a temporary file
    GRAVURE_TRY(TextOutput output, TextOutput::create(options.output));
    GRAVURE_CHECK(write_csv(rows, [&output](const std::string& text) -> Result<void> {
      output.text() += text;
      output.flush(false);
      if (cancel_token().cancelled()) {
        return Error{ErrorCode::cancelled, "stopped; nothing was written"};
      }
      return {};
    }));
    GRAVURE_CHECK(output.commit());
  }
  const Write to_stdout = [](const std::string& text) -> Result<void> {
    print(text);
    return {};
  };
  const bool reverse = line_is_reverse(plan, options.revolution, options.line);
  if (command.json && options.output.empty()) {
    GRAVURE_CHECK(write_json(rows, options, line, reverse, to_stdout));
  } else if (command.json) {
    print_json({{"revolution", options.revolution},
                {"line", options.line},
                {"direction", direction_name(reverse)},
                {"ideal", options.ideal},
                {"set_points", line.forward.size()},
                {"output", options.output},
                {"rows", rows.count()}});
  } else if (options.output.empty()) {
    GRAVURE_CHECK(write_csv(rows, to_stdout));
  } else {
    print(fmt::format("{} slots of line {}, revolution {} ({}) in {}\n", rows.count(), options.line, options.revolution,
                      direction_name(reverse), options.output));
  }
  return kDone;
}

}  // namespace

void add_trajectory(CLI::App& app, Command& command) {
  CLI::App* verb = add_verb(app, command, "trajectory",
                            "Where mirrors, axes and spot are in every pulse slot of a line, as CSV: slot, tick of the "
                            "job, U, V, axis positions, spot on the workpiece, fired");
  const auto options = std::make_shared<TrajectoryArguments>();
  verb->add_option("PROGRAM", options->program, "Program file (.grv)")->required();
  verb->add_option("--line", options->line, "Line of the revolution, from 0")
      ->required()
      ->check(integer_from(0, kMostIndex));
  add_integer(*verb, "--revolution", options->revolution, "Revolution (pass), from 0", 0, kMostIndex);
  verb->add_flag("--csv", options->csv, "CSV on standard output, which is the default");
  verb->add_flag("--ideal", options->ideal, "A scanner without lag and counts that goes along the planned path");
  verb->add_option("-o,--output", options->output, "Write the CSV to this file instead");
  verb->callback([&command, options] {
    command.run = [&command, options]() -> Result<int> {
      if (options->csv && command.json) {
        return Error{ErrorCode::bad_argument, "--csv and --json: give one of them"};
      }
      return run_trajectory(*options, command);
    };
  });
}

}  // namespace gravure::cli
