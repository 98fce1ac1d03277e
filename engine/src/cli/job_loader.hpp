#pragma once

#include <optional>
#include <string>

#include "gravure/core/job.hpp"
#include "gravure/core/plan.hpp"
#include "gravure/core/program.hpp"
#include "gravure/formats/image_stack.hpp"
#include "gravure/pipeline/layer_reader.hpp"

namespace gravure::cli {

/// A job with its plan, and the headers of its images where they are there.
struct LoadedJob {
  Job job;
  std::optional<ImageStack> images;
  std::int64_t pixels_per_line = 0;
  std::int64_t revolutions = 0;
  Plan plan;  ///< its warnings hold those of the images, too
};

/// Reads and plans a job. A job that gives pixels_per_line can be planned without its images, unless `need_images`.
Result<LoadedJob> load_job(const std::string& path, const ImageOpener& opener, bool need_images);

/// What compile() takes: the header of the program (layers that no revolution uses left out) and its image stack.
struct Compilation {
  ProgramHeader header;
  LayerStack stack;
};
Result<Compilation> prepare_compilation(const LoadedJob& loaded, const std::string& program_path);

/// Settings of a stack that come from the job.
LayerStack stack_settings(const ImageSettings& image, const Plan& plan);

}  // namespace gravure::cli
