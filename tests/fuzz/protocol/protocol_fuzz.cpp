// Any bytes are a control request, a stream of frames, a status message, or an Error; what is read is written again as
// it was. The first byte says which: 0 control (setup, then data), 1 stream, else status.

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

#include "gravure/protocol/control.hpp"
#include "gravure/protocol/frame.hpp"
#include "gravure/protocol/status_message.hpp"

namespace {

using namespace gravure;
using namespace gravure::protocol;
using Bytes = std::span<const std::byte>;

void require(bool holds) {
  if (!holds) {
    std::abort();
  }
}

void check_control(Bytes bytes) {
  if (bytes.size() < kSetupBytes) {
    return;
  }
  const Setup setup = decode_setup(bytes.first<kSetupBytes>());
  require(std::ranges::equal(encode_setup(setup), bytes.first(kSetupBytes)));
  const Bytes data = bytes.subspan(kSetupBytes);
  const auto request = decode_control(setup, data);
  if (!request) {
    require(request.error().code == ErrorCode::device);
    return;
  }
  const ControlPacket again = encode_control(request.value());
  require(again.setup == setup && (again.data.empty() || std::ranges::equal(again.data, data)));
}

void check_stream(Bytes stream) {
  while (!stream.empty()) {
    const auto frame = decode_frame(stream);
    if (!frame || !frame.value()) {
      require(frame || frame.error().code == ErrorCode::device);
      return;
    }
    std::vector<std::byte> again;
    append_frame(again, frame.value()->head, frame.value()->bits);
    require(std::ranges::equal(again, stream.first(frame.value()->size())));
    stream = stream.subspan(again.size());
  }
}

void check_status(Bytes message) {
  const auto status = decode_status(message);
  if (!status) {
    require(status.error().code == ErrorCode::device || status.error().code == ErrorCode::version_mismatch);
    return;
  }
  const auto again = decode_status(encode_status(status.value()));  // unused flags and bytes are not kept
  require(again && encode_status(again.value()) == encode_status(status.value()));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const Bytes bytes = std::as_bytes(std::span(data, size));
  if (bytes.empty()) {
    return 0;
  }
  switch (data[0]) {
    case 0:
      check_control(bytes.subspan(1));
      break;
    case 1:
      check_stream(bytes.subspan(1));
      break;
    default:
      check_status(bytes.subspan(1));
  }
  return 0;
}
