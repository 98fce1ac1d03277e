#include "gravure/emulator/faults.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "key_number.hpp"

namespace gravure::emulator {
namespace {

constexpr std::array<std::pair<std::string_view, FaultKind>, 6> kKinds = {{{"underrun", FaultKind::underrun},
                                                                           {"checksum", FaultKind::checksum},
                                                                           {"lost", FaultKind::lost},
                                                                           {"shape", FaultKind::shape},
                                                                           {"silence", FaultKind::silence},
                                                                           {"interlock", FaultKind::interlock}}};

constexpr std::string_view kPlaces = "line=N (over the whole job) or revolution=R,line=L";

Error bad_place(std::string_view text) {
  return {ErrorCode::bad_argument, "\"" + std::string(text) + "\": must be " + std::string(kPlaces)};
}

Result<void> check_index(std::string_view text, std::string_view what, std::int64_t value, std::int64_t count) {
  if (value >= 0 && value < count) {
    return {};
  }
  return Error{ErrorCode::out_of_range, "\"" + std::string(text) + "\": " + std::string(what) + " " +
                                            std::to_string(value) + ": allowed is 0 to " + std::to_string(count - 1)};
}

}  // namespace

std::string to_string(FaultKind kind) {
  return std::string(kKinds[static_cast<std::size_t>(kind)].first);
}

Result<std::int64_t> parse_line_place(std::string_view text, const DeviceSetup& setup) {
  std::string_view rest = text;
  std::int64_t revolution = 0;
  std::int64_t line = 0;
  const bool has_revolution = take_number(rest, "revolution=", revolution);
  if (!take_number(rest, has_revolution ? ",line=" : "line=", line) || !rest.empty()) {
    return bad_place(text);
  }
  if (!has_revolution) {
    GRAVURE_CHECK(check_index(text, "line", line, setup.end_revolution * setup.lines_per_revolution));
    return line;
  }
  GRAVURE_CHECK(check_index(text, "revolution", revolution, setup.end_revolution));
  GRAVURE_CHECK(check_index(text, "line", line, setup.lines_per_revolution));
  return revolution * setup.lines_per_revolution + line;
}

Result<PlannedFault> parse_fault(std::string_view text, const DeviceSetup& setup) {
  const std::size_t at = text.find('@');
  const auto* const kind =
      std::find_if(kKinds.begin(), kKinds.end(), [&](const auto& known) { return known.first == text.substr(0, at); });
  if (at == std::string_view::npos || kind == kKinds.end()) {
    std::string kinds;
    for (const auto& known : kKinds) {
      kinds += (kinds.empty() ? "" : ", ") + std::string(known.first);
    }
    return Error{ErrorCode::bad_argument, "\"" + std::string(text) + "\": must be KIND@WHERE; the kinds are " + kinds +
                                              "; WHERE is " + std::string(kPlaces)};
  }
  GRAVURE_TRY(const std::int64_t ordinal, parse_line_place(text.substr(at + 1), setup));
  return PlannedFault{kind->second, ordinal};
}

namespace {

/// Each of the sorted acknowledgements must follow a fault that none before it acknowledged.
Result<void> check_acknowledgements(const std::vector<PlannedFault>& faults,
                                    const std::vector<std::int64_t>& acknowledgements) {
  std::int64_t from = 0;
  for (const std::int64_t line : acknowledgements) {
    if (std::none_of(faults.begin(), faults.end(),
                     [&](const PlannedFault& fault) { return fault.ordinal >= from && fault.ordinal < line; })) {
      return Error{ErrorCode::bad_argument, "the acknowledgement before line " + std::to_string(line) +
                                                " acknowledges nothing: no fault stands there; plan one at an earlier "
                                                "line, or leave it out"};
    }
    from = line;
  }
  return {};
}

}  // namespace

Result<FaultyHost> FaultyHost::make(EmulatedDevice& device, std::vector<PlannedFault> faults,
                                    std::vector<std::int64_t> acknowledgements) {
  std::sort(faults.begin(), faults.end(),
            [](const PlannedFault& a, const PlannedFault& b) { return a.ordinal < b.ordinal; });
  const auto twice = std::adjacent_find(faults.begin(), faults.end(), [](const PlannedFault& a, const PlannedFault& b) {
    return a.ordinal == b.ordinal;
  });
  if (twice != faults.end()) {
    return Error{ErrorCode::bad_argument, "two faults at line " + std::to_string(twice->ordinal) + ": " +
                                              to_string(twice->kind) + " and " + to_string((twice + 1)->kind) +
                                              "; give each line one at most"};
  }
  std::sort(acknowledgements.begin(), acknowledgements.end());
  GRAVURE_CHECK(check_acknowledgements(faults, acknowledgements));
  return FaultyHost(device, std::move(faults), std::move(acknowledgements));
}

Result<void> FaultyHost::configure(const DeviceSetup& setup) {
  acknowledge_to(setup.first_revolution * setup.lines_per_revolution + setup.first_line);
  GRAVURE_CHECK(device_->configure(setup));
  setup_ = setup;
  return {};
}

Result<void> FaultyHost::send_badly(FaultKind kind, const LineFrame& frame, std::int64_t ordinal) {
  LineFrame bad = frame;
  switch (kind) {
    case FaultKind::underrun:
      return device_->pass_line(DeviceFault::underrun, "no frame came in time");
    case FaultKind::silence:
      silent_ = true;
      return device_->pass_line(DeviceFault::host_silence, "no byte came for a line time");
    case FaultKind::interlock:
      device_->raise_fault(DeviceFault::interlock, "the interlock opened");
      break;
    case FaultKind::checksum:
      spoilt_.assign(frame.bits.begin(), frame.bits.end());
      if (spoilt_.empty()) {
        bad.crc32c ^= 1U;
      } else {
        spoilt_.front() ^= std::byte{0x80};
        bad.bits = spoilt_;
      }
      break;
    case FaultKind::lost:
      if (ordinal + 1 == setup_.end_revolution * setup_.lines_per_revolution) {
        return device_->pass_line(DeviceFault::underrun, "the last frame was lost, no other follows");
      }
      bad.line = (frame.line + 1) % setup_.lines_per_revolution;
      bad.revolution = frame.revolution + (bad.line == 0 ? 1 : 0);
      bad.crc32c = frame_crc32c(bad);
      break;
    case FaultKind::shape:
      bad.first_slot = setup_.slots_per_line;
      bad.crc32c = frame_crc32c(bad);
      break;
  }
  return device_->send(bad);
}

void FaultyHost::note(std::int64_t ordinal) {
  if (!dark_.empty() && dark_.back().last + 1 == ordinal && dark_.back().fault == device_->fault()) {
    dark_.back().last = ordinal;
    return;
  }
  dark_.push_back({.tick = ordinal * setup_.slots_per_line * setup_.ticks_per_slot,
                   .first = ordinal,
                   .last = ordinal,
                   .fault = device_->fault(),
                   .detail = device_->status().detail});
}

void FaultyHost::acknowledge_to(std::int64_t ordinal) {
  while (next_acknowledgement_ < acknowledgements_.size() && acknowledgements_[next_acknowledgement_] <= ordinal) {
    ++next_acknowledgement_;
    device_->acknowledge();
    silent_ = false;
  }
}

Result<void> FaultyHost::send(const LineFrame& frame) {
  const std::int64_t ordinal = frame.revolution * setup_.lines_per_revolution + frame.line;
  acknowledge_to(ordinal);
  while (next_fault_ < faults_.size() && faults_[next_fault_].ordinal < ordinal) {
    ++next_fault_;  // of lines before the first that is sent
  }
  const bool planned = next_fault_ < faults_.size() && faults_[next_fault_].ordinal == ordinal;
  const bool stood = device_->fault() != DeviceFault::none;
  Result<void> sent = planned   ? send_badly(faults_[next_fault_].kind, frame, ordinal)
                      : silent_ ? device_->pass_line(DeviceFault::host_silence, "no byte came for a line time")
                                : device_->send(frame);
  if (device_->fault() == DeviceFault::none) {
    return sent;
  }
  if (!planned && !stood) {
    return sent;  // the board refused a good frame
  }
  note(ordinal);
  return {};
}

}  // namespace gravure::emulator
