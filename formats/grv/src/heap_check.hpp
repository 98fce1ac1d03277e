#pragma once

#include <cstddef>
#include <span>

#include "byte_file.hpp"

namespace gravure::grv {

/// Can the HDF5 library be given these bytes as a local heap (a group's names)? HDF5 1.10.8 believes the sizes in one
/// and reads beyond its memory where they lie. Bytes that are no such prefix pass. Addresses count from the end of the
/// seal.
bool heap_is_sound(const ByteFile& file, std::span<const std::byte> bytes);

}  // namespace gravure::grv
