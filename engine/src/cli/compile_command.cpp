#include <fmt/format.h>

#include <memory>

#include "gravure/formats/grv.hpp"
#include "gravure/formats/image_files.hpp"
#include "job_loader.hpp"
#include "program_files.hpp"
#include "verb.hpp"

namespace gravure::cli {
namespace {

struct Options {
  std::string job;
  std::string output;
  std::string compression = "zstd";
};

GrvOptions grv_options(const std::string& compression) {
  GrvOptions grv;
  grv.compression = compression == "zstd"      ? GrvOptions::Compression::zstd
                    : compression == "deflate" ? GrvOptions::Compression::deflate
                                               : GrvOptions::Compression::none;
  return grv;
}

Json json_of(const ProgramHeader& header, const std::string& output) {
  Integer fired = 0;
  for (const std::uint32_t layer : header.layer_of_revolution) {
    fired += header.layers[layer].fired_pixels;
  }
  const Integer pixels =
      Integer(header.plan.job.revolutions) * header.plan.rotary.lines_per_revolution * header.plan.line.pixels;
  return {{"program", output},
          {"revolutions", header.plan.job.revolutions},
          {"layers", header.layers.size()},
          {"lines_per_revolution", header.plan.rotary.lines_per_revolution},
          {"fires", polarity_name(header.fires)},
          {"fired_pixels", json_integer(fired)},
          {"pixels", json_integer(pixels)},
          {"fired_percent", to_double(Rational(Rational(fired) * 100 / Rational(pixels)))}};
}

Result<int> run(const Options& options, const Command& command) {
  const ImageFiles files;
  GRAVURE_TRY(const LoadedJob loaded, load_job(options.job, files, true));
  std::vector<std::string> inputs = {options.job};
  for (const StackImage& image : loaded.images->images) {
    inputs.push_back(image.path);
  }
  GRAVURE_CHECK(refuse_overwrite(options.output, inputs));
  GRAVURE_TRY(const ProgramHeader header,
              compile_job(loaded, files, options.output, grv_options(options.compression), command));
  warn_of(loaded);
  const Json result = json_of(header, options.output);
  if (command.json) {
    print_json(result);
  } else {
    print(fmt::format("{}: {} {} from {} stored layers; {} fires, {:.2f} % of the pixels\n", options.output,
                      header.plan.job.revolutions, turns_name(header.plan), header.layers.size(),
                      polarity_name(header.fires), result["fired_percent"].get<double>()));
  }
  return kDone;
}

}  // namespace

void add_compile(CLI::App& app, Command& command) {
  CLI::App* verb = add_verb(app, command, "compile", "Image stack to program file");
  const auto options = std::make_shared<Options>();
  verb->add_option("JOB", options->job, "Job file")->required();
  verb->add_option("-o,--output", options->output, "Program file to write (.grv)")->required();
  verb->add_option("--compression", options->compression, "How line bits are stored")
      ->check(CLI::IsMember({"zstd", "deflate", "none"}))
      ->capture_default_str();
  add_work_options(*verb, command);
  verb->callback([&command, options] { command.run = [&command, options] { return run(*options, command); }; });
}

}  // namespace gravure::cli
