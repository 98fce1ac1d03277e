#include "job/job_loader.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <tuple>
#include <utility>

#include "gravure/core/file_output.hpp"
#include "gravure/formats/image_files.hpp"
#include "gravure/formats/job_file.hpp"
#include "gravure/pipeline/compile.hpp"
#include "gravure/pipeline/merge.hpp"
#include "gravure/sync/make_plan.hpp"
#include "job/job_machine.hpp"
#include "job/job_scanner.hpp"
#include "job/source_hashes.hpp"
#include "program/program_files.hpp"
#include "program/program_parts.hpp"

namespace gravure::cli {
namespace {

namespace fs = std::filesystem;

bool names_images(const ImageSettings& image) {
  return !image.files.empty() || image.depth_map.has_value();
}

bool images_are_there(const Job& job) {
  const std::string folder = fs::path(job.path).parent_path().string();
  const std::vector<std::string> patterns =
      job.image.depth_map ? std::vector<std::string>{*job.image.depth_map} : job.image.files;
  return static_cast<bool>(expand_patterns(folder.empty() ? "." : folder, patterns));
}

}  // namespace

Result<LoadedJob> load_job(const std::string& path, const ImageOpener& opener, bool need_images) {
  LoadedJob loaded;
  GRAVURE_TRY(loaded.job, read_job(path));
  GRAVURE_TRY(const std::optional<kinematics::Machine> machine, read_machine_of(loaded.job));
  GRAVURE_CHECK(read_scanner_files(loaded.job));
  for (const std::string& name : named_files(loaded.job)) {
    GRAVURE_TRY(const std::string hash, sha256_file((fs::path(path).parent_path() / name).string()));
    loaded.files.push_back({name, 0, 0, 0, hash});
  }
  const ImageSettings& image = loaded.job.image;
  if (names_images(image)) {
    // A job that says its pixels can be planned before its images are there; images that are there must be good.
    if (need_images || !image.pixels_per_line || images_are_there(loaded.job)) {
      GRAVURE_TRY(loaded.images, scan_stack(loaded.job, opener));
    }
  } else if (need_images) {
    return Error{ErrorCode::bad_argument,
                 loaded.job.place_of("image") + "[image] names no files: give image.files or image.depth_map"};
  }
  std::optional<std::int64_t> layers = image.levels;
  std::int64_t columns = image.pixels_per_line.value_or(0);
  if (loaded.images) {
    layers = loaded.images->layers;
    columns = scan_size(image, loaded.images->width(), loaded.images->height()).pixels_per_line;
    if (image.pixels_per_line && *image.pixels_per_line != columns) {
      return Error{ErrorCode::bad_argument, loaded.job.place_of("image.pixels_per_line") +
                                                "image.pixels_per_line = " + std::to_string(*image.pixels_per_line) +
                                                ": the images have " + std::to_string(columns)};
    }
  }
  GRAVURE_TRY(loaded.columns, picture_columns(loaded.job, columns));
  GRAVURE_TRY(const std::int64_t exposures, resolve_revolutions(loaded.job, layers));
  GRAVURE_TRY(loaded.plan, make_plan(loaded.job, loaded.columns, exposures));
  GRAVURE_TRY(loaded.joints, reach_of_machine(machine, loaded.job, loaded.plan));
  GRAVURE_TRY(loaded.trajectory, check_trajectory(loaded.job, loaded.plan));
  if (loaded.images) {
    GRAVURE_TRY(const std::vector<std::string> warnings, check_stack(loaded.plan, loaded.job, *loaded.images));
    std::vector<std::string>& all = loaded.plan.warnings;
    all.insert(all.end(), loaded.images->warnings.begin(), loaded.images->warnings.end());
    all.insert(all.end(), warnings.begin(), warnings.end());
  } else if (names_images(image)) {
    loaded.plan.warnings.emplace_back("the images are not there yet; planned with image.pixels_per_line = " +
                                      std::to_string(columns));
  }
  return loaded;
}

void warn_of(const LoadedJob& loaded) {
  for (const std::string& warning : loaded.plan.warnings) {
    std::size_t first = std::string::npos;
    std::string place;
    for (const auto& [key, at] : loaded.job.places) {
      const std::size_t found = key.find('.') == std::string::npos ? std::string::npos : warning.find(key);
      const std::size_t end = found == std::string::npos ? found : found + key.size();
      const bool whole = end < warning.size() && std::string_view(" :,;)").find(warning[end]) != std::string_view::npos;
      if (whole && found < first) {
        first = found;
        place = loaded.job.place_of(key);
      }
    }
    warn(place + warning);
  }
}

std::int64_t StoredLayers::image_layer(std::int64_t revolution) const {
  return layer_of_revolution(order_, layers_, revolution % revolutions_per_band(plan_));
}

std::uint32_t StoredLayers::number(std::int64_t revolution) {
  if (plan_.carriage) {
    return static_cast<std::uint32_t>(revolution);
  }
  const auto next = static_cast<std::uint32_t>(known_.size());
  const std::int64_t band = revolution / revolutions_per_band(plan_);
  return known_.try_emplace({band, image_layer(revolution), map_.runs_backwards(revolution)}, next).first->second;
}

LayerStack stack_settings(const Job& job, const Plan& plan) {
  const ImageSettings& image = job.image;
  LayerStack stack;
  stack.tiles = tile_grid(job.repeat, image.lines_along);
  stack.lines = plan.rotary.lines_per_revolution;
  stack.pixels = image_columns(plan);
  stack.lines_along = image.lines_along;
  stack.fires = image.fires;
  stack.threshold = image.threshold;
  stack.levels = image.depth_map ? image.levels.value_or(0) : 0;
  stack.depth_min = image.depth_min;
  stack.depth_max = image.depth_max;
  return stack;
}

namespace {

/// What compile() takes.
struct Compilation {
  ProgramHeader header;
  LayerStack stack;
  std::vector<std::string> source_files;  ///< of header.sources, where they lie
};

/// The images as they become sources of the program, each once.
class Sources {
 public:
  Sources(const ImageStack& images, fs::path job_folder, Compilation& made)
      : images_(images), job_folder_(std::move(job_folder)), made_(made) {}

  /// Number of the source that a layer of the stack comes from.
  std::int64_t of_layer(std::int64_t layer) {
    const std::int64_t index = images_.depth_map ? 0 : layer;
    const auto [source, is_new] = known_.try_emplace(index, static_cast<std::int64_t>(made_.source_files.size()));
    if (is_new) {
      const StackImage& image = images_.images[static_cast<std::size_t>(index)];
      made_.source_files.push_back(image.path);
      made_.header.sources.push_back(
          {relative_to(image.path, job_folder_), image.page, image.info.width, image.info.height, ""});
    }
    return source->second;
  }
  LayerInput input(std::int64_t layer) const {
    const StackImage& image = images_.images[static_cast<std::size_t>(images_.depth_map ? 0 : layer)];
    return {image.path, image.page, images_.depth_map ? layer : 0};
  }

 private:
  const ImageStack& images_;
  fs::path job_folder_;
  Compilation& made_;
  std::map<std::int64_t, std::int64_t> known_;  // image of the stack -> source of the program
};

/// The images that are exposed, in each band and in each direction of the stage.
void add_layers(const LoadedJob& loaded, const fs::path& job_folder, const Shard& range, Compilation& made) {
  ProgramHeader& header = made.header;
  Sources sources(*loaded.images, job_folder, made);
  StoredLayers stored(loaded.plan, loaded.job.image.order, loaded.images->layers);
  for (std::int64_t r = range.first; r < range.end; ++r) {
    header.layer_of_revolution.push_back(stored.number(r));
    if (header.layer_of_revolution.back() < header.layers.size()) {
      continue;
    }
    StoredLayer layer;
    layer.starts_reverse = line_is_reverse(loaded.plan, r, 0);
    layer.source = sources.of_layer(stored.image_layer(r));
    made.stack.layers.push_back(sources.input(stored.image_layer(r)));
    layer.level = made.stack.layers.back().level;
    header.layers.push_back(layer);
  }
}

/// Helical: every revolution shows a part of every image, no two the same.
void add_helical_layers(const ImageStack& images, const fs::path& job_folder, const Shard& range, Compilation& made) {
  ProgramHeader& header = made.header;
  Sources sources(images, job_folder, made);
  for (std::int64_t layer = 0; layer < images.layers; ++layer) {
    sources.of_layer(layer);
    made.stack.layers.push_back(sources.input(layer));
  }
  for (std::int64_t r = range.first; r < range.end; ++r) {
    StoredLayer revolution;
    revolution.starts_reverse = line_is_reverse(header.plan, r, 0);
    header.layers.push_back(revolution);
    header.layer_of_revolution.push_back(static_cast<std::uint32_t>(r - range.first));
  }
}

Compilation prepare_compilation(const LoadedJob& loaded, const CompileRequest& request) {
  Compilation made;
  const ImageStack& images = *loaded.images;
  const fs::path job_folder = fs::path(loaded.job.path).parent_path();
  ProgramHeader& header = made.header;
  header.plan = loaded.plan;
  header.job_text = loaded.job.text;
  header.job_path = relative_to(loaded.job.path, fs::path(request.output).parent_path());
  header.fires = loaded.job.image.fires;
  header.lines_along = loaded.job.image.lines_along;
  header.files = loaded.files;
  if (loaded.trajectory) {
    header.set_points = loaded.trajectory->stored_set_points();
  }
  made.stack = stack_settings(loaded.job, loaded.plan);
  made.stack.samples = images.images.front().info.samples;
  made.stack.decoder_bytes = 0;
  for (const StackImage& image : images.images) {
    made.stack.decoder_bytes =
        std::max(*made.stack.decoder_bytes, tiled_info(image.info, made.stack.tiles).decoder_bytes);
    made.stack.rows_per_block = std::max(made.stack.rows_per_block, image.info.rows_per_block);
  }
  made.stack.random_access = std::all_of(images.images.begin(), images.images.end(),
                                         [](const StackImage& image) { return image.info.random_access; });

  header.shard = request.shard;
  const Shard range = request.shard.value_or(Shard{0, loaded.plan.job.revolutions, images.layers});
  if (loaded.plan.carriage) {
    add_helical_layers(images, job_folder, range, made);
  } else {
    add_layers(loaded, job_folder, range, made);
  }
  return made;
}

Result<void> fill_hashes(ProgramHeader& header, SourceHashes& hashes) {
  ProgressBar bar("SHA-256 of the images", "MB");
  GRAVURE_TRY(const std::vector<std::string> found, hashes.wait(bar));
  for (std::size_t i = 0; i < found.size(); ++i) {
    header.sources[i].sha256 = found[i];
  }
  return {};
}

/// The bar, and the hashes in step with it.
class CompileProgress final : public Progress {
 public:
  explicit CompileProgress(SourceHashes& hashes) : hashes_(hashes) {}
  void update(std::int64_t done, std::int64_t total) override {
    hashes_.go_on(done, total);
    bar_.update(done, total);
  }

 private:
  SourceHashes& hashes_;
  ProgressBar bar_{"compile"};
};

}  // namespace

Result<CompileOutcome> compile_job(const LoadedJob& loaded, const ImageOpener& opener, const CompileRequest& request,
                                   const Command& command) {
  CompileOptions options;
  options.cancel = &cancel_token();  // before there is a temporary file: from here on Ctrl-C takes it away again
  Compilation made = prepare_compilation(loaded, request);
  SourceHashes hashes(made.source_files, command.threads == 1 ? SourceHashes::Begin::in_step : SourceHashes::Begin::now,
                      *options.cancel);
  if (request.resume) {  // what is there is judged by them
    GRAVURE_CHECK(fill_hashes(made.header, hashes));
    GRAVURE_TRY(std::optional<ProgramHeader> there, finished_output(made.header, request, *options.cancel));
    if (there) {
      return CompileOutcome{std::move(*there), true};
    }
  }
  GRAVURE_TRY(FileOutput output, FileOutput::create(request.output));
  GRAVURE_TRY(const std::unique_ptr<LineSink> sink,
              stage_grv(output, static_cast<std::int64_t>(made.header.layers.size()),
                        loaded.plan.rotary.lines_per_revolution, made.header.line_bytes(), request.grv));
  CompileProgress progress(hashes);
  options.memory_bytes = command.memory_bytes();
  options.threads = command.threads;
  options.progress = &progress;
  options.complete_header = [&hashes, &request](ProgramHeader& header) {
    return request.resume ? hashes.check_unchanged() : fill_hashes(header, hashes);
  };
  GRAVURE_TRY(ProgramHeader header, compile(std::move(made.header), made.stack, opener, *sink, options));
  if (!request.shard && may_share_bits(header)) {  // shards are compared when they are merged
    GRAVURE_TRY(std::optional<ProgramHeader> shared,
                write_shared(output.temporary_path(), request.output, request.grv));
    if (shared) {
      return CompileOutcome{std::move(*shared), false};
    }
  }
  GRAVURE_CHECK(output.commit());
  return CompileOutcome{std::move(header), false};
}

}  // namespace gravure::cli
