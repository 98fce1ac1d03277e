#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gravure/core/device_link.hpp"
#include "gravure/core/error.hpp"

namespace gravure::replay {

/// What a host can ask of a DeviceLink.
enum class Request : std::uint8_t { read, write, send, drain, abandon, status };

/// One call and what came of it; what the request does not have is 0.
struct Exchange {
  Request request = Request::read;
  std::uint8_t address = 0;    ///< read, write
  std::uint32_t value = 0;     ///< write: to the board; read: from it
  std::uint64_t bytes = 0;     ///< send: offered
  std::uint32_t checksum = 0;  ///< send: CRC-32C of them
  std::uint64_t taken = 0;     ///< send
  bool drained = false;
  std::optional<BoardStatus> status = {};  ///< none came in time
  std::optional<Error> error = {};         ///< then nothing came of it
  std::int64_t line = 0;                   ///< of the file
};

struct Session {
  DeviceIdentity identity;
  std::vector<Exchange> exchanges;
};

inline constexpr std::size_t kMostSessionBytes = std::size_t{256} << 20;

/// The lines of a session file (docs/formats/session.md), each with its end.
std::string head_text(const DeviceIdentity& identity);
std::string exchange_text(const Exchange& exchange);
/// The request alone: "write 0x10 = 0x00000001".
std::string request_text(const Exchange& exchange);

/// bad_file names the line; version_mismatch names both versions.
Result<Session> parse_session(std::string_view text, const std::string& name);

}  // namespace gravure::replay
