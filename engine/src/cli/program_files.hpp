#pragma once

#include <memory>
#include <optional>
#include <string>

#include "gravure/core/layer_lines.hpp"
#include "gravure/core/program.hpp"
#include "gravure/pipeline/layer_reader.hpp"
#include "gravure/twin/exposure.hpp"

namespace gravure::cli {

/// Devices emulated in this process.
DeviceFactory emulated_devices();

/// The images a program was made from, found again. `missing` says which are not there, and where they were sought; the
/// others are still in the stack, and there is none only where all are missing.
struct FoundImages {
  std::optional<LayerStack> stack;
  std::vector<std::string> missing;
};

/// Looks for the sources of a program: below `images_folder` if given (by their path in the program, else by their name
/// alone), else where its job file is or was, relative to the program.
Result<FoundImages> find_images(const ProgramHeader& header, const std::string& program_path,
                                const std::string& images_folder, const ImageOpener& opener);

/// Where a source of a program lies now, by the same rules; empty if nowhere.
std::string locate_source(const SourceImage& source, const ProgramHeader& header, const std::string& program_path,
                          const std::string& images_folder);

/// Fails with bad_argument where `output` is one of the files that are being read.
Result<void> refuse_overwrite(const std::string& output, const std::vector<std::string>& inputs);

/// "forward" or "reverse".
const char* direction_name(bool reverse);
const char* polarity_name(Fires fires);

}  // namespace gravure::cli
