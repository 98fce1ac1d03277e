#pragma once

#include <functional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gravure/core/job.hpp"
#include "src/value_check.hpp"

namespace gravure::job_file {

/// What jobs of one kind consist of.
struct JobGrammar {
  std::vector<const KeySpec*> keys;  ///< in the order of the documentation
  std::span<const std::string_view> sections;
  std::function<bool(std::string_view section)> section_is_required;
  /// Ends "section [x] is missing: it needs ...", from the names of its required keys.
  std::string (*needs)(std::string_view section, const std::string& keys);
  /// Why a job may not have a section that the grammar knows; empty: it may.
  std::function<std::string(std::string_view section)> refusal = [](std::string_view /*section*/) { return ""; };
};

/// Reads the sections and keys of a document by a grammar, gathering what is wrong; how keys go together is the
/// caller's to check afterwards.
class KeyedReader {
 public:
  /// Both outlive it.
  KeyedReader(const Document& document, const JobGrammar& grammar) : document_(document), grammar_(grammar) {}

  /// Gives `store` each value that has passed, with its key, and `job` the places of all sections and keys.
  void read(Job& job, const std::function<void(const KeySpec&, const Value&)>& store);

  Violations& violations() noexcept { return violations_; }

 private:
  using Store = std::function<void(const KeySpec&, const Value&)>;
  void read_section(const Section& section, Job& job, const Store& store);
  void read_entry(const Section& section, const Entry& entry, const Store& store);
  void report_missing(std::string_view name);

  const Document& document_;
  const JobGrammar& grammar_;
  std::set<std::string> meant_;  ///< sections and keys that a misspelt one stands for
  Violations violations_;
};

/// Reads into `target`, a struct with a Job named `job`; the grammar's keys are StoredKey<Target>.
template <class Target>
void read_into(Target& target, KeyedReader& reader) {
  reader.read(target.job, [&target](const KeySpec& spec, const Value& value) {
    static_cast<const StoredKey<Target>&>(spec).store(target, value);
  });
}

template <class Key>
std::vector<const KeySpec*> specs_of(std::span<const Key> table) {
  std::vector<const KeySpec*> specs;
  for (const Key& key : table) {
    specs.push_back(&key);
  }
  return specs;
}

}  // namespace gravure::job_file
