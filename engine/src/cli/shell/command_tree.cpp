#include "shell/command_tree.hpp"

#include <algorithm>

namespace gravure::cli {
namespace {

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::string part;
  for (const char c : text) {
    if (c == separator) {
      parts.push_back(part);
      part.clear();
    } else {
      part += c;
    }
  }
  parts.push_back(part);
  return parts;
}

/// The parser shows "TEXT:{white,black}", "INT:1 to 1024", "TEXT".
void read_type(const std::string& shown, TreeOption& option) {
  const std::size_t colon = shown.find(':');
  option.value = shown.substr(0, colon);
  if (colon == std::string::npos) {
    return;
  }
  const std::string check = shown.substr(colon + 1);
  if (check.size() > 2 && check.front() == '{' && check.back() == '}') {
    option.choices = split(check.substr(1, check.size() - 2), ',');
  } else {
    option.range = check;
  }
}

TreeOption describe(const CLI::Option& option) {
  TreeOption described;
  described.positional = option.get_positional();
  if (described.positional) {
    described.names = {option.get_name(true)};
  }
  for (const std::string& name : option.get_snames()) {
    described.names.push_back("-" + name);
  }
  for (const std::string& name : option.get_lnames()) {
    described.names.push_back("--" + name);
  }
  if (option.get_items_expected_max() > 0) {
    read_type(option.get_type_name(), described);
  }
  described.fallback = option.get_default_str();
  described.description = option.get_description();
  described.required = option.get_required();
  described.repeats = option.get_items_expected_max() > 1;
  return described;
}

TreeVerb describe(const CLI::App& app, const std::vector<std::string>& path) {
  TreeVerb verb;
  verb.path = path;
  verb.description = app.get_description();
  verb.footer = app.get_footer();
  for (const CLI::Option* option : app.get_options()) {
    verb.options.push_back(describe(*option));
  }
  for (const CLI::App* below : app.get_subcommands([](const CLI::App*) { return true; })) {
    std::vector<std::string> deeper = path;
    deeper.push_back(below->get_name());
    verb.verbs.push_back(describe(*below, deeper));
  }
  return verb;
}

}  // namespace

std::string TreeVerb::full_name(const std::string& separator) const {
  std::string name = "gravure";
  for (const std::string& part : path) {
    name += separator + part;
  }
  return name;
}

TreeVerb describe_tree(const CLI::App& app) {
  return describe(app, {});
}

std::vector<const TreeVerb*> all_verbs(const TreeVerb& root) {
  std::vector<const TreeVerb*> all = {&root};
  for (const TreeVerb& verb : root.verbs) {
    const std::vector<const TreeVerb*> below = all_verbs(verb);
    all.insert(all.end(), below.begin(), below.end());
  }
  return all;
}

}  // namespace gravure::cli
