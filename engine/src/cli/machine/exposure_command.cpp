#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gravure/core/units.hpp"
#include "gravure/emulator/fired_lines.hpp"
#include "gravure/formats/grv.hpp"
#include "gravure/formats/tiff_writer.hpp"
#include "gravure/twin/exposure_count.hpp"
#include "program/program_files.hpp"
#include "verb.hpp"

namespace gravure::cli {
namespace {

struct ExposureArguments {
  std::string folder;
  std::string program;
  std::optional<std::int64_t> revolution;
  std::optional<std::int64_t> layer;
  std::string output;
};

/// Pixels by how often they were fired.
struct Times {
  std::array<std::int64_t, 256> pixels{};
  void add(std::span<const std::byte> rows) {
    for (const std::byte times : rows) {
      ++pixels[std::to_integer<std::size_t>(times)];
    }
  }
  std::int64_t twice_or_more() const {
    std::int64_t sum = 0;
    for (std::size_t times = 2; times < pixels.size(); ++times) {
      sum += pixels[times];
    }
    return sum;
  }
  std::int64_t most() const {
    std::int64_t times = 255;
    while (times > 0 && pixels[static_cast<std::size_t>(times)] == 0) {
      --times;
    }
    return times;
  }
};

/// As many rows at a time as fit the budget; the lines are read once for each part.
Result<Times> render(const ExposureArguments& options, ExposureCount& count, BilevelTiffWriter& writer,
                     std::int64_t memory_bytes) {
  const UnrolledSize size = count.size();
  const std::int64_t rows = std::clamp<std::int64_t>((memory_bytes - 4 * kMiB) / size.width, 0, size.height);
  if (rows == 0) {
    return Error{ErrorCode::out_of_range, fmt::format("memory budget of {} MiB: a row of this picture needs {} MiB",
                                                      memory_bytes / kMiB, size.width / kMiB + 5)};
  }
  Times times;
  for (std::int64_t first = 0; first < size.height; first += rows) {
    count.start(first, std::min(first + rows, size.height));
    GRAVURE_CHECK(emulator::read_fired_lines(options.folder, [&count](const emulator::FiredLine& line) -> Result<void> {
      if (cancel_token().cancelled()) {
        return Error{ErrorCode::cancelled, "stopped before the picture was complete; nothing was written"};
      }
      return count.add(line.revolution, line.line, line.first_slot, line.bits);
    }));
    times.add(count.rows());
    GRAVURE_CHECK(writer.append_rows(count.rows()));
  }
  return times;
}

/// Of the source's size, with its size on the workpiece.
BilevelTiffPage page_of(const ProgramHeader& header) {
  const UnrolledSize size = unrolled_size(header);
  const double along = 1000.0 / to_double(header.plan.line.pixel_pitch_um);
  const double across = 1000.0 / to_double(header.plan.rotary.line_pitch_um);
  const bool rows = header.lines_along == LinesAlong::rows;
  BilevelTiffPage page;
  page.bits = 8;
  page.width = size.width;
  page.height = size.height;
  page.x_dots_per_mm = rows ? along : across;
  page.y_dots_per_mm = rows ? across : along;
  return page;
}

/// The one that was noted, unless another is asked for: that one may have run before it.
Result<void> choose_program(ExposureArguments& options) {
  const Result<emulator::NotedProgram> noted = emulator::noted_program(options.folder);
  const bool asked = !options.program.empty();
  if (!noted) {
    return asked ? Result<void>() : Result<void>(noted.error());
  }
  options.program = asked ? options.program : noted.value().path;
  GRAVURE_TRY(const std::string seal, emulator::program_seal(options.program));
  if (noted.value().seal.empty() || noted.value().seal == seal) {
    return {};
  }
  if (!asked) {
    return Error{ErrorCode::bad_file, options.program + " is not the program that the board in " + options.folder +
                                          " ran: it was written anew; give the one that ran with --program"};
  }
  warn(
      fmt::format("--program {} is not what the board in {} ran last, {}: the picture may have lines of that one in "
                  "wrong places",
                  options.program, options.folder, noted.value().path));
  return {};
}

Result<int> run_exposure(ExposureArguments options, const Command& command) {
  GRAVURE_CHECK(check_tiff_name("exposure", options.output));
  GRAVURE_CHECK(choose_program(options));
  GRAVURE_TRY(const std::unique_ptr<LineSource> program, open_grv(options.program));
  const ProgramHeader& header = program->header();
  if (header.plan.path) {
    return Error{ErrorCode::bad_argument,
                 options.program +
                     ": follows a path: its pulses are not pixels of a picture; gravure preview shows where "
                     "they land, gravure verify judges each"};
  }
  GRAVURE_TRY(ExposureCount count, ExposureCount::make(header, options.revolution, options.layer));
  GRAVURE_CHECK(refuse_overwrite(options.output, emulator::state_files(options.folder), Writes::picture));
  GRAVURE_CHECK(refuse_overwrite(options.output, inputs_of_program(options.program), Writes::picture));
  static_cast<void>(cancel_token());  // before there is a temporary file: from here on Ctrl-C takes it away again
  GRAVURE_TRY(BilevelTiffWriter writer, BilevelTiffWriter::create(options.output, page_of(header)));
  GRAVURE_TRY(const Times times, render(options, count, writer, command.memory_bytes()));
  GRAVURE_CHECK(writer.commit());
  if (command.json) {
    print_json({{"picture", options.output},
                {"program", options.program},
                {"revolution", options.revolution ? Json(*options.revolution) : Json()},
                {"layer", options.layer ? Json(*options.layer) : Json()},
                {"width", count.size().width},
                {"height", count.size().height},
                {"pixels_not_fired", times.pixels[0]},
                {"pixels_fired_once", times.pixels[1]},
                {"pixels_fired_more", times.twice_or_more()},
                {"most_times", times.most()}});
  } else {
    const std::string what = options.revolution ? fmt::format("revolution {}", *options.revolution)
                             : options.layer    ? fmt::format("layer {}", *options.layer)
                                                : std::string("everything");
    print(
        fmt::format("{}: {} as the board fired it, {} x {}; pixels fired not at all {}, once {}, more often {} (at "
                    "most {} times)\n",
                    printable(options.output), what, count.size().width, count.size().height, times.pixels[0],
                    times.pixels[1], times.twice_or_more(), times.most()));
  }
  return kDone;
}

}  // namespace

void add_exposure(CLI::App& app, Command& command) {
  CLI::App* verb = add_verb(app, command, "exposure", "How often an emulated board has fired each pixel, as a picture");
  const auto options = std::make_shared<ExposureArguments>();
  verb->add_option("DIR", options->folder, "Folder of the emulated board")->required();
  CLI::Option* revolution =
      verb->add_option("--revolution", options->revolution, "Revolution (flat: pass), from 0; not in helical programs")
          ->check(integer_from(0, kMostIndex));
  verb->add_option("--layer", options->layer, "Layer of a helical program, from 0")
      ->excludes(revolution)
      ->check(integer_from(0, kMostIndex));
  verb->add_option("--program", options->program, "Program it ran (.grv); default: the one that run noted there");
  verb->add_option("-o,--output", options->output, "TIFF to write, a grey level a time: 0, 1, 2 ...")->required();
  add_work_options(*verb, command);
  set_run(*verb, command, options, run_exposure);
}

}  // namespace gravure::cli
