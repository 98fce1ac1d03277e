#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string_view>
#include <vector>

#include "board_folder.hpp"
#include "board_machine.hpp"
#include "gravure/core/crc32c.hpp"
#include "gravure/emulator/board_name.hpp"
#include "record_file.hpp"

// The files of a board's folder. An input is read as it is and again with checksums that hold, so that what stands
// behind them is reached too; what was read must be what the writer makes of it, and a machine takes it as its events.
// Whatever text is in there is read as a name and its options.

namespace {

using namespace gravure;
using namespace gravure::emulator;
using Bytes = std::span<const std::byte>;

void require(bool holds) {
  if (!holds) {
    std::abort();
  }
}

class Nobody final : public PinObserver {
 public:
  void on_line(const ExecutedLine&) override {}
};

void happen(BoardMachine& machine, const Record& event) {
  switch (static_cast<BoardEvent>(event.kind)) {
    case BoardEvent::write:
      machine.write_register(static_cast<std::uint8_t>(event.a), event.b, event.number);
      break;
    case BoardEvent::take:
      require(machine.take(event.payload, event.number) <= event.payload.size());
      break;
    case BoardEvent::pass:
      machine.pass_time(event.number);
      break;
    case BoardEvent::gone:
      machine.lose_host();
      break;
    case BoardEvent::interlock:
      machine.open_interlock(event.number);
      break;
    case BoardEvent::counters:
      machine.restore({event.a, {event.b, event.c}, static_cast<std::uint32_t>(event.number)});
      break;
    default:
      break;
  }
  const BoardStatus status = machine.status();
  require(status.level_bytes <= status.capacity_bytes);
}

void read_records(Bytes file) {
  Bytes rest = file;
  const auto source = [&rest](std::span<std::byte> out) -> Result<std::size_t> {
    const std::size_t count = std::min(out.size(), rest.size());
    std::copy_n(rest.begin(), count, out.begin());
    rest = rest.subspan(count);
    return count;
  };
  Result<RecordReader> reader = RecordReader::open(source, "input", kHostMagic);
  if (!reader) {
    return;
  }
  Nobody nobody;
  BoardMachine machine({.capacity_bytes = 4096, .fifo_bits = 12, .random = 1, .faults = {}}, nobody);
  std::vector<std::byte> again;
  append_file_head(again, kHostMagic);
  for (;;) {
    const auto record = reader.value().next();
    if (!record) {
      require(!record.error().message.empty());
      break;
    }
    if (!record.value()) {
      break;
    }
    append_record(again, *record.value());
    happen(machine, *record.value());
  }
  constexpr std::size_t kReserved = 4;
  require(again.size() == std::max<std::uint64_t>(reader.value().end(), kFileHeadBytes));
  require(again.size() > file.size() ||
          std::equal(again.begin() + kFileHeadBytes, again.end(), file.begin() + kFileHeadBytes) ||
          again.size() < kFileHeadBytes + kReserved);
}

/// Gives every record checksums that hold, as far as lengths reach.
void renew(std::vector<std::byte>& file) {
  constexpr std::size_t kHead = 32;
  const auto put = [&file](std::size_t at, Bytes over) {
    const std::uint32_t crc = ~crc32c_continue(kCrc32cStart, over);
    for (unsigned i = 0; i < 4; ++i) {
      file[at + i] = static_cast<std::byte>(crc >> (8 * i));
    }
  };
  std::size_t at = kFileHeadBytes;
  while (file.size() >= at + kHead) {
    put(at + kHead - 4, Bytes(file).subspan(at, kHead - 4));
    const std::size_t length = std::to_integer<std::size_t>(file[at + 24]) | std::to_integer<std::size_t>(file[at + 25])
                                                                                 << 8U;
    file[at + 26] = file[at + 27] = std::byte{0};
    put(at + kHead - 4, Bytes(file).subspan(at, kHead - 4));
    at += kHead;
    if (length != 0 && file.size() >= at + length + 4) {
      put(at + length, Bytes(file).subspan(at, length));
    }
    at += length == 0 ? 0 : length + 4;
  }
}

void read_name(std::string_view text) {
  const Result<BoardName> name = parse_board_name(text);
  if (!name) {
    require(!name.error().message.empty());
    return;
  }
  const std::string options = board_options_text(name.value().options);
  BoardOptions same;
  require(static_cast<bool>(parse_board_options(options, same)));
  require(board_options_text(same) == options);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const Bytes input = std::as_bytes(std::span(data, size));
  read_records(input);
  std::vector<std::byte> sealed(input.begin(), input.end());
  renew(sealed);
  read_records(sealed);
  read_name(std::string_view(reinterpret_cast<const char*>(data), size));
  return 0;
}
