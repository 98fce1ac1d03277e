#pragma once

#include <cstddef>
#include <cstdint>

namespace gravure {

/// A count that is not negative, as containers want it.
constexpr std::size_t as_size(std::int64_t count) noexcept {
  return static_cast<std::size_t>(count);
}

}  // namespace gravure
