#include <fmt/format.h>

#include <memory>

#include "gravure/formats/grv.hpp"
#include "gravure/formats/plan_json.hpp"
#include "plan_text.hpp"
#include "program_files.hpp"
#include "verb.hpp"

namespace gravure::cli {
namespace {

Json json_of(const ProgramHeader& header) {
  Json sources = Json::array();
  for (const SourceImage& source : header.sources) {
    sources.push_back({{"path", source.path},
                       {"page", source.page},
                       {"width", source.width},
                       {"height", source.height},
                       {"sha256", source.sha256}});
  }
  Json layers = Json::array();
  for (const StoredLayer& layer : header.layers) {
    layers.push_back({{"source", layer.source},
                      {"level", layer.level},
                      {"starts", direction_name(layer.starts_reverse)},
                      {"fired_pixels", layer.fired_pixels}});
  }
  Json set_points = Json::array();
  for (const LineSetPoints& line : header.set_points) {
    set_points.push_back({{"direction", direction_name(line.reverse)},
                          {"stage", line.backwards ? "backwards" : "onwards"},
                          {"set_points", line.u_counts.size()}});
  }
  Json described = {{"format_version", header.format_version},
                    {"job_path", header.job_path},
                    {"fires", polarity_name(header.fires)},
                    {"lines_along", header.lines_along == LinesAlong::rows ? "rows" : "columns"},
                    {"plan", Json::parse(plan_to_json(header.plan))},
                    {"set_points", set_points},
                    {"sources", sources},
                    {"layers", layers},
                    {"layer_of_revolution", header.layer_of_revolution}};
  if (!header.bits_of_layer.empty()) {
    described["bits_of_layer"] = header.bits_of_layer;
  }
  return described;
}

std::string text_of(const ProgramHeader& header, const std::string& path) {
  std::string text = fmt::format("program   {} (format {}){}\n", path, header.format_version,
                                 header.job_path.empty() ? std::string() : ", made from " + header.job_path);
  text += plan_text(header.plan);
  if (!header.set_points.empty()) {
    text += fmt::format("scanner   {} set-points a line, for {} kinds of lines\n", header.set_points[0].u_counts.size(),
                        header.set_points.size());
  }
  if (header.plan.path) {
    return text + fmt::format("pulses    {} fire\n", header.layers.empty() ? 0 : header.layers[0].fired_pixels);
  }
  text += fmt::format("images    {} fires; {} sources, {} stored layers, {} {}\n", polarity_name(header.fires),
                      header.sources.size(), stored_layers(header), header.layer_of_revolution.size(),
                      turns_name(header.plan));
  if (header.plan.carriage) {
    return text;  // what a revolution shows is none of the layers
  }
  constexpr std::size_t kShown = 20;
  for (std::size_t i = 0; i < header.layers.size() && i < kShown; ++i) {
    const StoredLayer& layer = header.layers[i];
    const SourceImage& source = header.sources[static_cast<std::size_t>(layer.source)];
    const double share =
        100.0 * static_cast<double>(layer.fired_pixels) /
        (static_cast<double>(header.plan.line.pixels) * static_cast<double>(header.plan.rotary.lines_per_revolution));
    text += fmt::format("layer {:<4}{} page {} level {}: {:.2f} % fires\n", i, source.path, source.page, layer.level,
                        share);
  }
  if (header.layers.size() > kShown) {
    text += fmt::format("... and {} more layers (--json lists them)\n", header.layers.size() - kShown);
  }
  return text;
}

}  // namespace

void add_inspect(CLI::App& app, Command& command) {
  CLI::App* verb = add_verb(app, command, "inspect", "What is in a program file");
  const auto path = std::make_shared<std::string>();
  verb->add_option("PROGRAM", *path, "Program file (.grv)")->required();
  verb->callback([&command, path] {
    command.run = [&command, path]() -> Result<int> {
      GRAVURE_TRY(const std::unique_ptr<LineSource> program, open_grv(*path));
      if (command.json) {
        print_json(json_of(program->header()));
      } else {
        print(text_of(program->header(), *path));
      }
      return kDone;
    };
  });
}

}  // namespace gravure::cli
