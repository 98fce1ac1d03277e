#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace gravure::raster {

/// Which samples become 1.
enum class Where : std::uint8_t {
  at_least,  ///< sample >= threshold
  at_most,   ///< sample <= threshold: maps in which dark means deep
};

/// Samples to bits: one row of src.size() samples gives packed_bytes(src.size()) bytes of `dst`, unused low bits 0.
/// A NaN gives 0 in both directions (readers refuse NaN before).
void threshold(std::span<std::byte> dst, std::span<const std::uint8_t> src, std::uint8_t limit,
               Where where = Where::at_least);
void threshold(std::span<std::byte> dst, std::span<const std::uint16_t> src, std::uint16_t limit,
               Where where = Where::at_least);
void threshold(std::span<std::byte> dst, std::span<const float> src, float limit, Where where = Where::at_least);

/// The same for `rows` rows of `width` samples without padding; each row starts on a byte of `dst`, so that
/// rows * packed_bytes(width) bytes are written, no more.
void threshold_rows(std::span<std::byte> dst, std::span<const std::uint8_t> src, std::int64_t width, std::int64_t rows,
                    std::uint8_t limit, Where where = Where::at_least);
void threshold_rows(std::span<std::byte> dst, std::span<const std::uint16_t> src, std::int64_t width, std::int64_t rows,
                    std::uint16_t limit, Where where = Where::at_least);
void threshold_rows(std::span<std::byte> dst, std::span<const float> src, std::int64_t width, std::int64_t rows,
                    float limit, Where where = Where::at_least);

}  // namespace gravure::raster
