#pragma once

#include <string>

#include "shell/command_tree.hpp"

namespace gravure::cli {

/// The manual page of a verb (section 1, man(7) macros), with the words that its --help prints.
std::string man_page(const TreeVerb& verb, const std::string& version);

}  // namespace gravure::cli
