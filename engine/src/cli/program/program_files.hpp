#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gravure/core/job.hpp"
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
  std::vector<std::string> paths;  ///< of each source, where it is or was sought first
  std::vector<std::string> missing;
};

/// Looks for the sources of a program: below `images_folder` if given (by their path in the program, else by their name
/// alone), else where its job file is or was, relative to the program.
Result<FoundImages> find_images(const ProgramHeader& header, const std::string& program_path,
                                const std::string& images_folder, const ImageOpener& opener);

/// Where a source of a program lies now, by the same rules; empty if nowhere.
std::string locate_source(const SourceImage& source, const ProgramHeader& header, const std::string& program_path,
                          const std::string& images_folder);

/// Where image `layer` of a program comes from: number of its source, and its slice of a depth map (else 0).
struct LayerOrigin {
  std::size_t source = 0;
  std::int64_t level = 0;
};
LayerOrigin origin_of(const ProgramHeader& header, std::int64_t layer);

/// `path` as seen from `folder` where that is possible, so that a job, its files and its program can move together.
std::string relative_to(const std::string& path, const std::filesystem::path& folder);

/// What a verb writes: earlier outputs of the same kind may be written anew.
enum class Writes : std::uint8_t {
  text,     ///< tables, pages, figures, recordings
  program,  ///< or a shard of one
  picture,  ///< bilevel TIFF
  preview,  ///< PNG in colour, which no job takes for a layer
  journal,  ///< judged by whoever opens it: a run goes on in it
};

/// Fails with bad_argument where `output` is one of the files that are being read, or where a file of another kind lies
/// that a person has made or waited for: a job or machine file (TOML), a program, an image, a mesh or scan.
Result<void> refuse_overwrite(const std::string& output, const std::vector<std::string>& inputs,
                              Writes writes = Writes::text);

/// A file to write, with the option that names it; an empty path asks for none.
struct OutputFile {
  std::string_view option;
  std::string path;
  Writes writes = Writes::text;
};
/// The same of each of `outputs`; also where two of them are one file: by path, another way to the same folder, or a
/// link.
Result<void> refuse_overwrite(const std::vector<OutputFile>& outputs, const std::vector<std::string>& inputs);

/// bad_argument where an output of `verb` has the name of another format: what is written is TIFF, whatever it is
/// called.
Result<void> check_tiff_name(const std::string& verb, const std::string& output);

/// What a job names beside its pictures, as it names it: field grid and machine file.
std::vector<std::string> named_files(const Job& job);
/// A job file and what it names beside its pictures, each where it lies.
std::vector<std::string> files_of(const Job& job);
/// A program and what it was made from, as far as it tells: no output may take the place of one of them.
std::vector<std::string> inputs_of_program(const std::string& path);
/// The same of one that is open.
std::vector<std::string> inputs_of_program(const std::string& path, const ProgramHeader& header);

/// How many different revolutions a program holds: those that expose the same are stored once.
std::size_t different_revolutions(const ProgramHeader& header);

/// What a job counts: "revolutions", or "passes" in flat mode.
const char* turns_name(const Plan& plan);
/// "forward" or "reverse".
const char* direction_name(bool reverse);
const char* polarity_name(Fires fires);

}  // namespace gravure::cli
