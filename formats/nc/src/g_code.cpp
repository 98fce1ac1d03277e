#include <fmt/format.h>

#include "nc_words.hpp"

namespace gravure::nc {
namespace {

constexpr double kSecondsPerMinute = 60;

void append_place(const StagePlace& place, std::size_t stages, std::string& text) {
  for (std::size_t i = 0; i < stages; ++i) {
    text += ' ';
    text += kStageLetters[i];
    text += number(place[i]);
  }
}

Result<StagePlace> take_place(LineReader& lines, std::size_t stages) {
  StagePlace place{};
  for (std::size_t i = 0; i < stages; ++i) {
    const bool letter = lines.take(std::string{' ', kStageLetters[i]});
    const auto value = letter ? lines.take_number() : std::nullopt;
    if (!value) {
      return lines.bad(std::string("must go on with ") + kStageLetters[i] + " and a number");
    }
    place[i] = *value;
  }
  return place;
}

Result<void> take_line(LineReader& lines, std::string_view whole) {
  if (!lines.next() || !lines.take(whole) || !lines.at_end_of_line()) {
    return lines.bad("must be " + std::string(whole));
  }
  return {};
}

}  // namespace

std::string g_code_start(const StagePlace& start, std::string_view title, std::size_t stages) {
  std::string text = "%\n(" + comment(title) + ")\nG21 G90 G94\nG0";
  append_place(start, stages, text);
  text += "\nG93\n";
  return text;
}

void append_g_code(const StageBlock& block, std::string& text, std::size_t stages) {
  text += "G1";
  append_place(block.place, stages, text);
  text += fmt::format(" F{:.9f}\n", kSecondsPerMinute / block.duration_s);
}

std::string g_code_end() {
  return "G94\nM30\n%\n";
}

Result<StageProgram> parse_g_code(std::string_view text) {
  if (text.size() > kMostProgramBytes) {
    return Error{ErrorCode::bad_file, "longer than 1 GiB"};
  }
  LineReader lines(text);
  StageProgram program;
  GRAVURE_CHECK(take_line(lines, "%"));
  GRAVURE_CHECK(take_line(lines, "G21 G90 G94"));
  if (!lines.next() || !lines.take("G0")) {
    return lines.bad("must be the start with G0");
  }
  program.stages = lines.holds(std::string{' ', kStageLetters[kStages]}) ? kMostStages : kStages;
  GRAVURE_TRY(program.start, take_place(lines, program.stages));
  GRAVURE_CHECK(take_line(lines, "G93"));
  while (lines.next()) {
    if (lines.take("G94")) {
      GRAVURE_CHECK(take_line(lines, "M30"));
      GRAVURE_CHECK(take_line(lines, "%"));
      return program;
    }
    if (!lines.take("G1")) {
      return lines.bad("must be a block with G1, or G94");
    }
    StageBlock block;
    GRAVURE_TRY(block.place, take_place(lines, program.stages));
    const auto feed = lines.take(" F") ? lines.take_number() : std::nullopt;
    if (!feed || *feed <= 0 || !lines.at_end_of_line()) {
      return lines.bad("must end in F and a number above 0");
    }
    block.duration_s = kSecondsPerMinute / *feed;
    program.blocks.push_back(block);
  }
  return lines.bad("ends without M30");
}

}  // namespace gravure::nc
