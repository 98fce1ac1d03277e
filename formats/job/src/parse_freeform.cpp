#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "gravure/formats/freeform_job.hpp"
#include "gravure/formats/job_file.hpp"
#include "src/freeform_keys.hpp"
#include "src/value_check.hpp"

namespace gravure {
namespace freeform_file {
namespace {

/// Reads one document into a job, gathering violations.
class FreeformReader {
 public:
  explicit FreeformReader(const Document& document) : document_(document) {
    for (const Key& key : key_table()) {
      known_.push_back(&key);
    }
  }

  FreeformJob read() {
    for (const Section& section : document_.sections) {
      read_section(section);
    }
    for (const std::string_view name : section_names()) {
      report_missing(name);
    }
    check_rules(document_, violations_);
    return std::move(job_);
  }

  const Violations& violations() const { return violations_; }

 private:
  void read_section(const Section& section) {
    const bool is_known = contains(section_names(), section.name);
    if (!section.is_table) {
      violations_.add(section.at, one_line(section.name) + " = " + section.value.shown +
                                      (is_known ? ": must be a section " + bracketed(section.name) + ", not " +
                                                      std::string(kind_name(section.value.kind))
                                                : ": unknown key outside every section" +
                                                      key_advice("", section.name, known_, violations_).text));
      return;
    }
    if (!is_known) {
      const Suggestion advice = section_advice(section.name, section_names(), violations_);
      meant_.insert(advice.nearest);
      violations_.add(section.at, bracketed(section.name) + ": unknown section" + advice.text);
      return;
    }
    job_.job.places.emplace(section.name, section.at);
    for (const Entry& entry : section.entries) {
      job_.job.places.emplace(section.name + "." + entry.key, entry.value.at);
      read_entry(section, entry);
    }
  }

  void read_entry(const Section& section, const Entry& entry) {
    const Key* key = find_key(section.name, entry.key);
    if (key == nullptr) {
      const Suggestion advice = key_advice(section.name, entry.key, known_, violations_);
      violations_.add(entry.at, bracketed(section.name) + " " + one_line(entry.key) + " = " + entry.value.shown +
                                    ": unknown key" + advice.text);
      meant_.insert(section.name + "." + advice.nearest);
    } else if (check_value(*key, entry.value, violations_)) {
      key->store(job_, entry.value);
    }
  }

  void report_missing(std::string_view name) {
    const Section* section = document_.find(name);
    if (section != nullptr ? !section->is_table : !section_is_required(name)) {
      return;
    }
    std::string keys;
    for (const Key& key : key_table()) {
      if (key.section != name || key.presence != Presence::required) {
        continue;
      }
      const std::string path = std::string(name) + "." + std::string(key.key);
      if (section != nullptr && section->find(key.key) == nullptr && meant_.count(path) == 0) {
        violations_.add(section->at,
                        bracketed(name) + " " + std::string(key.key) + " is missing: give " + expectation(key));
      }
      keys += (keys.empty() ? "" : ", ") + std::string(key.key);
    }
    if (section == nullptr && meant_.count(std::string(name)) == 0) {
      violations_.add(document_.end, "section " + bracketed(name) + " is missing: it needs " +
                                         (name == "surface"   ? "one of expression, height_field and mesh"
                                          : name == "texture" ? keys + ", one of hilbert_order, path, svg and bitmap"
                                                              : keys));
    }
  }

  const Document& document_;
  FreeformJob job_;
  std::vector<const KeySpec*> known_;
  std::set<std::string> meant_;  ///< sections and keys that a misspelt one stands for
  Violations violations_;
};

std::string folder_of(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  return slash == std::string::npos ? "" : path.substr(0, slash + 1);
}

}  // namespace
}  // namespace freeform_file

Result<FreeformJob> parse_freeform_job(std::string_view text, const std::string& path) {
  using namespace freeform_file;
  if (text.size() > kMaxJobBytes) {
    return Error{ErrorCode::bad_file, path + ": " + std::to_string(text.size()) + " bytes: a job file has at most " +
                                          std::to_string(kMaxJobBytes)};
  }
  const auto parsed = parse_toml(text, freeform_file::parent_names());
  if (const auto* syntax = std::get_if<SyntaxError>(&parsed)) {
    return Error{ErrorCode::bad_argument, place(path, syntax->at) + "not TOML: " + syntax->message};
  }
  FreeformReader reader(std::get<Document>(parsed));
  FreeformJob job = reader.read();
  if (!reader.violations().empty()) {
    return reader.violations().to_error(path);
  }
  job.job.path = path;
  job.job.text = std::string(text);
  job.texture.folder = folder_of(path);
  return job;
}

std::optional<Mode> mode_of_job_text(std::string_view text) {
  using namespace freeform_file;
  if (text.size() > kMaxJobBytes) {
    return std::nullopt;
  }
  const auto parsed = parse_toml(text);
  const auto* document = std::get_if<Document>(&parsed);
  const Section* section = document != nullptr ? document->find("job") : nullptr;
  const Entry* entry = section != nullptr ? section->find("mode") : nullptr;
  if (entry == nullptr || entry->value.kind != Kind::text) {
    return std::nullopt;
  }
  for (const Mode mode : {Mode::rotary, Mode::helical, Mode::flat, Mode::freeform, Mode::zones}) {
    if (mode_name(mode) == entry->value.text) {
      return mode;
    }
  }
  return std::nullopt;
}

}  // namespace gravure
