#include "control_answer.hpp"

#include <array>

#include "gravure/protocol/status_message.hpp"

namespace gravure::test {
namespace {

constexpr std::uint8_t kFromDevice = 0x80;
constexpr std::uint8_t kGetDescriptor = 6;
constexpr unsigned kStringDescriptor = 3;
constexpr std::uint16_t kEnglish = 0x0409;

template <std::size_t size>
std::vector<std::byte> bytes_of(const std::array<std::byte, size>& bytes) {
  return {bytes.begin(), bytes.end()};
}

/// USB 2.0, 9.6.7: length, type, UTF-16; number 0 lists the languages.
std::vector<std::byte> string_descriptor(const DeviceTexts& texts, unsigned number) {
  std::vector<std::uint16_t> units{kEnglish};
  if (number != 0) {
    const std::string& text = number == 1 ? texts.product : texts.serial;
    units.assign(text.begin(), text.end());
  }
  std::vector<std::byte> bytes{static_cast<std::byte>(2 + 2 * units.size()), static_cast<std::byte>(kStringDescriptor)};
  for (const std::uint16_t unit : units) {
    bytes.push_back(static_cast<std::byte>(unit));
    bytes.push_back(static_cast<std::byte>(unit >> 8U));
  }
  return bytes;
}

}  // namespace

Result<std::vector<std::byte>> answer_control(UsbBoard& board, const DeviceTexts& texts, std::uint32_t messages,
                                              const protocol::Setup& setup, std::span<const std::byte> data) {
  if (setup.request_type == kFromDevice && setup.request == kGetDescriptor &&
      static_cast<unsigned>(setup.value) >> 8U == kStringDescriptor) {
    return string_descriptor(texts, setup.value & 0xFFU);
  }
  GRAVURE_TRY(const protocol::ControlRequest request, protocol::decode_control(setup, data));
  if (const auto* read = std::get_if<protocol::ReadRegister>(&request)) {
    GRAVURE_TRY(const std::uint32_t value, board.read_register(read->address));
    return bytes_of(protocol::encode_word(value));
  }
  if (const auto* write = std::get_if<protocol::WriteRegister>(&request)) {
    GRAVURE_CHECK(board.write_register(write->address, write->value));
    return std::vector<std::byte>();
  }
  BoardStatus status = board.status();
  status.sequence = messages;
  return bytes_of(protocol::encode_status(status));
}

}  // namespace gravure::test
