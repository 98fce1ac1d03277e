// Any text is a drawing whose strokes have two points or more, all of them finite, or an Error.

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "gravure/formats/svg.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto strokes = gravure::parse_svg(text, "fuzz.svg", 1);
  if (!strokes) {
    const gravure::ErrorCode code = strokes.error().code;
    return code == gravure::ErrorCode::bad_file || code == gravure::ErrorCode::out_of_range ? 0 : (std::abort(), 1);
  }
  for (const gravure::SvgStroke& stroke : strokes.value()) {
    for (const auto& [x, y] : stroke) {
      if (stroke.size() < 2 || !std::isfinite(x) || !std::isfinite(y)) {
        std::abort();
      }
    }
  }
  return 0;
}
