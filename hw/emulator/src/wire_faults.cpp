#include "gravure/emulator/wire_faults.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "key_number.hpp"

namespace gravure::emulator {
namespace {

enum class Place : std::uint8_t { slot, frame, byte };

struct WireKind {
  std::string_view name;
  Place place;
};

/// By WireFaultKind.
constexpr std::array<WireKind, 16> kWireKinds = {{{"underrun", Place::slot},
                                                  {"silence", Place::slot},
                                                  {"interlock", Place::slot},
                                                  {"power", Place::slot},
                                                  {"checksum", Place::frame},
                                                  {"lost", Place::frame},
                                                  {"duplicate", Place::frame},
                                                  {"shape", Place::frame},
                                                  {"corrupt", Place::byte},
                                                  {"full", Place::byte},
                                                  {"stall", Place::byte},
                                                  {"timeout", Place::byte},
                                                  {"disconnect", Place::byte},
                                                  {"short", Place::byte},
                                                  {"delay", Place::byte},
                                                  {"reorder", Place::byte}}};

const WireKind& about(WireFaultKind kind) {
  return kWireKinds[static_cast<std::size_t>(kind)];
}

std::string form(const WireKind& kind) {
  constexpr std::array<std::string_view, 3> places{"@line=N+SLOT", "@line=N", "@byte=N"};
  return std::string(kind.name).append(places[static_cast<std::size_t>(kind.place)]);
}

Error refusal(std::string_view text) {
  std::string forms;
  for (const WireKind& kind : kWireKinds) {
    forms += (forms.empty() ? "" : ", ") + form(kind);
  }
  return {ErrorCode::bad_argument,
          "fault \"" + std::string(text) + "\": must be one of " + forms + "; N and SLOT count from 0"};
}

bool parse_place(std::string_view text, Place place, WireFault& fault) {
  if (place == Place::byte) {
    return take_number(text, "byte=", fault.byte) && text.empty() && fault.byte >= 0;
  }
  if (!take_number(text, "line=", fault.line) || fault.line < 0) {
    return false;
  }
  const bool with_slot = place == Place::slot && take_number(text, "+", fault.slot);
  return text.empty() && (!with_slot || fault.slot >= 0);
}

}  // namespace

std::string to_string(WireFaultKind kind) {
  return std::string(about(kind).name);
}

std::string to_string(const WireFault& fault) {
  const std::string kind = to_string(fault.kind);
  if (fault.line < 0) {
    return kind + "@byte=" + std::to_string(fault.byte);
  }
  return kind + "@line=" + std::to_string(fault.line) + (fault.slot != 0 ? "+" + std::to_string(fault.slot) : "");
}

Result<WireFault> parse_wire_fault(std::string_view text) {
  const std::size_t at = text.find('@');
  const auto* const kind = std::find_if(kWireKinds.begin(), kWireKinds.end(),
                                        [&](const WireKind& known) { return known.name == text.substr(0, at); });
  if (at == std::string_view::npos || kind == kWireKinds.end()) {
    return refusal(text);
  }
  WireFault fault{.kind = static_cast<WireFaultKind>(kind - kWireKinds.begin())};
  if (!parse_place(text.substr(at + 1), kind->place, fault)) {
    return refusal(text);
  }
  return fault;
}

namespace {

template <class Matches>
std::optional<WireFault> take_out(std::vector<WireFault>& faults, Matches matches) {
  const auto found = std::find_if(faults.begin(), faults.end(), matches);
  if (found == faults.end()) {
    return std::nullopt;
  }
  const WireFault fault = *found;
  faults.erase(found);
  return fault;
}

}  // namespace

std::optional<WireFault> WireFaults::at_line(std::int64_t line) {
  return take_out(
      left_, [line](const WireFault& fault) { return about(fault.kind).place == Place::slot && fault.line == line; });
}

std::optional<WireFault> WireFaults::at_frame(std::int64_t line) {
  return take_out(
      left_, [line](const WireFault& fault) { return about(fault.kind).place == Place::frame && fault.line == line; });
}

std::optional<WireFault> WireFaults::at_byte(WireFaultKind kind, std::int64_t first, std::int64_t end) {
  return take_out(
      left_, [=](const WireFault& fault) { return fault.kind == kind && fault.byte >= first && fault.byte < end; });
}

std::optional<std::int64_t> WireFaults::first_byte(WireFaultKind kind) const {
  std::optional<std::int64_t> first;
  for (const WireFault& fault : left_) {
    if (fault.kind == kind && (!first || fault.byte < *first)) {
      first = fault.byte;
    }
  }
  return first;
}

void WireFaults::rebase(std::int64_t bytes) {
  for (WireFault& fault : left_) {
    if (about(fault.kind).place == Place::byte) {
      fault.byte = std::max<std::int64_t>(fault.byte - bytes, 0);
    }
  }
}

}  // namespace gravure::emulator
