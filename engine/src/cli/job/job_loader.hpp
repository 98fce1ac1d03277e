#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "gravure/core/exposure_map.hpp"
#include "gravure/core/job.hpp"
#include "gravure/core/plan.hpp"
#include "gravure/core/program.hpp"
#include "gravure/formats/grv.hpp"
#include "gravure/formats/image_stack.hpp"
#include "gravure/pipeline/layer_reader.hpp"
#include "gravure/scan/job_trajectory.hpp"
#include "gravure/scan/joint_reach.hpp"
#include "verb.hpp"

namespace gravure::cli {

/// A job with its plan, and the headers of its images where they are there.
struct LoadedJob {
  Job job;
  std::optional<ImageStack> images;
  std::vector<SourceImage> files;                 ///< that the job names beside its images (ProgramHeader::files)
  std::int64_t columns = 0;                       ///< pixels of an image line
  Plan plan;                                      ///< its warnings hold those of the images and the scanner, too
  std::optional<scan::JobTrajectory> trajectory;  ///< none without a scanner
  std::vector<scan::JointReach> joints;           ///< of the machine file, where there is one; within their limits
};

/// Reads and plans a job. A job that gives pixels_per_line can be planned without its images, unless `need_images`.
Result<LoadedJob> load_job(const std::string& path, const ImageOpener& opener, bool need_images);

/// Prints the warnings of a loaded job, each with the place of the first key of the job that it names.
void warn_of(const LoadedJob& loaded);

/// What to compile of a job, and into what.
struct CompileRequest {
  std::string output;
  GrvOptions grv;
  std::optional<Shard> shard;  ///< these revolutions alone, as a shard
  bool resume = false;         ///< leave an output that is whole and of this job as it is
};
struct CompileOutcome {
  ProgramHeader header;
  bool kept = false;  ///< the output was there already
};

/// Compiles a loaded job (with its images); layers that no revolution uses are left out, those that show the same
/// picture are stored once.
Result<CompileOutcome> compile_job(const LoadedJob& loaded, const ImageOpener& opener, const CompileRequest& request,
                                   const Command& command);

/// Which layer a program stores for each of its revolutions: one for each image, band and direction of the stage,
/// numbered as they are first used; in helical mode one for each revolution.
class StoredLayers {
 public:
  /// `layers`: images there are.
  StoredLayers(const Plan& plan, LayerOrder order, std::int64_t layers)
      : plan_(plan), map_(plan), order_(order), layers_(layers) {}
  /// Revolutions are asked for one after the other, from 0; or from a later one on, as if it were the first.
  std::uint32_t number(std::int64_t revolution);
  std::int64_t image_layer(std::int64_t revolution) const;

 private:
  const Plan& plan_;
  ExposureMap map_;
  LayerOrder order_;
  std::int64_t layers_;
  std::map<std::tuple<std::int64_t, std::int64_t, bool>, std::uint32_t> known_;  // band, image, backwards
};

/// Settings of a stack that come from the job.
LayerStack stack_settings(const Job& job, const Plan& plan);

}  // namespace gravure::cli
