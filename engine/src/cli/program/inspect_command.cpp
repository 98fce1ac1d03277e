#include <fmt/format.h>

#include <memory>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "gravure/core/exposure_map.hpp"
#include "gravure/formats/grv.hpp"
#include "gravure/formats/plan_json.hpp"
#include "gravure/twin/unroll.hpp"
#include "job/plan_text.hpp"
#include "program/program_files.hpp"
#include "verb.hpp"

namespace gravure::cli {
namespace {

/// A layer of the image stack, numbered as `unroll --layer` does.
struct ShownLayer {
  LayerOrigin origin;
  std::optional<std::int64_t> fired_pixels;  ///< of the whole picture; none in helical mode
  std::int64_t revolutions = 0;              ///< that show it, or a part of it
};

std::vector<ShownLayer> shown_layers(const ProgramHeader& header) {
  std::vector<ShownLayer> shown;
  if (header.plan.path) {
    return shown;
  }
  const std::vector<std::int64_t> images = images_of_layers(header);
  const std::int64_t layers = image_layers(header);  // not for each of them: it goes through all
  for (std::int64_t layer = 0; layer < layers; ++layer) {
    shown.push_back({origin_of(header, layer), std::nullopt, header.plan.carriage ? header.plan.job.revolutions : 0});
  }
  std::set<std::pair<std::int64_t, std::int64_t>> counted;  // image and band: passes back show what others have shown
  for (std::size_t r = 0; r < header.layer_of_revolution.size() && !images.empty(); ++r) {
    const std::uint32_t stored = header.layer_of_revolution[r];
    ShownLayer& layer = shown[static_cast<std::size_t>(images[stored])];
    ++layer.revolutions;
    const std::int64_t revolution = header.first_revolution() + static_cast<std::int64_t>(r);
    if (counted.emplace(images[stored], revolution / revolutions_per_band(header.plan)).second) {
      layer.fired_pixels = layer.fired_pixels.value_or(0) + header.layers[stored].fired_pixels;
    }
  }
  return shown;
}

Json json_of(const ProgramHeader& header) {
  Json sources = Json::array();
  for (const SourceImage& source : header.sources) {
    sources.push_back({{"path", source.path},
                       {"page", source.page},
                       {"width", source.width},
                       {"height", source.height},
                       {"sha256", source.sha256}});
  }
  Json files = Json::array();
  for (const SourceImage& file : header.files) {
    files.push_back({{"path", file.path}, {"sha256", file.sha256}});
  }
  Json layers = Json::array();
  const std::vector<ShownLayer> shown = shown_layers(header);
  for (std::size_t layer = 0; layer < shown.size(); ++layer) {
    layers.push_back({{"layer", layer},
                      {"source", shown[layer].origin.source},
                      {"level", shown[layer].origin.level},
                      {"fired_pixels", shown[layer].fired_pixels ? Json(*shown[layer].fired_pixels) : Json(nullptr)},
                      {"revolutions", shown[layer].revolutions}});
  }
  const std::vector<std::int64_t> images = images_of_layers(header);
  Json stored = Json::array();
  for (std::size_t i = 0; i < header.layers.size(); ++i) {
    const StoredLayer& bits = header.layers[i];
    stored.push_back({{"layer", images.empty() ? Json(nullptr) : Json(images[i])},
                      {"starts", direction_name(bits.starts_reverse)},
                      {"fired_pixels", bits.fired_pixels}});
  }
  Json layer_of_revolution = Json::array();
  for (std::size_t r = 0; r < header.layer_of_revolution.size() && !images.empty(); ++r) {
    layer_of_revolution.push_back(images[header.layer_of_revolution[r]]);
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
                    {"files", files},
                    {"layers", layers},
                    {"layer_of_revolution", layer_of_revolution},
                    {"stored", stored},
                    {"stored_of_revolution", header.layer_of_revolution}};
  if (!header.bits_of_layer.empty()) {
    described["bits_of_stored"] = header.bits_of_layer;
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
  for (const SourceImage& file : header.plan.path ? header.sources : header.files) {
    text += fmt::format("file      {}, SHA-256 {}\n", file.path, file.sha256);
  }
  if (header.plan.path) {
    return text + fmt::format("pulses    {} fire\n", header.layers.empty() ? 0 : header.layers[0].fired_pixels);
  }
  const std::vector<ShownLayer> shown = shown_layers(header);
  text += fmt::format("images    {} fires; {} sources, {} layers, {} {} ({} different)\n", polarity_name(header.fires),
                      header.sources.size(), shown.size(), header.layer_of_revolution.size(), turns_name(header.plan),
                      different_revolutions(header));
  constexpr std::size_t kShown = 20;
  const double pixels =
      static_cast<double>(image_columns(header.plan)) * static_cast<double>(header.plan.rotary.lines_per_revolution);
  for (std::size_t i = 0; i < shown.size() && i < kShown; ++i) {
    const SourceImage& source = header.sources[shown[i].origin.source];
    text += fmt::format("layer {:<4}{} page {} level {}", i, source.path, source.page, shown[i].origin.level);
    if (shown[i].fired_pixels) {  // else helical: a revolution shows a part of every layer
      text += fmt::format(": {:.2f} % fires", 100.0 * static_cast<double>(*shown[i].fired_pixels) / pixels);
    }
    text += "\n";
  }
  if (shown.size() > kShown) {
    text += fmt::format("... and {} more layers (--json lists them)\n", shown.size() - kShown);
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
