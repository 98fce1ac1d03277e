#include "program_files.hpp"

#include <filesystem>

#include "gravure/emulator/emulated_device.hpp"
#include "gravure/formats/image_files.hpp"
#include "gravure/formats/job_file.hpp"
#include "job_loader.hpp"

namespace gravure::cli {
namespace {

namespace fs = std::filesystem;

bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

}  // namespace

DeviceFactory emulated_devices() {
  return [](PinObserver& observer) { return std::make_unique<emulator::EmulatedDevice>(&observer); };
}

std::string locate_source(const SourceImage& source, const ProgramHeader& header, const std::string& program_path,
                          const std::string& images_folder) {
  std::vector<fs::path> places;
  if (images_folder.empty()) {
    const fs::path job = fs::path(program_path).parent_path() / header.job_path;
    places = {job.parent_path() / source.path, fs::path(header.job_path).parent_path() / source.path};
  } else {
    places = {fs::path(images_folder) / source.path, fs::path(images_folder) / fs::path(source.path).filename()};
  }
  for (const fs::path& place : places) {
    if (is_file(place)) {
      return place.lexically_normal().string();
    }
  }
  return {};
}

Result<void> refuse_overwrite(const std::string& output, const std::vector<std::string>& inputs) {
  for (const std::string& input : inputs) {
    std::error_code ignored;
    if (fs::equivalent(output, input, ignored)) {
      return Error{ErrorCode::bad_argument, "output " + output + " is the input " + input + ": give another file name"};
    }
  }
  return {};
}

Result<FoundImages> find_images(const ProgramHeader& header, const std::string& program_path,
                                const std::string& images_folder, const ImageOpener& opener) {
  FoundImages found;
  std::vector<std::string> paths;
  for (const SourceImage& source : header.sources) {
    paths.push_back(locate_source(source, header, program_path, images_folder));
    if (paths.back().empty() && (found.missing.empty() || found.missing.back() != source.path)) {
      found.missing.push_back(source.path);
    }
  }
  if (!found.missing.empty() || paths.empty()) {
    return found;
  }
  GRAVURE_TRY(const Job job, parse_job(header.job_text, header.job_path));
  LayerStack stack = stack_settings(job.image, header.plan);
  stack.random_access = true;
  for (std::size_t i = 0; i < header.sources.size(); ++i) {
    const SourceImage& source = header.sources[i];
    GRAVURE_TRY(const std::unique_ptr<ImageSource> image, opener.open(paths[i], source.page));
    const ImageInfo& info = image->info();
    if (info.width != source.width || info.height != source.height || (i > 0 && info.samples != stack.samples)) {
      return Error{ErrorCode::bad_file, paths[i] + ": page " + std::to_string(source.page) + " is " +
                                            std::to_string(info.width) + " x " + std::to_string(info.height) +
                                            ", the program was made from " + std::to_string(source.width) + " x " +
                                            std::to_string(source.height) + ": compile again, or give --images DIR"};
    }
    stack.samples = info.samples;
    stack.random_access = stack.random_access && info.random_access;
  }
  for (const StoredLayer& layer : header.layers) {
    const auto source = static_cast<std::size_t>(layer.source);
    stack.layers.push_back({paths[source], header.sources[source].page, layer.level});
  }
  found.stack = std::move(stack);
  return found;
}

const char* direction_name(bool reverse) {
  return reverse ? "reverse" : "forward";
}

const char* polarity_name(Fires fires) {
  return fires == Fires::white ? "white" : "black";
}

}  // namespace gravure::cli
