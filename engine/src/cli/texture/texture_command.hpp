#pragma once

#include "verb.hpp"

namespace gravure::cli {

/// The verbs of `gravure texture`.
void add_texture(CLI::App& app, Command& command);
/// `gravure texture compile`.
void add_texture_compile(CLI::App& texture, Command& command);

}  // namespace gravure::cli
