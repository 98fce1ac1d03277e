#pragma once

#include <string>
#include <string_view>

#include "gravure/emulator/emulated_board.hpp"

namespace gravure::emulator {

struct BoardName {
  std::string folder;
  BoardOptions options;
};

/// "DIR[,key=value...]" with the keys pace (wait, real), capacity (bytes), fifo_bits, serial, seed, seed_hz and fault,
/// which may come more than once. bad_argument or out_of_range names key, value and what is allowed.
Result<BoardName> parse_board_name(std::string_view text);

/// The options alone, "key=value,...", into `options`.
Result<void> parse_board_options(std::string_view text, BoardOptions& options);
/// All that have a value, as parse_board_options() takes them.
std::string board_options_text(const BoardOptions& options);

}  // namespace gravure::emulator
