#include <algorithm>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <variant>

#include "gravure/formats/job_file.hpp"
#include "gravure/formats/toml/document.hpp"
#include "gravure/formats/toml/edit_distance.hpp"
#include "gravure/formats/toml/violations.hpp"
#include "src/job_rules.hpp"
#include "src/key_table.hpp"

namespace gravure {
namespace job_file {
namespace {

std::string bracketed(std::string_view section) {
  return "[" + one_line(section) + "]";
}

bool contains(std::span<const std::string_view> words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// What to say of a key nobody knows: the section it belongs to, or the key it resembles.
Suggestion key_advice(std::string_view section, std::string_view key, const Violations& violations) {
  if (violations.is_full()) {
    return {};  // will not be shown
  }
  std::vector<Candidate> candidates;
  for (const KeySpec& spec : key_table()) {
    if (spec.key == key) {
      return {"; it belongs in [" + std::string(spec.section) + "]", "", false};
    }
    if (spec.section == section) {
      candidates.push_back({spec.key, std::string(spec.key)});
    }
  }
  Suggestion here = suggest(key, candidates);
  if (here.is_near) {
    return here;
  }
  std::vector<Candidate> others;
  for (const KeySpec& spec : key_table()) {
    others.push_back({spec.key, "[" + std::string(spec.section) + "] " + std::string(spec.key)});
  }
  const Suggestion elsewhere = suggest(key, others);
  return {elsewhere.is_near || candidates.empty() ? elsewhere.text : here.text, "", false};
}

/// Reads one document into a Job, gathering violations.
class Reader {
 public:
  explicit Reader(const Document& document) : document_(document) {}

  Job read() {
    if (is_later_mode()) {
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
  bool is_later_mode() {
    const Section* section = document_.find("job");
    const Entry* mode = section != nullptr ? section->find("mode") : nullptr;
    if (mode == nullptr || mode->value.kind != Kind::text || !contains(later_modes(), mode->value.text)) {
      return false;
    }
    violations_.add(mode->value.at, "[job] mode = " + mode->value.shown + ": this version runs " +
                                        range_text(*find_key("job", "mode")) +
                                        " only; \"freeform\" and \"zones\" need a later one");
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
    std::vector<Candidate> names;
    for (const std::string_view name : section_names()) {
      names.push_back({name, bracketed(name)});
    }
    const Suggestion advice = violations_.is_full() ? Suggestion() : suggest(wrong, names);
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
      violations_.add(section.at,
                      name + ": unknown key outside every section" + key_advice("", section.name, violations_).text);
    }
  }

  void read_entry(const Section& section, const Entry& entry) {
    const KeySpec* spec = find_key(section.name, entry.key);
    if (spec == nullptr) {
      const Suggestion advice = key_advice(section.name, entry.key, violations_);
      violations_.add(entry.at, bracketed(section.name) + " " + one_line(entry.key) + " = " + entry.value.shown +
                                    ": unknown key" + advice.text);
      meant_.insert(section.name + "." + advice.nearest);
    } else if (check(*spec, entry.value)) {
      spec->store(job_, entry.value);
    }
  }

  bool check(const KeySpec& spec, const Value& value) {
    switch (spec.type) {
      case Type::boolean:
        return check_kind(spec, value, Kind::boolean);
      case Type::integer:
        return check_kind(spec, value, Kind::integer) && check_range(spec, value, value);
      case Type::decimal:
        return (value.kind == Kind::integer || check_kind(spec, value, Kind::decimal)) && check_readable(spec, value) &&
               check_range(spec, value, value);
      case Type::title:
        return check_kind(spec, value, Kind::text) && check_text(spec, value, value, 0, kMaxTitleBytes);
      case Type::path:
        return check_kind(spec, value, Kind::text) && check_text(spec, value, value, 1, kMaxPathBytes);
      case Type::paths:
        return check_kind(spec, value, Kind::array) && check_paths(spec, value);
      case Type::word:
        return check_kind(spec, value, Kind::text) && check_word(spec, value);
      case Type::two_integers:
        return check_kind(spec, value, Kind::array) && check_pair(spec, value);
    }
    return false;
  }

  static std::string must_be(const KeySpec& spec, const Value& value) {
    return bracketed(spec.section) + " " + std::string(spec.key) + " = " + value.shown + ": must be " +
           expectation(spec);
  }

  bool check_kind(const KeySpec& spec, const Value& value, Kind wanted) {
    if (value.kind != wanted) {
      violations_.add(value.at, must_be(spec, value) + ", not " + std::string(kind_name(value.kind)));
    }
    return value.kind == wanted;
  }

  bool check_readable(const KeySpec& spec, const Value& value) {
    if (!value.is_readable) {
      violations_.add(value.at, must_be(spec, value) + ", of at most 400 digits and with an exponent of at most 400");
    }
    return value.is_readable;
  }

  /// `part` is the value or an item of it.
  bool check_range(const KeySpec& spec, const Value& value, const Value& part) {
    const bool is_inside =
        part.number >= parse_decimal(spec.low).value() && part.number <= parse_decimal(spec.high).value();
    if (!is_inside) {
      violations_.add_range(part.at, must_be(spec, value));
    }
    return is_inside;
  }

  bool check_text(const KeySpec& spec, const Value& value, const Value& part, std::size_t least, std::size_t most) {
    const bool has_control = std::any_of(part.text.begin(), part.text.end(),
                                         [](char c) { return static_cast<unsigned char>(c) < 0x20U || c == 0x7F; });
    const bool fits = part.text.size() >= least && part.text.size() <= most && !has_control;
    if (!fits) {
      violations_.add(part.at, must_be(spec, value));
    }
    return fits;
  }

  bool check_paths(const KeySpec& spec, const Value& value) {
    if (value.items.empty()) {
      violations_.add(value.at, must_be(spec, value));
      return false;
    }
    bool good = true;
    for (const Value& item : value.items) {
      if (item.kind != Kind::text) {
        violations_.add(item.at, must_be(spec, value) + "; " + item.shown + " is " + std::string(kind_name(item.kind)));
        good = false;
      } else {
        good = check_text(spec, value, item, 1, kMaxPathBytes) && good;
      }
    }
    return good;
  }

  bool check_word(const KeySpec& spec, const Value& value) {
    const bool is_known = contains(spec.words, value.text);
    if (!is_known) {
      std::vector<Candidate> quoted;
      for (const std::string_view word : spec.words) {
        quoted.push_back({word, "\"" + std::string(word) + "\""});
      }
      violations_.add(value.at, must_be(spec, value) + suggest(value.text, quoted).text);
    }
    return is_known;
  }

  bool check_pair(const KeySpec& spec, const Value& value) {
    const auto is_integer = [](const Value& item) { return item.kind == Kind::integer; };
    if (value.items.size() != 2 || !std::all_of(value.items.begin(), value.items.end(), is_integer)) {
      violations_.add(value.at, must_be(spec, value));
      return false;
    }
    const bool first = check_range(spec, value, value.items[0]);
    return check_range(spec, value, value.items[1]) && first;
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
