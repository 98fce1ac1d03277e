#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "gravure/formats/plan_json.hpp"

/// Whatever the text, it is refused or gives a plan whose JSON leads to the same plan again.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto plan = gravure::plan_from_json(text);
  if (!plan) {
    return 0;
  }
  const std::string written = gravure::plan_to_json(plan.value());
  const auto again = gravure::plan_from_json(written);
  if (!again || gravure::plan_to_json(again.value()) != written) {
    std::abort();
  }
  return 0;
}
