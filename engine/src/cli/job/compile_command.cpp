#include <fmt/format.h>

#include <memory>
#include <optional>

#include "gravure/formats/grv.hpp"
#include "gravure/formats/image_files.hpp"
#include "gravure/twin/unroll.hpp"
#include "job/job_loader.hpp"
#include "program/program_files.hpp"
#include "texture/freeform_job.hpp"
#include "texture/texture_motion.hpp"
#include "verb.hpp"

namespace gravure::cli {
namespace {

struct CompileArguments {
  std::string job;
  std::string output;
  std::string compression = "zstd";
  std::string revolutions;
  std::string bands;
  bool resume = false;
};

GrvOptions grv_options(const std::string& compression) {
  GrvOptions grv;
  grv.compression = compression == "zstd"      ? GrvOptions::Compression::zstd
                    : compression == "deflate" ? GrvOptions::Compression::deflate
                                               : GrvOptions::Compression::none;
  return grv;
}

/// "A:B": A and those after it, without B.
Result<Shard> range_option(const std::string& option, const std::string& text, std::int64_t most) {
  const std::size_t colon = text.find(':');
  const auto number = [](const std::string& digits) -> std::optional<std::int64_t> {
    constexpr std::size_t kMostDigits = 18;
    const bool is_number =
        !digits.empty() && digits.size() <= kMostDigits && digits.find_first_not_of("0123456789") == std::string::npos;
    return is_number ? std::optional<std::int64_t>(std::stoll(digits)) : std::nullopt;
  };
  const auto first = number(text.substr(0, colon));
  const auto end = colon == std::string::npos ? std::nullopt : number(text.substr(colon + 1));
  if (!first || !end) {
    return Error{ErrorCode::bad_argument,
                 option + " " + text.substr(0, 40) + ": must be A:B, from A up to B without B"};
  }
  if (*first >= *end || *end > most) {
    return Error{ErrorCode::out_of_range, fmt::format("{} {}: must be A:B with 0 <= A < B <= {}", option, text, most)};
  }
  return Shard{*first, *end, 0};
}

/// The part of the job that is asked for; nothing for all of it.
Result<std::optional<Shard>> shard_of(const CompileArguments& options, const LoadedJob& loaded) {
  const Plan& plan = loaded.plan;
  if (options.revolutions.empty() && options.bands.empty()) {
    return std::optional<Shard>();
  }
  Shard shard;
  if (!options.revolutions.empty()) {
    GRAVURE_TRY(shard, range_option("--revolutions", options.revolutions, plan.job.revolutions));
  } else {
    if (!plan.bands) {
      return Error{ErrorCode::bad_argument, "--bands " + options.bands + ": this job has no bands; give --revolutions"};
    }
    GRAVURE_TRY(shard, range_option("--bands", options.bands, plan.bands->count));
    shard.first *= plan.bands->revolutions_per_band;
    shard.end *= plan.bands->revolutions_per_band;
  }
  shard.image_layers = loaded.images->layers;
  return std::optional<Shard>(shard);
}

Json json_of(const CompileOutcome& outcome, const std::string& output) {
  const ProgramHeader& header = outcome.header;
  Integer fired = 0;
  for (const std::uint32_t layer : header.layer_of_revolution) {
    fired += header.layers[layer].fired_pixels;
  }
  const Integer pixels =
      Integer(header.layer_of_revolution.size()) * header.plan.rotary.lines_per_revolution * header.plan.line.pixels;
  Json json = {{"program", output},
               {"revolutions", header.layer_of_revolution.size()},
               {"layers", image_layers(header)},
               {"different_revolutions", different_revolutions(header)},
               {"lines_per_revolution", header.plan.rotary.lines_per_revolution},
               {"fires", polarity_name(header.fires)},
               {"fired_pixels", json_integer(fired)},
               {"pixels", json_integer(pixels)},
               {"fired_percent", to_double(Rational(Rational(fired) * 100 / Rational(pixels)))}};
  if (header.shard) {
    json["shard"] = {{"first", header.shard->first}, {"end", header.shard->end}, {"of", header.plan.job.revolutions}};
  }
  if (outcome.kept) {
    json["kept"] = true;
  }
  return json;
}

std::string text_of(const CompileOutcome& outcome, const std::string& output, double fired_percent) {
  const ProgramHeader& header = outcome.header;
  const std::string of_all = header.shard ? fmt::format(", {} to {} of {}", header.shard->first, header.shard->end - 1,
                                                        header.plan.job.revolutions)
                                          : "";
  return fmt::format("{}: {} {}{} ({} different); {} fires, {:.2f} % of the pixels{}\n", output,
                     header.layer_of_revolution.size(), turns_name(header.plan), of_all, different_revolutions(header),
                     polarity_name(header.fires), fired_percent, outcome.kept ? "; it was there already" : "");
}

/// Freeform jobs are made in one go: they have no revolutions or bands to share out.
Result<int> run_freeform(const CompileArguments& options, const Command& command) {
  if (!options.revolutions.empty() || !options.bands.empty() || options.resume) {
    return Error{ErrorCode::bad_argument,
                 "--revolutions, --bands, --resume: a freeform job is compiled whole; leave them out"};
  }
  GRAVURE_TRY(const FreeformJob job, read_freeform_job(options.job));
  std::vector<std::string> inputs = inputs_of(job.texture);
  inputs.push_back(options.job);
  GRAVURE_CHECK(refuse_overwrite(options.output, inputs, Writes::program));
  return compile_freeform_job(job, {options.output, "", grv_options(options.compression)},
                              with_texture_memory(command));
}

Result<int> run_compile(const CompileArguments& options, const Command& command) {
  if (is_freeform_job(options.job)) {
    return run_freeform(options, command);
  }
  const ImageFiles files;
  GRAVURE_TRY(const LoadedJob loaded, load_job(options.job, files, true));
  std::vector<std::string> inputs = files_of(loaded.job);
  for (const StackImage& image : loaded.images->images) {
    inputs.push_back(image.path);
  }
  GRAVURE_CHECK(refuse_overwrite(options.output, inputs, Writes::program));
  GRAVURE_TRY(const std::optional<Shard> shard, shard_of(options, loaded));
  const CompileRequest request{options.output, grv_options(options.compression), shard, options.resume};
  GRAVURE_TRY(const CompileOutcome outcome, compile_job(loaded, files, request, command));
  warn_of(loaded);
  const Json result = json_of(outcome, options.output);
  if (command.json) {
    print_json(result);
  } else {
    print(text_of(outcome, options.output, result["fired_percent"].get<double>()));
  }
  return kDone;
}

}  // namespace

void add_compile(CLI::App& app, Command& command) {
  CLI::App* verb = add_verb(app, command, "compile", "Image stack, or texture on a surface, to program file");
  const auto options = std::make_shared<CompileArguments>();
  verb->add_option("JOB", options->job, "Job file")->required();
  verb->add_option("-o,--output", options->output, "Program file to write (.grv)")->required();
  verb->add_option("--compression", options->compression, "How line bits are stored")
      ->check(CLI::IsMember({"zstd", "deflate", "none"}))
      ->capture_default_str();
  CLI::Option* revolutions =
      verb->add_option("--revolutions", options->revolutions, "Only A:B, from A up to B without B: a shard for merge");
  verb->add_option("--bands", options->bands, "Only bands A:B, from A up to B without B: a shard for merge")
      ->excludes(revolutions);
  verb->add_flag("--resume", options->resume, "Leave an output that is there, whole and of this job, as it is");
  add_work_options(*verb, command);
  set_run(*verb, command, options, run_compile);
}

}  // namespace gravure::cli
