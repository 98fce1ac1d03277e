#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "gravure/twin/unroll.hpp"
#include "program/program_files.hpp"
#include "program/program_parts.hpp"
#include "verb.hpp"

namespace gravure::cli {
namespace {

struct MergeArguments {
  std::vector<std::string> shards;
  std::string output;
};

Result<int> run_merge(const MergeArguments& options, const Command& command) {
  GRAVURE_CHECK(refuse_overwrite(options.output, options.shards, Writes::program));
  GRAVURE_TRY(const ProgramHeader header, merge_shards(options.shards, options.output));
  if (command.json) {
    print_json({{"program", options.output},
                {"shards", options.shards.size()},
                {"revolutions", header.layer_of_revolution.size()},
                {"layers", image_layers(header)},
                {"different_revolutions", different_revolutions(header)}});
  } else {
    print(fmt::format("{}: {} {} ({} different) from {} shards\n", options.output, header.layer_of_revolution.size(),
                      turns_name(header.plan), different_revolutions(header), options.shards.size()));
  }
  return kDone;
}

}  // namespace

void add_merge(CLI::App& app, Command& command) {
  CLI::App* verb =
      add_verb(app, command, "merge", "Shards of a job, made by compile --revolutions, to its program file");
  const auto options = std::make_shared<MergeArguments>();
  verb->add_option("SHARD", options->shards, "Shards, in any order: together every revolution of the job once")
      ->required();
  verb->add_option("-o,--output", options->output, "Program file to write (.grv)")->required();
  set_run(*verb, command, options, run_merge);
}

}  // namespace gravure::cli
