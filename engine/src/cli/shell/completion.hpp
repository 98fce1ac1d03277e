#pragma once

#include <string>

#include "shell/command_tree.hpp"

namespace gravure::cli {

/// Completion scripts from the tree of verbs: verbs, options, the words an option takes, files elsewhere.
std::string bash_completion(const TreeVerb& root);
std::string zsh_completion(const TreeVerb& root);
std::string fish_completion(const TreeVerb& root);

}  // namespace gravure::cli
