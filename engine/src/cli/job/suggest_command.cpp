#include <fmt/format.h>

#include <memory>

#include "gravure/formats/image_files.hpp"
#include "gravure/sync/suggest.hpp"
#include "job/job_loader.hpp"
#include "verb.hpp"

namespace gravure::cli {
namespace {

struct SuggestArguments {
  std::string job;
  SuggestTolerances tolerances;
  std::string pitch_percent = "1";
  std::string diameter_um = "10";
};

Json json_of(const Suggestion& suggestion) {
  Json keys = Json::object();
  for (const JobKeyChange& change : suggestion.keys) {
    keys[change.key] = change.value ? Json(*change.value) : Json(nullptr);
  }
  return {{"lines_per_revolution", suggestion.lines_per_revolution},
          {"slots", suggestion.slots},
          {"line_pitch_um", to_double(suggestion.line_pitch_um)},
          {"delta_line_pitch_um", to_double(suggestion.delta_line_pitch_um)},
          {"diameter_mm", to_double(suggestion.diameter_mm)},
          {"delta_diameter_um", to_double(suggestion.delta_diameter_um)},
          {"delta_line_time_us", to_double(suggestion.delta_line_time_us)},
          {"delta_line_time_percent", to_double(suggestion.delta_line_time_percent)},
          {"prescaler", json_integer(Integer(suggestion.ab.prescaler))},
          {"increment", json_integer(Integer(suggestion.ab.increment))},
          {"job_keys", keys}};
}

std::string keys_text(const Suggestion& suggestion) {
  std::string text;
  for (const JobKeyChange& change : suggestion.keys) {
    text += fmt::format("{}{}", text.empty() ? "" : ", ",
                        change.value ? change.key + " = " + *change.value : "without " + change.key);
  }
  return text.empty() ? "the job as it is" : text;
}

std::string table(const std::vector<Suggestion>& suggestions) {
  std::string text = fmt::format("{:>9} {:>7} {:>12} {:>14} {:>14}  {}\n", "lines/rev", "slots", "pitch +um",
                                 "diameter +um", "line time +%", "set in the job");
  for (const Suggestion& suggestion : suggestions) {
    text += fmt::format("{:>9} {:>7} {:>12.4g} {:>14.4g} {:>14.4g}  {}\n", suggestion.lines_per_revolution,
                        suggestion.slots, to_double(suggestion.delta_line_pitch_um),
                        to_double(suggestion.delta_diameter_um), to_double(suggestion.delta_line_time_percent),
                        keys_text(suggestion));
  }
  return text;
}

Json outlook_json(const SuggestOutlook& outlook) {
  Json json = {{"interpolation_bits", nullptr}, {"nearest", nullptr}, {"fraction", nullptr}};
  if (outlook.interpolation_bits && outlook.nearest) {
    json["interpolation_bits"] = *outlook.interpolation_bits;
    json["nearest"] = json_of(*outlook.nearest);
  }
  if (outlook.fraction) {
    json["fraction"] = {{"increment", json_integer(Integer(outlook.fraction->increment))},
                        {"num", json_integer(Integer(outlook.fraction->num))},
                        {"den", json_integer(Integer(outlook.fraction->den))}};
  }
  return json;
}

std::string outlook_text(const SuggestOutlook& outlook) {
  std::string text;
  if (outlook.fraction) {
    text += fmt::format("with fpga.fractional = true the job as it is closes exactly: increment {} + {}/{}\n",
                        outlook.fraction->increment, outlook.fraction->num, outlook.fraction->den);
  }
  if (outlook.interpolation_bits && outlook.nearest) {
    text += fmt::format("with interpolation_bits = {} these would: {}\n", *outlook.interpolation_bits,
                        keys_text(*outlook.nearest));
  }
  return text;
}

Result<int> run_suggest(SuggestArguments options, const Command& command) {
  GRAVURE_TRY(options.tolerances.pitch_percent, decimal_option("--pitch-percent", options.pitch_percent));
  GRAVURE_TRY(options.tolerances.diameter_um, decimal_option("--diameter-um", options.diameter_um));
  const ImageFiles files;
  GRAVURE_TRY(const LoadedJob loaded, load_job(options.job, files, false));
  if (loaded.job.mode != Mode::rotary) {
    return Error{
        ErrorCode::bad_argument,
        loaded.job.place_of("job.mode") + "job.mode = \"" + std::string(mode_name(loaded.job.mode)) +
            "\": suggest looks at rotary jobs; here set fpga.fractional = true, with which nothing but a carriage "
            "drifts, or raise scanner.max_extra_slots"};
  }
  const std::int64_t revolutions = revolutions_per_band(loaded.plan);
  GRAVURE_TRY(const std::vector<Suggestion> found,
              suggest(loaded.job, loaded.columns, revolutions, options.tolerances));
  GRAVURE_TRY(const SuggestOutlook outlook,
              suggest_outlook(loaded.job, loaded.columns, revolutions, options.tolerances));
  if (command.json) {
    Json suggestions = Json::array();
    for (const Suggestion& suggestion : found) {
      suggestions.push_back(json_of(suggestion));
    }
    print_json({{"suggestions", suggestions}, {"outlook", outlook_json(outlook)}});
    return kDone;
  }
  print(found.empty() ? std::string("no job within the tolerances closes exactly without the fractional part\n")
                      : table(found));
  print(outlook_text(outlook));
  return kDone;
}

}  // namespace

void add_suggest(CLI::App& app, Command& command) {
  CLI::App* verb = add_verb(app, command, "suggest", "Nearest jobs whose seam closes exactly, and what each costs");
  const auto options = std::make_shared<SuggestArguments>();
  verb->add_option("JOB", options->job, "Job file")->required();
  add_integer(*verb, "--lines", options->tolerances.lines_per_revolution, "Lines per revolution, more or less", 0,
              1'000'000'000);
  add_integer(*verb, "--extra-slots", options->tolerances.extra_slots, "Slots a line may be longer", 0, 1'000'000'000);
  verb->add_option("--pitch-percent", options->pitch_percent, "Most the line pitch may change")->capture_default_str();
  verb->add_option("--diameter-um", options->diameter_um, "Most the diameter may change")->capture_default_str();
  add_integer(*verb, "--most", options->tolerances.most_suggestions, "Suggestions at most", 1, 1000);
  set_run(*verb, command, options, run_suggest);
}

}  // namespace gravure::cli
