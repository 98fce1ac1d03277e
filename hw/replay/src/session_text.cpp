#include "gravure/replay/session_text.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <iterator>

#include "gravure/protocol/status_message.hpp"

namespace gravure::replay {
namespace {

constexpr std::string_view kTitle = "gravure session ";
constexpr std::string_view kVersion = "1";
constexpr std::string_view kAnswer = " -> ";
constexpr std::array<std::string_view, 6> kRequests{"read", "write", "send", "drain", "abandon", "status"};
constexpr unsigned kHex = 16;

std::string hex(std::uint64_t value, std::size_t digits) {
  std::string text(digits, '0');
  for (std::size_t i = digits; i > 0; --i, value /= kHex) {
    text[i - 1] = "0123456789abcdef"[value % kHex];
  }
  return text;
}

std::string prefixed(std::uint64_t value, std::size_t digits) {
  return "0x" + hex(value, digits);
}

/// One line, whatever it held: \n, \\ and \xHH for control characters.
std::string escaped(std::string_view text) {
  constexpr unsigned char kSpace = 0x20;
  std::string line;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '\\') {
      line += "\\\\";
    } else if (byte < kSpace) {
      line += "\\x" + hex(byte, 2);
    } else {
      line += c;
    }
  }
  return line;
}

/// A place in one line; every take_ is false where something else stands there.
class Cursor {
 public:
  explicit Cursor(std::string_view text) : text_(text) {}

  bool take(std::string_view expected) {
    if (text_.substr(0, expected.size()) != expected) {
      return false;
    }
    text_.remove_prefix(expected.size());
    return true;
  }
  template <class T>
  bool take_number(T& value) {
    const auto read = std::from_chars(text_.data(), text_.data() + text_.size(), value);
    return skip(read);
  }
  template <class T>
  bool take_hex(T& value, std::size_t digits) {
    if (!take("0x") || text_.size() < digits) {
      return false;
    }
    const auto read = std::from_chars(text_.data(), text_.data() + digits, value, kHex);
    return read.ptr == text_.data() + digits && skip(read);
  }
  /// The rest, as escaped() wrote it.
  bool take_text(std::string& out) {
    for (; !text_.empty(); text_.remove_prefix(1)) {
      if (text_[0] != '\\') {
        out += text_[0];
        continue;
      }
      unsigned byte = 0;
      if (text_.substr(1, 1) == "\\") {
        out += '\\';
        text_.remove_prefix(1);
      } else if (text_.size() >= 4 && text_[1] == 'x' &&
                 std::from_chars(text_.data() + 2, text_.data() + 4, byte, kHex).ptr == text_.data() + 4) {
        out += static_cast<char>(byte);
        text_.remove_prefix(3);
      } else {
        return false;
      }
    }
    return true;
  }
  bool at_end() const { return text_.empty(); }
  std::string_view rest() const { return text_; }

 private:
  bool skip(const std::from_chars_result& read) {
    if (read.ec != std::errc()) {
      return false;
    }
    text_.remove_prefix(static_cast<std::size_t>(read.ptr - text_.data()));
    return true;
  }
  std::string_view text_;
};

std::string answer_text(const Exchange& exchange) {
  if (exchange.error) {
    return "error " + std::string(error_code_name(exchange.error->code)) + " " + escaped(exchange.error->message);
  }
  switch (exchange.request) {
    case Request::read:
      return prefixed(exchange.value, 8);
    case Request::send:
      return std::to_string(exchange.taken);
    case Request::drain:
      return exchange.drained ? "drained" : "not yet";
    case Request::write:
    case Request::abandon:
      return "done";
    case Request::status:
      break;
  }
  if (!exchange.status) {
    return "none";
  }
  std::string text;
  for (const std::byte byte : protocol::encode_status(*exchange.status)) {
    text += hex(std::to_integer<std::uint8_t>(byte), 2);
  }
  return text;
}

bool take_request(Cursor& line, Exchange& exchange) {
  const auto found =
      std::find_if(kRequests.begin(), kRequests.end(), [&](std::string_view name) { return line.take(name); });
  if (found == kRequests.end()) {
    return false;
  }
  exchange.request = static_cast<Request>(found - kRequests.begin());
  switch (exchange.request) {
    case Request::read:
      return line.take(" ") && line.take_hex(exchange.address, 2);
    case Request::write:
      return line.take(" ") && line.take_hex(exchange.address, 2) && line.take(" = ") &&
             line.take_hex(exchange.value, 8);
    case Request::send:
      return line.take(" ") && line.take_number(exchange.bytes) && line.take(" bytes ") &&
             line.take_hex(exchange.checksum, 8);
    default:
      return true;
  }
}

bool take_error(Cursor& line, Exchange& exchange) {
  for (const ErrorCode code : kAllErrorCodes) {
    if (line.take(std::string(error_code_name(code)) + " ")) {
      exchange.error = Error{code, ""};
      return line.take_text(exchange.error->message);
    }
  }
  return false;
}

bool take_status(Cursor& line, Exchange& exchange) {
  if (line.take("none")) {
    return true;
  }
  const std::string_view digits = line.rest();
  std::array<std::byte, protocol::kStatusBytes> message{};
  if (digits.size() != 2 * message.size()) {
    return false;
  }
  for (std::size_t i = 0; i < message.size(); ++i) {
    unsigned byte = 0;
    const char* const begin = digits.data() + 2 * i;
    if (std::from_chars(begin, begin + 2, byte, kHex).ptr != begin + 2) {
      return false;
    }
    message[i] = static_cast<std::byte>(byte);
  }
  const auto status = protocol::decode_status(message);
  if (!status) {
    return false;
  }
  exchange.status = status.value();
  return line.take(digits);
}

bool take_answer(Cursor& line, Exchange& exchange) {
  if (line.take("error ")) {
    return take_error(line, exchange);
  }
  switch (exchange.request) {
    case Request::read:
      return line.take_hex(exchange.value, 8);
    case Request::send:
      return line.take_number(exchange.taken) && exchange.taken <= exchange.bytes;
    case Request::drain:
      exchange.drained = line.take("drained");
      return exchange.drained || line.take("not yet");
    case Request::write:
    case Request::abandon:
      return line.take("done");
    case Request::status:
      return take_status(line, exchange);
  }
  return false;
}

bool take_exchange(Cursor& line, Exchange& exchange) {
  return take_request(line, exchange) && line.take(kAnswer) && take_answer(line, exchange) && line.at_end();
}

/// The lines of a text that are neither empty nor begin with #.
class Lines {
 public:
  explicit Lines(std::string_view text) : text_(text) {}
  /// False at the end.
  bool next(std::string_view& line) {
    while (!text_.empty()) {
      const std::size_t length = std::min(text_.find('\n'), text_.size());
      line = text_.substr(0, length);
      text_.remove_prefix(std::min(length + 1, text_.size()));
      ++number_;
      if (!line.empty() && line[0] != '#') {
        return true;
      }
    }
    ++number_;
    return false;
  }
  std::int64_t number() const { return number_; }

 private:
  std::string_view text_;
  std::int64_t number_ = 0;
};

Error bad_line(const std::string& name, std::int64_t line, const std::string& what) {
  return {ErrorCode::bad_file, name + ", line " + std::to_string(line) + ": " + what + " (docs/formats/session.md)"};
}

Result<void> read_title(Lines& lines, const std::string& name) {
  std::string_view line;
  if (!lines.next(line) || line.substr(0, kTitle.size()) != kTitle) {
    return bad_line(name, lines.number(), "no session: it must begin with \"gravure session 1\"");
  }
  const std::string version(line.substr(kTitle.size(), 20));
  if (version != kVersion) {
    return Error{ErrorCode::version_mismatch, name + ": version " + escaped(version) +
                                                  " of session files, this program reads version " +
                                                  std::string(kVersion) + ": record it anew"};
  }
  return {};
}

Result<DeviceIdentity> read_identity(Lines& lines, const std::string& name) {
  DeviceIdentity identity;
  const auto field = [&](const std::string& key, auto take) -> Result<void> {
    std::string_view line;
    Cursor cursor(lines.next(line) ? line : "");
    if (!cursor.take(key + " ") || !take(cursor) || !cursor.at_end()) {
      return bad_line(name, lines.number(), "must be \"" + key + " ...\"");
    }
    return {};
  };
  GRAVURE_CHECK(field("serial", [&](Cursor& line) { return line.take_text(identity.serial); }));
  GRAVURE_CHECK(field("product", [&](Cursor& line) { return line.take_text(identity.product); }));
  GRAVURE_CHECK(field("place", [&](Cursor& line) { return line.take_text(identity.place); }));
  GRAVURE_CHECK(field("protocol", [&](Cursor& line) { return line.take_number(identity.protocol_version); }));
  GRAVURE_CHECK(field("link_bits_per_s", [&](Cursor& line) {
    return line.take_number(identity.link_bits_per_s) && identity.link_bits_per_s >= 0;
  }));
  return identity;
}

}  // namespace

std::string head_text(const DeviceIdentity& identity) {
  return std::string(kTitle) + std::string(kVersion) + "\nserial " + escaped(identity.serial) + "\nproduct " +
         escaped(identity.product) + "\nplace " + escaped(identity.place) + "\nprotocol " +
         std::to_string(identity.protocol_version) + "\nlink_bits_per_s " + std::to_string(identity.link_bits_per_s) +
         "\n";
}

std::string request_text(const Exchange& exchange) {
  std::string text(kRequests[static_cast<std::size_t>(exchange.request)]);
  if (exchange.request == Request::read || exchange.request == Request::write) {
    text += " " + prefixed(exchange.address, 2);
  }
  if (exchange.request == Request::write) {
    text += " = " + prefixed(exchange.value, 8);
  }
  if (exchange.request == Request::send) {
    text += " " + std::to_string(exchange.bytes) + " bytes " + prefixed(exchange.checksum, 8);
  }
  return text;
}

std::string exchange_text(const Exchange& exchange) {
  return request_text(exchange) + std::string(kAnswer) + answer_text(exchange) + "\n";
}

Result<Session> parse_session(std::string_view text, const std::string& name) {
  Lines lines(text);
  GRAVURE_CHECK(read_title(lines, name));
  Session session;
  GRAVURE_TRY(session.identity, read_identity(lines, name));
  for (std::string_view line; lines.next(line);) {
    Exchange exchange;
    Cursor cursor(line);
    if (!take_exchange(cursor, exchange)) {
      return bad_line(name, lines.number(),
                      "\"" + escaped(line.substr(0, 60)) + "\" is no request of a host with its answer");
    }
    exchange.line = lines.number();
    session.exchanges.push_back(std::move(exchange));
  }
  return session;
}

}  // namespace gravure::replay
