// Any text is a recorded session or an Error; a session that is written again is read as the same.

#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "gravure/replay/session_text.hpp"

namespace {

using gravure::ErrorCode;
using gravure::replay::Session;

std::string text_of(const Session& session) {
  std::string text = gravure::replay::head_text(session.identity);
  for (const auto& exchange : session.exchanges) {
    text += gravure::replay::exchange_text(exchange);
  }
  return text;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto session = gravure::replay::parse_session(text, "fuzz");
  if (!session) {
    if (session.error().code != ErrorCode::bad_file && session.error().code != ErrorCode::version_mismatch) {
      std::abort();
    }
    return 0;
  }
  const std::string again = text_of(session.value());
  const auto second = gravure::replay::parse_session(again, "fuzz");
  if (!second || text_of(second.value()) != again) {
    std::abort();
  }
  return 0;
}
