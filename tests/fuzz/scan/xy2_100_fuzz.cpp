// Any bytes are a frame stream that is written as it was read, or an Error.

#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "gravure/scan/xy2_100.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const auto stream = gravure::scan::decode_stream(bytes);
  if (stream ? gravure::scan::encode_stream(stream.value()) != bytes
             : stream.error().code != gravure::ErrorCode::bad_file &&
                   stream.error().code != gravure::ErrorCode::version_mismatch) {
    std::abort();
  }
  return 0;
}
