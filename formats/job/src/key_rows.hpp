#pragma once

#include <algorithm>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gravure/formats/job_keys.hpp"
#include "src/key_spec.hpp"

namespace gravure::job_file {

// Bounds that the jobs of every mode share, as the machine file has them.
inline constexpr std::string_view kLeastAboveZero = "0.000_001";
inline constexpr std::string_view kMostSpeed = "1_000_000_000";
inline constexpr std::string_view kMostAcceleration = "1_000_000_000_000";
inline constexpr std::string_view kMostJerk = "1_000_000_000_000_000_000";
inline constexpr std::string_view kBiggestHz = "10_000_000_000";

/// How the rows of a key table are written: a function a kind of value.
template <class Target>
struct KeyRows {
  using Key = StoredKey<Target>;
  using Store = void (*)(Target& target, const Value& value);

  static constexpr Key integer(std::string_view section, std::string_view key, std::string_view unit,
                               std::string_view low, std::string_view high, std::string_view fallback, Store store) {
    return {{section, key, Type::integer, unit, low, high, {}, presence_of(fallback), fallback}, store};
  }

  static constexpr Key decimal(std::string_view section, std::string_view key, std::string_view unit,
                               std::string_view low, std::string_view high, std::string_view fallback, Store store) {
    return {{section, key, Type::decimal, unit, low, high, {}, presence_of(fallback), fallback}, store};
  }

  static constexpr Key word(std::string_view section, std::string_view key, std::span<const std::string_view> words,
                            std::string_view fallback, Store store) {
    return {{section, key, Type::word, "", "", "", words, presence_of(fallback), fallback}, store};
  }

  /// Of a type without bounds of the row's own.
  static constexpr Key other(std::string_view section, std::string_view key, Type type, std::string_view fallback,
                             Store store) {
    return {{section, key, type, "", "", "", {}, presence_of(fallback), fallback}, store};
  }
};

/// The same key, present or not as other keys decide.
template <class Target>
constexpr StoredKey<Target> decided(StoredKey<Target> key) {
  key.presence = Presence::decided;
  return key;
}

/// The key's row, or null.
template <class Key>
const Key* row_of(std::span<const Key> table, std::string_view section, std::string_view key) {
  const auto found = std::find_if(table.begin(), table.end(),
                                  [&](const Key& row) { return row.section == section && row.key == key; });
  return found == table.end() ? nullptr : &*found;
}

/// The rows as the documentation has them.
template <class Key>
std::vector<JobKey> documented(std::span<const Key> table) {
  std::vector<JobKey> keys;
  for (const Key& row : table) {
    keys.push_back({std::string(row.section), std::string(row.key), type_name(row.type), std::string(row.unit),
                    range_text(row), std::string(row.fallback)});
  }
  return keys;
}

}  // namespace gravure::job_file
