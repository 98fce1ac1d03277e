#include <optional>
#include <string>

#include "gravure/formats/job_file.hpp"
#include "gravure/formats/toml/document.hpp"
#include "src/job_rules.hpp"
#include "src/key_table.hpp"
#include "src/keyed_reader.hpp"

namespace gravure {
namespace job_file {
namespace {

/// The mode the job gives, where it is one of a cylinder or panel.
std::optional<Mode> given_mode(const Document& document) {
  const Section* section = document.find("job");
  const Entry* mode = section != nullptr && section->is_table ? section->find("mode") : nullptr;
  return mode != nullptr && mode->value.kind == Kind::text ? mode_of(mode->value.text) : std::nullopt;
}

/// Another mode has other keys, so nothing else in the file can be judged.
bool is_other_mode(const Document& document, Violations& violations) {
  const Section* section = document.find("job");
  const Entry* mode = section != nullptr ? section->find("mode") : nullptr;
  if (mode == nullptr || mode->value.kind != Kind::text || !contains(other_modes(), mode->value.text)) {
    return false;
  }
  violations.add(mode->value.at,
                 "[job] mode = " + mode->value.shown + ": must be " + range_text(*find_key("job", "mode")) + " here; " +
                     (mode->value.text == "zones" ? "use `gravure zones compile` and `gravure verify` for this job"
                                                  : "use `gravure plan`, `compile` and `verify` for this job"));
  return true;
}

/// Sections of single modes are needed in those; without a known mode [rotary] or [stage] is.
bool is_needed(std::string_view section, std::optional<Mode> mode, bool has_stage) {
  if (section_is_optional(section)) {
    return false;
  }
  if (mode) {
    return section_is_of(section, *mode);
  }
  return section_is_of(section, Mode::rotary) && (section != "rotary" || !has_stage);
}

/// Of a section that only another mode has. Where the mode itself is missing or wrong, that is all there is to say.
std::string other_mode_refusal(std::string_view section, std::optional<Mode> given) {
  if (!given || section_is_of(section, *given)) {
    return "";
  }
  const std::string_view owner = section == "carriage" ? "helical" : section == "stage" ? "flat" : "";
  const std::string mode = "mode = \"" + std::string(mode_name(*given)) + "\"";
  return owner.empty()
             ? "nothing turns with " + mode + ": describe the stage in [stage] instead, or set mode = \"rotary\""
             : "only mode = \"" + std::string(owner) + "\" has this section, not " + mode +
                   ": take it out, or set that mode";
}

Job read_document_of_job(const Document& document, Violations& violations) {
  if (is_other_mode(document, violations)) {
    return {};
  }
  if (document.sections.empty()) {
    violations.add(document.end,
                   "nothing is said here: a job begins with [job] and its mode; gravure init --mode MODE DIR writes "
                   "one that runs, rotary, helical, flat, freeform or zones");
    return {};
  }
  const std::optional<Mode> mode = given_mode(document);
  const bool has_stage = document.find("stage") != nullptr;
  const JobGrammar grammar{
      specs_of(key_table()), section_names(),
      [mode, has_stage](std::string_view section) { return is_needed(section, mode, has_stage); },
      [](std::string_view section, const std::string& keys) { return keys + std::string(choices_of(section)); },
      [mode](std::string_view section) { return other_mode_refusal(section, mode); }};
  KeyedReader reader(document, grammar);
  Job job;
  reader.read(job,
              [&job](const KeySpec& spec, const Value& value) { static_cast<const Key&>(spec).store(job, value); });
  check_rules(document, job, mode, reader.violations());
  violations = reader.violations();
  return job;
}

}  // namespace
}  // namespace job_file

Result<Job> parse_job(std::string_view text, const std::string& path) {
  using namespace job_file;
  GRAVURE_TRY(const Document document, read_document(text, path, "a job file", kMaxJobBytes, parent_names()));
  Violations violations;
  Job job = read_document_of_job(document, violations);
  if (!violations.empty()) {
    return violations.to_error(path);
  }
  job.path = path;
  job.text = std::string(text);
  return job;
}

}  // namespace gravure
