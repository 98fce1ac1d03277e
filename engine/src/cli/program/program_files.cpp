#include "program/program_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>

#include "gravure/emulator/emulated_device.hpp"
#include "gravure/formats/image_files.hpp"
#include "gravure/formats/image_kind.hpp"
#include "gravure/formats/job_file.hpp"
#include "job/job_loader.hpp"

namespace gravure::cli {
namespace {

namespace fs = std::filesystem;

bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

std::vector<fs::path> places_of(const SourceImage& source, const ProgramHeader& header, const std::string& program_path,
                                const std::string& images_folder) {
  if (images_folder.empty()) {
    const fs::path job = fs::path(program_path).parent_path() / header.job_path;
    return {job.parent_path() / source.path, fs::path(header.job_path).parent_path() / source.path};
  }
  std::vector<fs::path> places = {fs::path(images_folder) / source.path};
  if (const fs::path name = fs::path(source.path).filename(); name != source.path) {
    places.push_back(fs::path(images_folder) / name);
  }
  return places;
}

/// Also where neither is there yet.
bool same_file(const fs::path& a, const fs::path& b) {
  std::error_code ignored;
  if (fs::equivalent(a, b, ignored)) {
    return true;
  }
  const fs::path place = fs::weakly_canonical(fs::absolute(a, ignored), ignored);
  return !place.empty() && place == fs::weakly_canonical(fs::absolute(b, ignored), ignored);
}

/// The first bytes of a file, as many as there are up to `count`.
std::string first_bytes(const std::string& path, std::size_t count) {
  std::string bytes(count, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(bytes.data(), static_cast<std::streamsize>(count));
  bytes.resize(static_cast<std::size_t>(file.gcount()));
  return bytes;
}

/// Byte 25 of a PNG is its colour type: `preview` writes 2, and what is a layer or a depth map has another.
bool is_preview(const std::string& path) {
  const std::string start = first_bytes(path, 26);
  return start.size() == 26 && start[25] == 2;
}

/// What lies at `output` and costs work to have again, in words; empty where nothing does, or where it is what is
/// written there. Names decide where the content is text, the content where it is not.
std::string lost_by(const std::string& output, Writes writes) {
  if (writes == Writes::journal || !is_file(output)) {
    return {};
  }
  std::string ending = fs::path(output).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  if (ending == ".toml") {
    return "a TOML file (a job, a machine)";
  }
  for (const char* const mesh : {".stl", ".ply", ".pcd"}) {
    if (ending == mesh) {
      return "a mesh or scan";
    }
  }
  const std::string start = first_bytes(output, 16);
  if (start.rfind("gravure program", 0) == 0 || start.rfind("gravure shard", 0) == 0) {
    return writes == Writes::program ? "" : "a program of gravure";
  }
  const Result<ImageKind> kind = image_kind(output);
  if (!kind || (writes == Writes::picture && kind.value() == ImageKind::tiff) ||
      (writes == Writes::preview && kind.value() == ImageKind::png && is_preview(output))) {
    return {};
  }
  return fmt::format("an image ({})", image_kind_name(kind.value()));
}

}  // namespace

DeviceFactory emulated_devices() {
  return [](PinObserver& observer) { return std::make_unique<emulator::EmulatedDevice>(&observer); };
}

std::string locate_source(const SourceImage& source, const ProgramHeader& header, const std::string& program_path,
                          const std::string& images_folder) {
  for (const fs::path& place : places_of(source, header, program_path, images_folder)) {
    if (is_file(place)) {
      return place.lexically_normal().string();
    }
  }
  return {};
}

std::string relative_to(const std::string& path, const fs::path& folder) {
  std::error_code failed;
  const fs::path near = fs::proximate(path, folder.empty() ? fs::path(".") : folder, failed);
  return failed ? path : near.generic_string();
}

Result<void> refuse_overwrite(const std::string& output, const std::vector<std::string>& inputs, Writes writes) {
  for (const std::string& input : inputs) {
    if (same_file(output, input)) {
      return Error{ErrorCode::bad_argument,
                   fmt::format("output {} is the input {}: give another file name", output, input)};
    }
  }
  if (const std::string lost = lost_by(output, writes); !lost.empty()) {
    return Error{ErrorCode::bad_argument,
                 fmt::format("output {} is there already and is {}, which would be lost: give another file name, or "
                             "move that file away first",
                             output, lost)};
  }
  return {};
}

Result<void> refuse_overwrite(const std::vector<OutputFile>& outputs, const std::vector<std::string>& inputs) {
  for (auto output = outputs.begin(); output != outputs.end(); ++output) {
    if (output->path.empty()) {
      continue;
    }
    GRAVURE_CHECK(refuse_overwrite(output->path, inputs, output->writes));
    const auto other = std::find_if(outputs.begin(), output, [&output](const OutputFile& before) {
      return !before.path.empty() && same_file(before.path, output->path);
    });
    if (other != output) {
      return Error{ErrorCode::bad_argument, fmt::format("{} {} and {} {} are one file: give two", other->option,
                                                        other->path, output->option, output->path)};
    }
  }
  return {};
}

std::vector<std::string> named_files(const Job& job) {
  std::vector<std::string> names;
  for (const std::optional<std::string>& file : {job.scanner.field_grid, job.machine.file}) {
    if (file) {
      names.push_back(*file);
    }
  }
  return names;
}

std::vector<std::string> files_of(const Job& job) {
  std::vector<std::string> files = {job.path};
  for (const std::string& name : named_files(job)) {
    files.push_back((fs::path(job.path).parent_path() / name).string());
  }
  return files;
}

std::vector<std::string> inputs_of_program(const std::string& path) {
  const Result<std::unique_ptr<LineSource>> program = open_grv(path);
  if (!program) {
    return {path};  // whoever reads it says why
  }
  return inputs_of_program(path, program.value()->header());
}

std::vector<std::string> inputs_of_program(const std::string& path, const ProgramHeader& header) {
  std::vector<std::string> inputs = {path};
  const std::string job_path = (fs::path(path).parent_path() / header.job_path).string();
  inputs.push_back(job_path);
  if (const Result<Job> job = parse_job(header.job_text, job_path); job) {
    const std::vector<std::string> files = files_of(job.value());
    inputs.insert(inputs.end(), files.begin(), files.end());
  }
  for (const SourceImage& source : header.sources) {
    if (const std::string place = locate_source(source, header, path, {}); !place.empty()) {
      inputs.push_back(place);
    }
  }
  return inputs;
}

Result<void> check_tiff_name(const std::string& verb, const std::string& output) {
  std::string suffix = std::filesystem::path(output).extension().string();
  std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (suffix.empty() || suffix == ".tif" || suffix == ".tiff") {
    return {};
  }
  return Error{ErrorCode::bad_argument, "--output " + output + ": " + verb + " writes TIFF alone: call it " +
                                            std::filesystem::path(output).replace_extension(".tif").string() +
                                            " and convert it with another program"};
}

Result<FoundImages> find_images(const ProgramHeader& header, const std::string& program_path,
                                const std::string& images_folder, const ImageOpener& opener) {
  FoundImages found;
  std::vector<std::string>& paths = found.paths;
  bool any = false;
  for (const SourceImage& source : header.sources) {
    paths.push_back(locate_source(source, header, program_path, images_folder));
    any = any || !paths.back().empty();
    if (paths.back().empty()) {
      paths.back() = places_of(source, header, program_path, images_folder).front().lexically_normal().string();
      std::string sought = source.path;
      for (const fs::path& place : places_of(source, header, program_path, images_folder)) {
        sought += (sought == source.path ? ": not at " : ", nor at ") + place.lexically_normal().string();
      }
      if (found.missing.empty() || found.missing.back() != sought) {
        found.missing.push_back(sought);
      }
    }
  }
  if (!any) {
    return found;
  }
  if (header.plan.carriage && header.sources.size() != 1 &&
      static_cast<std::int64_t>(header.sources.size()) != header.plan.carriage->layers) {
    return Error{ErrorCode::bad_file, "the program has " + std::to_string(header.sources.size()) + " sources for " +
                                          std::to_string(header.plan.carriage->layers) + " layers: compile it again"};
  }
  GRAVURE_TRY(const Job job, parse_job(header.job_text, header.job_path));
  LayerStack stack = stack_settings(job, header.plan);
  const auto layers = static_cast<std::int64_t>(header.layers.size());
  for (std::int64_t layer = 0; layer < (header.plan.carriage ? header.plan.carriage->layers : layers); ++layer) {
    const LayerOrigin origin = origin_of(header, layer);
    stack.layers.push_back({paths[origin.source], header.sources[origin.source].page, origin.level});
  }
  learn_images(stack, opener);
  found.stack = std::move(stack);
  return found;
}

LayerOrigin origin_of(const ProgramHeader& header, std::int64_t layer) {
  if (!header.plan.carriage) {
    const StoredLayer& stored = header.layers[static_cast<std::size_t>(layer)];
    return {static_cast<std::size_t>(stored.source), stored.level};
  }
  const bool depth_map = header.sources.size() == 1;  // a stack has a source for each layer
  return depth_map ? LayerOrigin{0, layer} : LayerOrigin{static_cast<std::size_t>(layer), 0};
}

std::size_t different_revolutions(const ProgramHeader& header) {
  const std::vector<std::uint32_t>& bits = header.bits_of_layer;
  return bits.empty() ? header.layers.size() : std::size_t{*std::max_element(bits.begin(), bits.end())} + 1;
}

const char* turns_name(const Plan& plan) {
  return plan.mode == Mode::flat ? "passes" : "revolutions";
}

const char* direction_name(bool reverse) {
  return reverse ? "reverse" : "forward";
}

const char* polarity_name(Fires fires) {
  return fires == Fires::white ? "white" : "black";
}

}  // namespace gravure::cli
