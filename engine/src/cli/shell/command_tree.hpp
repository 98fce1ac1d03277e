#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace gravure::cli {

/// An option or positional argument as the parser knows it: what completions and man pages are made from.
struct TreeOption {
  std::vector<std::string> names;    ///< "-o", "--output"; "JOB" of a positional
  std::string value;                 ///< "TEXT", "INT"; empty where it takes none
  std::vector<std::string> choices;  ///< the words allowed, where they are listed
  std::string range;                 ///< "1 to 1024", where there is one
  std::string fallback;              ///< the default, where it is shown
  std::string description;
  bool positional = false;
  bool required = false;
  bool repeats = false;  ///< takes several values

  bool takes_file() const { return value == "TEXT" && choices.empty(); }
};

/// A verb with everything below it.
struct TreeVerb {
  std::vector<std::string> path;  ///< "motion", "profile"; empty for gravure itself
  std::string description;
  std::string footer;
  std::vector<TreeOption> options;
  std::vector<TreeVerb> verbs;

  std::string name() const { return path.empty() ? "gravure" : path.back(); }
  /// "gravure motion profile", or with another separator.
  std::string full_name(const std::string& separator = " ") const;
};

/// The parser's own tree of verbs and options, so that nothing made from it can be stale.
TreeVerb describe_tree(const CLI::App& app);

/// The tree flattened: the verb itself, then all below it, depth first.
std::vector<const TreeVerb*> all_verbs(const TreeVerb& root);

}  // namespace gravure::cli
