#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "gravure/formats/nc_program.hpp"

/// Whatever the text, both readers refuse it or give blocks that last longer than no time.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  for (const auto& program : {gravure::nc::parse_g_code(text), gravure::nc::parse_pvt(text)}) {
    for (std::size_t i = 0; program && i < program.value().blocks.size(); ++i) {
      if (!(program.value().blocks[i].duration_s >= 0)) {
        std::abort();
      }
    }
  }
  return 0;
}
