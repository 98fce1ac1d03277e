#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gravure/core/error.hpp"
#include "scalar_type.hpp"

namespace gravure {

struct PlyProperty {
  std::string name;
  ScalarType type = ScalarType::f32;
  std::optional<ScalarType> count_type;  ///< set for a list: the type of its length
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

enum class PlyFormat : std::uint8_t { ascii, little_endian, big_endian };

struct PlyHeader {
  PlyFormat format = PlyFormat::ascii;
  std::vector<PlyElement> elements;
  std::size_t bytes = 0;   ///< of the header, its last line end included
  std::int64_t lines = 0;  ///< of the header
};

/// Fails with bad_file also where the elements cannot fit into the bytes that follow.
Result<PlyHeader> parse_ply_header(std::string_view bytes, const std::string& name);

}  // namespace gravure
