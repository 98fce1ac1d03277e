#include <optional>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "gravure/formats/job_file.hpp"
#include "gravure/formats/toml/document.hpp"
#include "src/job_rules.hpp"
#include "src/key_table.hpp"
#include "src/value_check.hpp"

namespace gravure {
namespace job_file {
namespace {

/// The keys of all sections, for advice.
std::span<const KeySpec* const> known_keys() {
  static const std::vector<const KeySpec*> known = [] {
    std::vector<const KeySpec*> keys;
    for (const Key& key : key_table()) {
      keys.push_back(&key);
    }
    return keys;
  }();
  return known;
}

/// Reads one document into a Job, gathering violations.
class Reader {
 public:
  explicit Reader(const Document& document) : document_(document) {}

  Job read() {
    if (is_other_mode()) {
      return std::move(job_);
    }
    if (document_.sections.empty()) {
      violations_.add(document_.end,
                      "nothing is said here: a job begins with [job] and its mode; gravure init --mode MODE DIR writes "
                      "one that runs, rotary, helical, flat, freeform or zones");
      return std::move(job_);
    }
    mode_ = given_mode();
    for (const Section& section : document_.sections) {
      read_section(section);
    }
    report_missing();
    check_rules(document_, job_, mode_, violations_);
    return std::move(job_);
  }

  const Violations& violations() const { return violations_; }

 private:
  /// Another mode has other keys, so nothing else in the file can be judged.
  bool is_other_mode() {
    const Section* section = document_.find("job");
    const Entry* mode = section != nullptr ? section->find("mode") : nullptr;
    if (mode == nullptr || mode->value.kind != Kind::text || !contains(other_modes(), mode->value.text)) {
      return false;
    }
    violations_.add(mode->value.at,
                    "[job] mode = " + mode->value.shown + ": must be " + range_text(*find_key("job", "mode")) +
                        " here; " +
                        (mode->value.text == "zones" ? "use `gravure zones compile` and `gravure verify` for this job"
                                                     : "use `gravure plan`, `compile` and `verify` for this job"));
    return true;
  }

  std::optional<Mode> given_mode() const {
    const Section* section = document_.find("job");
    const Entry* mode = section != nullptr && section->is_table ? section->find("mode") : nullptr;
    return mode != nullptr && mode->value.kind == Kind::text ? mode_of(mode->value.text) : std::nullopt;
  }

  /// A section that only another mode has. Where the mode itself is missing or wrong, that is all there is to say.
  bool is_of_another_mode(const std::string& section) const { return mode_ && !section_is_of(section, *mode_); }

  void report_other_mode(const Section& section) {
    const std::string_view owner = section.name == "carriage" ? "helical" : section.name == "stage" ? "flat" : "";
    const std::string mode = "mode = \"" + std::string(mode_name(*mode_)) + "\"";
    violations_.add(section.at, owner.empty()
                                    ? bracketed(section.name) + ": nothing turns with " + mode +
                                          ": describe the stage in [stage] instead, or set mode = \"rotary\""
                                    : bracketed(section.name) + ": only mode = \"" + std::string(owner) +
                                          "\" has this section, not " + mode + ": take it out, or set that mode");
  }

  void read_section(const Section& section) {
    const bool is_known = contains(section_names(), section.name);
    if (!section.is_table) {
      report_loose_value(section, is_known);
    } else if (!is_known) {
      violations_.add(section.at, bracketed(section.name) + ": unknown section" + section_advice(section.name));
    } else if (is_of_another_mode(section.name)) {
      report_other_mode(section);
    } else {
      job_.places.emplace(section.name, section.at);
      for (const Entry& entry : section.entries) {
        job_.places.emplace(section.name + "." + entry.key, entry.value.at);
        read_entry(section, entry);
      }
    }
  }

  std::string section_advice(const std::string& wrong) {
    const Suggestion advice = job_file::section_advice(wrong, section_names(), violations_);
    if (advice.is_near) {
      meant_.insert(advice.nearest);
    }
    return advice.text;
  }

  void report_loose_value(const Section& section, bool is_known) {
    const std::string name = one_line(section.name) + " = " + section.value.shown;
    if (is_known) {
      violations_.add(section.at, name + ": must be a section " + bracketed(section.name) + ", not " +
                                      std::string(kind_name(section.value.kind)));
    } else {
      violations_.add(section.at, name + ": unknown key outside every section" +
                                      key_advice("", section.name, known_keys(), violations_).text);
    }
  }

  void read_entry(const Section& section, const Entry& entry) {
    const Key* spec = find_key(section.name, entry.key);
    if (spec == nullptr) {
      const Suggestion advice = key_advice(section.name, entry.key, known_keys(), violations_);
      violations_.add(entry.at, bracketed(section.name) + " " + one_line(entry.key) + " = " + entry.value.shown +
                                    ": unknown key" + advice.text);
      meant_.insert(section.name + "." + advice.nearest);
    } else if (check_value(*spec, entry.value, violations_)) {
      spec->store(job_, entry.value);
    }
  }

  /// Sections of single modes are needed in those; without a known mode [rotary] or [stage] is.
  bool is_needed(std::string_view section) const {
    if (section_is_optional(section)) {
      return false;
    }
    if (mode_) {
      return section_is_of(section, *mode_);
    }
    return section_is_of(section, Mode::rotary) && (section != "rotary" || document_.find("stage") == nullptr);
  }

  void report_missing() {
    for (const std::string_view name : section_names()) {
      const Section* section = document_.find(name);
      if (section == nullptr ? !is_needed(name) : is_of_another_mode(section->name)) {
        continue;
      }
      if (section == nullptr && meant_.count(std::string(name)) != 0) {
        continue;  // said where it is misspelt
      }
      if (section == nullptr) {
        violations_.add(document_.end, "section " + bracketed(name) + " is missing: it needs " + required_keys(name));
      } else if (section->is_table) {
        report_missing_keys(*section);
      }
    }
  }

  static std::string required_keys(std::string_view section) {
    std::string keys;
    for (const KeySpec& spec : key_table()) {
      if (spec.section == section && spec.presence == Presence::required) {
        keys += (keys.empty() ? "" : ", ") + std::string(spec.key);
      }
    }
    return keys + std::string(choices_of(section));
  }

  void report_missing_keys(const Section& section) {
    for (const KeySpec& spec : key_table()) {
      if (spec.section == section.name && spec.presence == Presence::required && section.find(spec.key) == nullptr &&
          meant_.count(section.name + "." + std::string(spec.key)) == 0) {
        const bool is_polarity = spec.key == "fires";
        violations_.add(section.at,
                        bracketed(section.name) + " " + std::string(spec.key) + " is missing: give " +
                            expectation(spec) +
                            (is_polarity ? ", the pixels that get a pulse; polarity is never assumed" : ""));
      }
    }
  }

  const Document& document_;
  Job job_;
  std::optional<Mode> mode_;     ///< none: missing or wrong, which is said
  std::set<std::string> meant_;  ///< sections and keys ("laser.seed_hz") that a misspelt one stands for
  Violations violations_;
};

}  // namespace
}  // namespace job_file

Result<Job> parse_job(std::string_view text, const std::string& path) {
  if (text.size() > kMaxJobBytes) {
    return Error{ErrorCode::bad_file, path + ": " + std::to_string(text.size()) + " bytes: a job file has at most " +
                                          std::to_string(kMaxJobBytes)};
  }
  const auto parsed = job_file::parse_toml(text, job_file::parent_names());
  if (const auto* syntax = std::get_if<job_file::SyntaxError>(&parsed)) {
    return Error{ErrorCode::bad_argument, job_file::place(path, syntax->at) + "not TOML: " + syntax->message};
  }
  job_file::Reader reader(std::get<job_file::Document>(parsed));
  Job job = reader.read();
  if (!reader.violations().empty()) {
    return reader.violations().to_error(path);
  }
  job.path = path;
  job.text = std::string(text);
  return job;
}

}  // namespace gravure
