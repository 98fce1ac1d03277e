#include "gravure/fpga/settings.hpp"

#include <algorithm>
#include <array>

namespace gravure::fpga {
namespace {

/// The settings of lines, from 0x30 to 0x3f without position, silence limit and low level.
bool is_line_setting(std::uint8_t address) noexcept {
  return address >= 0x30 && address <= 0x3F && address != kPositionRevolutionRegister.address &&
         address != kPositionLineRegister.address && address != kSilenceLimitRegister.address &&
         address != kLowLevelRegister.address;
}

bool is_low_word(std::uint8_t address) noexcept {
  return address == kFractionNumRegister.address || address == kFractionDenRegister.address ||
         address == kFractionNum1Register.address || address == kFractionDen1Register.address ||
         address == kRevolutionSeedsRegister.address;
}

constexpr std::array<bool, 256> kReadsBack = [] {
  std::array<bool, 256> known{};
  for (const StoredWord& word : kStoredWords) {
    known[word.address] = true;
  }
  return known;
}();

/// 0 where a range begins with 1, or more bits than the register has.
bool is_bad(std::uint8_t address, std::uint32_t data) noexcept {
  const bool zero =
      data == 0 && std::find(kNotZeroAddresses.begin(), kNotZeroAddresses.end(), address) != kNotZeroAddresses.end();
  return zero || (data & unused_bits(address)) != 0;
}

}  // namespace

bool Settings::refuses() const noexcept {
  const bool runs = (out_.control & 1U) != 0;
  const bool starts = word_.address == kControlRegister.address && (word_.data & 1U) != 0 && !runs;
  return word_.bad || (is_line_setting(word_.address) && runs) || (starts && (!fits_ || young_ != 0));
}

void Settings::take(std::uint8_t address, std::uint32_t data) noexcept {
  const auto half = static_cast<std::uint16_t>(data);
  const std::uint64_t wide = (std::uint64_t{data & 3U} << 32U) | low_word_;
  switch (address) {
    case kControlRegister.address:
      out_.control = data & 0x1FFU;
      break;
    case kCommandRegister.address:
      out_.command = data & 0x3FFU;
      break;
    case kIncrementRegister.address:
      out_.increment = data;
      break;
    case kPrescalerRegister.address:
      out_.prescaler = data;
      break;
    case kFractionNumRegister.address + 1:
      out_.fraction_num = wide;
      break;
    case kFractionDenRegister.address + 1:
      out_.fraction_den = wide;
      break;
    case kIncrement1Register.address:
      out_.increment_1 = data;
      break;
    case kPrescaler1Register.address:
      out_.prescaler_1 = data;
      break;
    case kFractionNum1Register.address + 1:
      out_.fraction_num_1 = wide;
      break;
    case kFractionDen1Register.address + 1:
      out_.fraction_den_1 = wide;
      break;
    case kSeedsPerSlotRegister.address:
      out_.seeds_per_slot = half;
      break;
    case kSlotsPerLineRegister.address:
      out_.slots_per_line = data;
      break;
    case kWindowSlotsRegister.address:
      out_.window_slots = data;
      break;
    case kSlotsPerMicrovectorRegister.address:
      out_.slots_per_microvector = data;
      break;
    case kLinesPerRevolutionRegister.address:
      out_.lines_per_revolution = data;
      break;
    case kPositionRevolutionRegister.address:
      out_.position_revolution = data;
      break;
    case kPositionLineRegister.address:
      out_.position_line = data;
      break;
    case kSilenceLimitRegister.address:
      out_.silence_limit = data;
      break;
    case kFirstTickRegister.address:
      out_.first_tick = data;
      break;
    case kReverseDelayRegister.address:
      out_.reverse_delay = half;
      break;
    case kLowLevelRegister.address:
      out_.low_level = half;
      break;
    case kCorrectionLimitRegister.address:
      out_.correction_limit = static_cast<std::uint8_t>(data);
      break;
    case kIndexWindowRegister.address:
      out_.index_window = half;
      break;
    case kRevolutionSeedsRegister.address + 1:
      out_.revolution_seeds = (std::uint64_t{half} << 32U) | low_word_;
      break;
    case kScheduleIncrementRegister.address:
      out_.schedule_increment = data;
      break;
    case kScheduleSeedsRegister.address:
      out_.schedule_seeds = data;
      break;
    default:
      break;
  }
  if (is_low_word(address)) {
    low_word_ = data;
  }
}

void Settings::show_store() noexcept {
  out_.store = word_.asked && !refuses() && kReadsBack[word_.address];
  out_.store_address = word_.address;
  out_.store_data = word_.data;
}

Settings::Outputs Settings::step(const Inputs& in) noexcept {
  const bool refused = word_.asked && refuses();
  const bool taken = word_.asked && !refused;
  const Word word = word_;
  word_ = {.asked = in.write && !in.rst,
           .bad = in.write && is_bad(in.address, in.write_data),
           .address = in.address,
           .data = in.write_data};
  const std::uint32_t slack = out_.correction_limit == 0 ? 1U : out_.correction_limit + 8U;
  fits_ = out_.slots_per_line != 0 && out_.window_slots <= out_.slots_per_line && least_slot_ <= out_.seeds_per_slot;
  least_slot_ = out_.reverse_delay + slack;
  out_.command = 0;
  if (in.rst) {
    out_ = {};
    low_word_ = 0;
    young_ = kCheckClocks;
    show_store();
    return out_;
  }
  out_.refused = refused || (out_.refused && !in.clear);
  young_ = taken && is_line_setting(word.address) ? kCheckClocks : std::max(young_ - 1, 0);
  if (taken) {
    take(word.address, word.data);
  }
  show_store();
  return out_;
}

}  // namespace gravure::fpga
