#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "gravure/core/error.hpp"
#include "gravure/core/exact.hpp"
#include "gravure/kinematics/machine.hpp"

namespace gravure {

/// Larger machine files are refused before they are read.
inline constexpr std::size_t kMaxMachineBytes = std::size_t{1} << 20U;

/// Reads a machine file (TOML, docs/formats/machine.md). Fails as read_file() (core) and parse_machine() do.
Result<kinematics::Machine> read_machine(const std::string& path);

/// The machine that `text` describes; `path` is only named, in errors. check_machine() holds for the result.
///
/// Every violation is one line "path:line:column: what, its value, what is allowed", each once, in file order. The code
/// is out_of_range where every violation is a number outside its range, bad_argument otherwise; text beyond
/// kMaxMachineBytes is bad_file.
Result<kinematics::Machine> parse_machine(std::string_view text, const std::string& path);

/// A machine together with the numbers as the file writes them.
struct MachineFile {
  kinematics::Machine machine;
  /// Every single number that the file gives, exact, by its place: "head.field_mm", "X.max_speed_mm_s".
  std::map<std::string, Rational, std::less<>> numbers;
};

/// The same as read_machine() and parse_machine(), with the numbers.
Result<MachineFile> read_machine_file(const std::string& path);
Result<MachineFile> parse_machine_file(std::string_view text, const std::string& path);

/// One key of the machine file; the table in docs/formats/machine.md has the same rows.
struct MachineKey {
  std::string section;   ///< "machine", "head", or "joint" for the section of any joint
  std::string key;       ///< "axis"
  std::string type;      ///< "integer", "decimal", "string", "list of strings", "three decimals"
  std::string unit;      ///< "mm"; empty where there is none
  std::string range;     ///< "-1_000_000 to 1_000_000", or the words allowed
  std::string fallback;  ///< the value a missing key stands for, "required", or what decides
};

/// Every key the reader knows, in the order of docs/formats/machine.md.
std::vector<MachineKey> machine_keys();

}  // namespace gravure
