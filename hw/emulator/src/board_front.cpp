#include "board_front.hpp"

#include <algorithm>
#include <filesystem>
#include <span>
#include <string_view>

#include "gravure/core/crc32c.hpp"
#include "gravure/emulator/board_name.hpp"
#include "gravure/fpga/register_map.hpp"
#include "gravure/protocol/start_sequence.hpp"

namespace gravure::emulator {
namespace {

__extension__ using Wide = unsigned __int128;

BoardMachine::Setup setup_of(const BoardOptions& options) {
  return {.capacity_bytes = options.capacity_bytes,
          .fifo_bits = options.fifo_bits,
          .random = options.seed,
          .stands_still = !options.now_ns,
          .faults = options.faults};
}

/// What a board that stands in a folder cannot become.
template <class Value>
Result<void> check_same(const std::string& path, const char* key, const Value& given, const Value& stored,
                        const std::string& stored_text) {
  return given == Value() || given == stored
             ? Result<void>()
             : Error{ErrorCode::bad_argument, "emulated:" + path + ": the board in this folder has " + key + "=" +
                                                  stored_text + "; leave " + key + " out, or give another folder"};
}

Record event_record(BoardEvent event, std::uint64_t clock) {
  return {.kind = static_cast<std::uint32_t>(event), .number = clock};
}

/// Writes that make the registers what they are.
std::vector<Record> register_writes(BoardMachine& machine) {
  std::vector<Record> writes;
  for (const fpga::Register& one : fpga::kRegisters) {
    if (one.access != fpga::RegisterAccess::read_write) {
      continue;
    }
    const std::uint32_t low = machine.stored_word(one.address);
    const std::uint32_t high = one.bits > 32 ? machine.stored_word(static_cast<std::uint8_t>(one.address + 1)) : 0;
    if ((low | std::uint64_t{high} << 32U) == one.reset) {
      continue;
    }
    Record write = event_record(BoardEvent::write, machine.clock());
    write.a = one.address;
    write.b = low;
    writes.push_back(write);
    if (one.bits > 32) {
      ++write.a;
      write.b = high;
      writes.push_back(write);
    }
  }
  return writes;
}

}  // namespace

BoardOptions EmulatedBoard::Front::filled_in(BoardOptions options, const std::string& path) {
  options.capacity_bytes = options.capacity_bytes == 0 ? kDefaultCapacity : options.capacity_bytes;
  options.fifo_bits = options.fifo_bits == 0 ? kDefaultFifoBits : options.fifo_bits;
  if (options.serial.empty()) {
    constexpr char kDigits[] = "0123456789ABCDEF";
    std::error_code unknown;
    const std::string whole = std::filesystem::weakly_canonical(path, unknown).string();
    const std::uint32_t hash = ~crc32c_continue(kCrc32cStart, std::as_bytes(std::span(whole.data(), whole.size())));
    options.serial = "EMU";
    for (int shift = 28; shift >= 0; shift -= 4) {
      options.serial += kDigits[(hash >> static_cast<unsigned>(shift)) & 15U];
    }
  }
  return options;
}

EmulatedBoard::Front::Front(BoardOptions options)
    : options_(std::move(options)), machine_(std::make_unique<BoardMachine>(setup_of(options_), *this)) {
  start_clock();
}

Result<std::unique_ptr<EmulatedBoard::Front>> EmulatedBoard::Front::open(const std::string& folder,
                                                                         BoardOptions options) {
  GRAVURE_TRY(BoardFolder opened, BoardFolder::open(folder));
  const bool is_new = opened.is_new();
  auto front = std::make_unique<Front>(is_new ? filled_in(std::move(options), folder) : std::move(options));
  front->path_ = folder;
  front->folder_.emplace(std::move(opened));
  if (is_new) {
    front->begin_folder(false);
  } else {
    GRAVURE_CHECK(front->resume());
  }
  GRAVURE_CHECK(front->health_);
  return front;
}

// Time

void EmulatedBoard::Front::start_clock() {
  start_ns_ = options_.now_ns ? options_.now_ns() : 0;
  start_clock_ = machine_->clock();
}

std::uint64_t EmulatedBoard::Front::clock() const {
  if (!options_.now_ns) {
    return machine_->clock();
  }
  return start_clock_ +
         static_cast<std::uint64_t>(Wide{options_.now_ns() - start_ns_} * options_.seed_hz / 1'000'000'000U);
}

// Events

void EmulatedBoard::Front::keep(const Result<void>& result) {
  if (health_ && !result) {
    health_ = result;
  }
}

/// False: nothing may happen, as nobody would know.
bool EmulatedBoard::Front::note(const Record& event) {
  if (folder_ && !replays_ && health_) {
    keep(folder_->note(event));
  }
  return static_cast<bool>(health_);
}

std::size_t EmulatedBoard::Front::apply(const Record& event) {
  std::size_t taken = 0;
  switch (static_cast<BoardEvent>(event.kind)) {
    case BoardEvent::write:
      obey(machine_->write_register(static_cast<std::uint8_t>(event.a), event.b, event.number));
      break;
    case BoardEvent::take:
      taken = machine_->take(event.payload, event.number);
      break;
    case BoardEvent::pass:
      machine_->pass_time(event.number);
      break;
    case BoardEvent::gone:
      machine_->lose_host();
      break;
    case BoardEvent::interlock:
      machine_->open_interlock(event.number);
      break;
    case BoardEvent::counters:
      machine_->restore({event.a, {event.b, event.c}, static_cast<std::uint32_t>(event.number)});
      break;
    case BoardEvent::begin:
    case BoardEvent::options:
      break;
  }
  if (machine_->power_lost()) {
    power_up_again();
  }
  return taken;
}

/// After an acknowledge the state is short: the events before it need not be kept.
void EmulatedBoard::Front::obey(std::uint16_t commands) {
  if ((commands & protocol::kCommandAcknowledge) != 0 && machine_->rests() && folder_ && !replays_ && health_) {
    begin_folder(true);
  }
}

void EmulatedBoard::Front::power_up_again() {
  ++power_up_;
  const BoardMachine::Setup setup = machine_->setup_from_now();
  machine_ = std::make_unique<BoardMachine>(setup, *this);
  start_clock();
  if (replays_) {
    begin_due_ = true;
  } else if (folder_) {
    begin_folder(false);
  }
}

void EmulatedBoard::Front::begin_folder(bool with_state) {
  const BoardMachine::Setup& setup = machine_->setup_from_now();
  options_.seed = setup.random;
  options_.faults = setup.faults;
  std::vector<Record> events;
  if (with_state) {
    events = register_writes(*machine_);
    const BoardMachine::Counters now = machine_->counters();
    events.push_back({.kind = static_cast<std::uint32_t>(BoardEvent::counters),
                      .a = now.executed,
                      .b = now.place.revolution,
                      .c = now.place.line,
                      .number = now.taken});
  }
  keep(folder_->begin(power_up_, board_options_text(options_), events));
}

void EmulatedBoard::Front::on_line(const ExecutedLine& line) {
  if (folder_ && health_) {
    const std::uint64_t lines = machine_->settings().lines_per_revolution;
    const auto ordinal = static_cast<std::uint64_t>(line.ordinal);
    const Result<bool> fresh =
        folder_->fire(static_cast<std::uint32_t>(ordinal / lines), static_cast<std::uint32_t>(ordinal % lines), line);
    keep(fresh ? Result<void>() : Result<void>(fresh.error()));
    if (!fresh || !fresh.value()) {
      return;
    }
  }
  if (health_ && options_.observer != nullptr) {
    options_.observer->on_line(line);
  }
}

// What the host and the world do

std::uint32_t EmulatedBoard::Front::read_register(std::uint8_t address) {
  return machine_->read_register(address, clock());
}

void EmulatedBoard::Front::write_register(std::uint8_t address, std::uint32_t value) {
  Record event = event_record(BoardEvent::write, clock());
  event.a = address;
  event.b = value;
  if (note(event)) {
    apply(event);
  }
}

std::size_t EmulatedBoard::Front::take(std::span<const std::byte> stream) {
  Record event = event_record(BoardEvent::take, clock());
  event.payload = stream.first(std::min(stream.size(), machine_->room(event.number)));
  return !event.payload.empty() && note(event) ? apply(event) : 0;
}

void EmulatedBoard::Front::pass_time() {
  if (!machine_->stands_still()) {
    if (health_) {
      machine_->pass_time(clock());  // of itself, not an event
    }
    if (machine_->power_lost()) {
      power_up_again();
    }
  } else if (machine_->can_run()) {
    happens(BoardEvent::pass);
  }
}

void EmulatedBoard::Front::happens(BoardEvent event) {
  const Record record = event_record(event, clock());
  if (note(record)) {
    apply(record);
  }
}

void EmulatedBoard::Front::power_cycle() {
  pass_time();
  power_up_again();
}

BoardStatus EmulatedBoard::Front::status() const {
  BoardStatus status = machine_->status();
  status.power_up = power_up_;
  return status;
}

// A folder that is there

Result<void> EmulatedBoard::Front::take_event(const Record& event) {
  const auto kind = static_cast<BoardEvent>(event.kind);
  const std::string_view text(reinterpret_cast<const char*>(event.payload.data()), event.payload.size());
  if (kind == BoardEvent::begin || kind == BoardEvent::options) {
    BoardOptions stored;
    GRAVURE_CHECK(parse_board_options(text, stored));
    if (kind == BoardEvent::options) {
      machine_->set_up(setup_of(stored));
      return {};
    }
    power_up_ = event.number;
    GRAVURE_CHECK(take_stored(stored));
    machine_ = std::make_unique<BoardMachine>(setup_of(stored), *this);
    return {};
  }
  if (event.kind == 0 || kind > BoardEvent::counters) {
    return Error{ErrorCode::bad_file, path_ + "/" + kHostFile + ": an event of kind " + std::to_string(event.kind) +
                                          ", not known; the state of this board is damaged: give another folder"};
  }
  apply(event);
  return health_;
}

/// What was not given is as the folder has it; what was must be the same.
Result<void> EmulatedBoard::Front::take_stored(const BoardOptions& stored) {
  GRAVURE_CHECK(check_same(path_, "serial", options_.serial, stored.serial, stored.serial));
  GRAVURE_CHECK(check_same(path_, "capacity", options_.capacity_bytes, stored.capacity_bytes,
                           std::to_string(stored.capacity_bytes)));
  GRAVURE_CHECK(check_same(path_, "fifo_bits", options_.fifo_bits, stored.fifo_bits, std::to_string(stored.fifo_bits)));
  options_.serial = stored.serial;
  options_.capacity_bytes = stored.capacity_bytes;
  options_.fifo_bits = stored.fifo_bits;
  return {};
}

Result<void> EmulatedBoard::Front::resume() {
  replays_ = true;
  GRAVURE_CHECK(folder_->replay([this](const Record& event) { return take_event(event); }));
  const Record gone = event_record(BoardEvent::gone, machine_->clock());
  GRAVURE_CHECK(folder_->note(gone));
  apply(gone);
  GRAVURE_CHECK(health_);
  GRAVURE_CHECK(folder_->end_replay());
  replays_ = false;
  machine_->set_up(setup_of(options_));
  start_clock();
  if (begin_due_) {
    begin_folder(false);
    return health_;
  }
  const std::string text = board_options_text(options_);
  Record options = event_record(BoardEvent::options, machine_->clock());
  options.payload = std::as_bytes(std::span(text.data(), text.size()));
  return folder_->note(options);
}

}  // namespace gravure::emulator
