#include <memory>

#include "gravure/formats/grv.hpp"
#include "gravure/raster/place.hpp"
#include "gravure/twin/unroll.hpp"
#include "program/program_files.hpp"
#include "program/program_trajectory.hpp"
#include "verb.hpp"

namespace gravure::cli {
namespace {

struct DumpArguments {
  std::string program;
  std::int64_t revolution = 0;
  std::int64_t line = 0;
};

/// Takes the line as the device gets it on its way through the pins: the window's bits in the dark slots around it.
class SlotText final : public PinObserver {
 public:
  explicit SlotText(const Plan& plan) : plan_(plan) {}
  void start(std::int64_t wanted_ordinal) { wanted_ = wanted_ordinal; }
  void on_line(const ExecutedLine& line) override {
    if (line.ordinal != wanted_) {
      return;
    }
    text_.assign(static_cast<std::size_t>(plan_.line.slots), '0');
    for (std::int64_t i = 0; i < plan_.line.pixels; ++i) {
      const auto byte = static_cast<unsigned>(line.fired[static_cast<std::size_t>(i / 8)]);
      text_[static_cast<std::size_t>(line.first_slot + i)] = ((byte >> (7 - i % 8)) & 1U) != 0 ? '1' : '0';
    }
  }
  const std::string& text() const { return text_; }

 private:
  const Plan& plan_;
  std::int64_t wanted_ = -1;
  std::string text_;
};

Result<int> run_dump(const DumpArguments& options, const Command& command) {
  GRAVURE_TRY(const std::unique_ptr<LineSource> program, open_grv(options.program));
  const ProgramHeader& header = program->header();
  const Plan& plan = header.plan;
  GRAVURE_CHECK(check_index("--revolution", options.revolution, plan.job.revolutions));
  GRAVURE_CHECK(check_index("--line", options.line, plan.rotary.lines_per_revolution));
  const std::int64_t chunk_number = options.line / program->lines_per_chunk();
  ProgramChunk chunk;
  GRAVURE_CHECK(
      chunk.load(*program, {header.layer_of_revolution[static_cast<std::size_t>(options.revolution)], chunk_number}));
  SlotText slots(plan);
  slots.start(options.revolution * plan.rotary.lines_per_revolution + options.line);
  const std::unique_ptr<LineDevice> device = emulated_devices()(slots);
  GRAVURE_CHECK(device->configure(device_setup(plan, options.revolution, chunk.first_line())));
  GRAVURE_CHECK(chunk.send(header, options.revolution, *device));
  const bool reverse = line_is_reverse(plan, options.revolution, options.line);
  if (command.json) {
    const std::vector<std::int64_t> images = images_of_layers(header);
    const Json layer = images.empty()
                           ? Json(nullptr)
                           : Json(images[header.layer_of_revolution[static_cast<std::size_t>(options.revolution)]]);
    print_json({{"revolution", options.revolution},
                {"line", options.line},
                {"layer", layer},
                {"direction", direction_name(reverse)},
                {"first_slot", reverse ? plan.line.reverse_first_slot : plan.line.forward_first_slot},
                {"slots", slots.text()}});
  } else {
    print(slots.text() + "\n");
  }
  return kDone;
}

}  // namespace

void add_dump(CLI::App& app, Command& command) {
  CLI::App* verb = add_verb(
      app, command, "dump",
      "The slots of one line as 0 and 1 in time order. Where the job is bidirectional, line L of revolution R runs "
      "backwards if R * lines_per_revolution + L is odd: the scanner alternates over the whole job");
  const auto options = std::make_shared<DumpArguments>();
  verb->add_option("PROGRAM", options->program, "Program file (.grv)")->required();
  verb->add_option("--revolution", options->revolution, "Revolution, from 0")
      ->required()
      ->check(integer_from(0, kMostIndex));
  verb->add_option("--line", options->line, "Line of the revolution, from 0")
      ->required()
      ->check(integer_from(0, kMostIndex));
  set_run(*verb, command, options, run_dump);
}

}  // namespace gravure::cli
