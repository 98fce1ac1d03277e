#include "src/keyed_reader.hpp"

#include <algorithm>

namespace gravure::job_file {

void KeyedReader::read(Job& job, const Store& store) {
  for (const Section& section : document_.sections) {
    read_section(section, job, store);
  }
  for (const std::string_view name : grammar_.sections) {
    report_missing(name);
  }
}

void KeyedReader::read_section(const Section& section, Job& job, const Store& store) {
  const bool is_known = contains(grammar_.sections, section.name);
  if (!section.is_table) {
    violations_.add(section.at, one_line(section.name) + " = " + section.value.shown +
                                    (is_known ? ": must be a section " + bracketed(section.name) + ", not " +
                                                    std::string(kind_name(section.value.kind))
                                              : ": unknown key outside every section" +
                                                    key_advice("", section.name, grammar_.keys, violations_).text));
    return;
  }
  if (!is_known) {
    const Suggestion advice = section_advice(section.name, grammar_.sections, violations_);
    meant_.insert(advice.nearest);
    violations_.add(section.at, bracketed(section.name) + ": unknown section" + advice.text);
    return;
  }
  if (const std::string refusal = grammar_.refusal(section.name); !refusal.empty()) {
    violations_.add(section.at, bracketed(section.name) + ": " + refusal);
    return;
  }
  job.places.emplace(section.name, section.at);
  for (const Entry& entry : section.entries) {
    job.places.emplace(section.name + "." + entry.key, entry.value.at);
    read_entry(section, entry, store);
  }
}

void KeyedReader::read_entry(const Section& section, const Entry& entry, const Store& store) {
  const auto found = std::find_if(grammar_.keys.begin(), grammar_.keys.end(), [&](const KeySpec* spec) {
    return spec->section == section.name && spec->key == entry.key;
  });
  if (found == grammar_.keys.end()) {
    const Suggestion advice = key_advice(section.name, entry.key, grammar_.keys, violations_);
    violations_.add(entry.at, bracketed(section.name) + " " + one_line(entry.key) + " = " + entry.value.shown +
                                  ": unknown key" + advice.text);
    meant_.insert(section.name + "." + advice.nearest);
  } else if (check_value(**found, entry.value, violations_)) {
    store(**found, entry.value);
  }
}

void KeyedReader::report_missing(std::string_view name) {
  const Section* section = document_.find(name);
  const bool is_needless = section == nullptr && !grammar_.section_is_required(name);
  if (is_needless || (section != nullptr && (!section->is_table || !grammar_.refusal(name).empty()))) {
    return;
  }
  std::string keys;
  for (const KeySpec* key : grammar_.keys) {
    if (key->section != name || key->presence != Presence::required) {
      continue;
    }
    const std::string path = std::string(name) + "." + std::string(key->key);
    if (section != nullptr && section->find(key->key) == nullptr && meant_.count(path) == 0) {
      violations_.add(section->at,
                      bracketed(name) + " " + std::string(key->key) + " is missing: give " + expectation(*key) +
                          (key->key == "fires" ? ", the pixels that get a pulse; polarity is never assumed" : ""));
    }
    keys += (keys.empty() ? "" : ", ") + std::string(key->key);
  }
  if (section == nullptr && meant_.count(std::string(name)) == 0) {
    violations_.add(document_.end,
                    "section " + bracketed(name) + " is missing: it needs " + grammar_.needs(name, keys));
  }
}

}  // namespace gravure::job_file
