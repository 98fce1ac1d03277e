#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "gravure/formats/toml/document.hpp"

namespace gravure::machine_file {

using namespace toml_file;

enum class Type : std::uint8_t { integer, decimal, vector, text, names, word };

/// Which sections have the key.
enum class Owner : std::uint8_t { machine, joint, prismatic, revolute, head };

struct KeySpec {
  Owner owner;
  std::string_view key;
  Type type;
  std::string_view unit;
  std::string_view low;  ///< numbers: smallest and largest value allowed, as the file would write them
  std::string_view high;
  std::span<const std::string_view> words;
  std::string_view fallback;  ///< "required", or what a missing key stands for

  bool is_required() const { return fallback == "required"; }
};

inline constexpr std::size_t kMaxTextBytes = 200;
inline constexpr std::size_t kMaxNameBytes = 32;
inline constexpr std::size_t kMaxJoints = 32;

std::span<const KeySpec> key_table();

/// Does a section of this owner have the key? Joints have those of their kind as well; `kind` is joint while it is
/// unknown, which allows both.
bool has_key(const KeySpec& spec, Owner kind);

/// What the value may be.
std::string range_text(const KeySpec& spec);
/// "three numbers from -1 to 1": what the value must be.
std::string expectation(const KeySpec& spec);

}  // namespace gravure::machine_file
