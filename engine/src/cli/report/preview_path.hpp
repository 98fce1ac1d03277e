#pragma once

#include <cstdint>
#include <string>

#include "gravure/core/program.hpp"
#include "verb.hpp"

namespace gravure::cli {

/// `preview` of a program that follows a path: where its pulses landed, seen along z, by number; below, by height.
Result<int> preview_path(LineSource& program, const std::string& output, std::int64_t width, const Command& command);

}  // namespace gravure::cli
