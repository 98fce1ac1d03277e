#include "src/value_check.hpp"

#include <algorithm>
#include <vector>

namespace gravure::job_file {
namespace {

/// One value against one key.
class Check {
 public:
  Check(const KeySpec& spec, const Value& value, Violations& violations)
      : spec_(spec), value_(value), violations_(violations) {}

  bool passes() {
    switch (spec_.type) {
      case Type::boolean:
        return is_kind(Kind::boolean);
      case Type::integer:
        return is_kind(Kind::integer) && is_inside(value_);
      case Type::decimal:
        return (value_.kind == Kind::integer || is_kind(Kind::decimal)) && is_readable(value_) && is_inside(value_);
      case Type::title:
        return is_kind(Kind::text) && is_text(value_, 0, kMaxTitleBytes);
      case Type::text:
      case Type::path:
        return is_kind(Kind::text) && is_text(value_, 1, kMaxPathBytes);
      case Type::paths:
        return is_kind(Kind::array) && are_paths();
      case Type::word:
        return is_kind(Kind::text) && is_word();
      case Type::two_integers:
        return is_kind(Kind::array) && are_integers(2);
      case Type::two_decimals:
        return is_kind(Kind::array) && are_decimals(2);
      case Type::three_decimals:
        return is_kind(Kind::array) && are_decimals(3);
    }
    return false;
  }

 private:
  std::string must_be() const {
    return bracketed(spec_.section) + " " + std::string(spec_.key) + " = " + value_.shown + ": must be " +
           expectation(spec_);
  }

  bool is_kind(Kind wanted) {
    if (value_.kind != wanted) {
      violations_.add(value_.at, must_be() + ", not " + std::string(kind_name(value_.kind)));
    }
    return value_.kind == wanted;
  }

  // `part` is the value or an item of it.

  bool is_readable(const Value& part) {
    if (!part.is_readable) {
      violations_.add(part.at, must_be() + ", of at most 400 digits and with an exponent of at most 400");
    }
    return part.is_readable;
  }

  bool is_inside(const Value& part) {
    const bool is_inside =
        part.number >= parse_decimal(spec_.low).value() && part.number <= parse_decimal(spec_.high).value();
    if (!is_inside) {
      violations_.add_range(part.at, must_be());
    }
    return is_inside;
  }

  bool is_text(const Value& part, std::size_t least, std::size_t most) {
    const bool has_control = std::any_of(part.text.begin(), part.text.end(),
                                         [](char c) { return static_cast<unsigned char>(c) < 0x20U || c == 0x7F; });
    const bool fits = part.text.size() >= least && part.text.size() <= most && !has_control;
    if (!fits) {
      violations_.add(part.at, must_be());
    }
    return fits;
  }

  bool are_paths() {
    if (value_.items.empty()) {
      violations_.add(value_.at, must_be());
      return false;
    }
    bool good = true;
    for (const Value& item : value_.items) {
      if (item.kind != Kind::text) {
        violations_.add(item.at, must_be() + "; " + item.shown + " is " + std::string(kind_name(item.kind)));
        good = false;
      } else {
        good = is_text(item, 1, kMaxPathBytes) && good;
      }
    }
    return good;
  }

  bool is_word() {
    const bool is_known = contains(spec_.words, value_.text);
    if (!is_known) {
      std::vector<Candidate> quoted;
      for (const std::string_view allowed : spec_.words) {
        quoted.push_back({allowed, "\"" + std::string(allowed) + "\""});
      }
      violations_.add(value_.at, must_be() + suggest(value_.text, quoted).text);
    }
    return is_known;
  }

  bool has_items(std::size_t count, bool (*is_right)(const Value&)) {
    if (value_.items.size() == count && std::all_of(value_.items.begin(), value_.items.end(), is_right)) {
      return true;
    }
    violations_.add(value_.at, must_be());
    return false;
  }

  bool are_integers(std::size_t count) {
    if (!has_items(count, [](const Value& item) { return item.kind == Kind::integer; })) {
      return false;
    }
    bool good = true;
    for (const Value& item : value_.items) {
      good = is_inside(item) && good;
    }
    return good;
  }

  bool are_decimals(std::size_t count) {
    if (!has_items(count, [](const Value& i) { return i.kind == Kind::integer || i.kind == Kind::decimal; })) {
      return false;
    }
    bool good = true;
    for (const Value& item : value_.items) {
      good = is_readable(item) && is_inside(item) && good;
    }
    return good;
  }

  const KeySpec& spec_;
  const Value& value_;
  Violations& violations_;
};

}  // namespace

std::string bracketed(std::string_view section) {
  return "[" + one_line(section) + "]";
}

bool contains(std::span<const std::string_view> words, std::string_view wanted) {
  return std::find(words.begin(), words.end(), wanted) != words.end();
}

bool check_value(const KeySpec& spec, const Value& value, Violations& violations) {
  return Check(spec, value, violations).passes();
}

Suggestion key_advice(std::string_view section, std::string_view key, std::span<const KeySpec* const> known,
                      const Violations& violations) {
  if (violations.is_full()) {
    return {};  // will not be shown
  }
  std::vector<Candidate> candidates;
  for (const KeySpec* spec : known) {
    if (spec->key == key) {
      return {"; it belongs in [" + std::string(spec->section) + "]", "", false};
    }
    if (spec->section == section) {
      candidates.push_back({spec->key, std::string(spec->key)});
    }
  }
  Suggestion here = suggest(key, candidates);
  if (here.is_near) {
    return here;
  }
  std::vector<Candidate> others;
  for (const KeySpec* spec : known) {
    others.push_back({spec->key, "[" + std::string(spec->section) + "] " + std::string(spec->key)});
  }
  const Suggestion elsewhere = suggest(key, others);
  return {elsewhere.is_near || candidates.empty() ? elsewhere.text : here.text, "", false};
}

Suggestion section_advice(std::string_view wrong, std::span<const std::string_view> known,
                          const Violations& violations) {
  std::vector<Candidate> names;
  for (const std::string_view name : known) {
    names.push_back({name, bracketed(name)});
  }
  return violations.is_full() ? Suggestion() : suggest(wrong, names);
}

}  // namespace gravure::job_file
