#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "gravure/core/error.hpp"

namespace gravure::emulator {

/// A line that fired, or the part of it before the gate closed.
struct FiredLine {
  std::uint32_t revolution = 0;
  std::uint32_t line = 0;
  std::uint32_t first_slot = 0;     ///< of `bits`
  std::span<const std::byte> bits;  ///< MSB first, what the gate let through; valid during the call
};

/// Gives every line that the board in a folder has fired, in order, also while it runs. bad_file where there is no such
/// folder or a file is damaged, with its place; io; what `take` returns.
Result<void> read_fired_lines(const std::string& folder, const std::function<Result<void>(const FiredLine&)>& take);

/// What the board in a folder keeps there, whether it is there yet or not: nobody else may write these.
std::vector<std::string> state_files(const std::string& folder);

/// The program that a board ran.
struct NotedProgram {
  std::string path;
  std::string seal;  ///< its program_seal() then; empty where it was noted without
};

/// CRC-32C, as text, of a program's first 512 bytes, which hold checksums of all the others. bad_file, io.
Result<std::string> program_seal(const std::string& path);
/// Notes which program the board in a folder runs, for whoever looks at what it fired; replaces what was noted before.
/// bad_file, io.
Result<void> note_program(const std::string& folder, const std::string& path);
/// bad_file where none was noted.
Result<NotedProgram> noted_program(const std::string& folder);

}  // namespace gravure::emulator
