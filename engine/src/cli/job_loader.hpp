#pragma once

#include <optional>
#include <string>

#include "gravure/core/job.hpp"
#include "gravure/core/plan.hpp"
#include "gravure/core/program.hpp"
#include "gravure/formats/grv.hpp"
#include "gravure/formats/image_stack.hpp"
#include "gravure/pipeline/layer_reader.hpp"
#include "verb.hpp"

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

/// Compiles a loaded job (with its images) to the program file `output`; layers that no revolution uses are left out.
Result<ProgramHeader> compile_job(const LoadedJob& loaded, const ImageOpener& opener, const std::string& output,
                                  const GrvOptions& grv, const Command& command);

/// Settings of a stack that come from the job.
LayerStack stack_settings(const ImageSettings& image, const Plan& plan);

}  // namespace gravure::cli
