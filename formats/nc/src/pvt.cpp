#include <fmt/format.h>

#include "nc_words.hpp"

namespace gravure::nc {
namespace {

constexpr double kMsPerS = 1000;

/// "X1.000000000:0.000000000 Y..."
void append_moves(const StageBlock& block, std::size_t stages, std::string& text) {
  for (std::size_t i = 0; i < stages; ++i) {
    text += i == 0 ? "" : " ";
    text += kStageLetters[i];
    text += number(block.place[i]) + ":" + number(block.speed[i]);
  }
  text += '\n';
}

Result<void> take_moves(LineReader& lines, std::size_t stages, StageBlock& block) {
  for (std::size_t i = 0; i < stages; ++i) {
    const bool letter = (i == 0 || lines.take(" ")) && lines.take(std::string(1, kStageLetters[i]));
    const auto where = letter ? lines.take_number() : std::nullopt;
    const auto fast = where && lines.take(":") ? lines.take_number() : std::nullopt;
    if (!fast) {
      return lines.bad(std::string("must go on with ") + kStageLetters[i] + "place:speed");
    }
    block.place[i] = *where;
    block.speed[i] = *fast;
  }
  return lines.at_end_of_line() ? Result<void>() : lines.bad("goes on behind its moves");
}

}  // namespace

std::string pvt_start(const StagePlace& start, std::string_view title, std::size_t stages) {
  std::string text =
      "; " + comment(title) + "\n; places in mm and degrees, speeds a second\nOPEN PROG 1 CLEAR\nABS\nRAPID\n";
  for (std::size_t i = 0; i < stages; ++i) {
    text += i == 0 ? "" : " ";
    text += kStageLetters[i];
    text += number(start[i]);
  }
  return text + "\n";
}

void append_pvt(const StageBlock& block, std::string& text, std::size_t stages) {
  text += fmt::format("PVT{:.9f}\n", block.duration_s * kMsPerS);
  append_moves(block, stages, text);
}

std::string pvt_end() {
  return "CLOSE\n";
}

Result<StageProgram> parse_pvt(std::string_view text) {
  if (text.size() > kMostProgramBytes) {
    return Error{ErrorCode::bad_file, "longer than 1 GiB"};
  }
  LineReader lines(text);
  StageProgram program;
  for (const std::string_view head : {"OPEN PROG 1 CLEAR", "ABS", "RAPID"}) {
    if (!lines.next() || !lines.take(head) || !lines.at_end_of_line()) {
      return lines.bad("must be " + std::string(head));
    }
  }
  lines.next();
  program.stages = lines.holds(std::string{' ', kStageLetters[kStages]}) ? kMostStages : kStages;
  for (std::size_t i = 0; i < program.stages; ++i) {
    const bool letter = (i == 0 || lines.take(" ")) && lines.take(std::string(1, kStageLetters[i]));
    const auto where = letter ? lines.take_number() : std::nullopt;
    if (!where) {
      return lines.bad(std::string("must go on with ") + kStageLetters[i] + " and a number");
    }
    program.start[i] = *where;
  }
  while (lines.next()) {
    if (lines.take("CLOSE")) {
      return program;
    }
    StageBlock block;
    const auto ms = lines.take("PVT") ? lines.take_number() : std::nullopt;
    if (!ms || *ms <= 0 || !lines.at_end_of_line()) {
      return lines.bad("must be PVT and a time above 0, or CLOSE");
    }
    block.duration_s = *ms / kMsPerS;
    if (!lines.next()) {
      return lines.bad("ends without moves");
    }
    GRAVURE_CHECK(take_moves(lines, program.stages, block));
    program.blocks.push_back(block);
  }
  return lines.bad("ends without CLOSE");
}

StagePlace straight_between(const StagePlace& from, const StageBlock& block, double share) {
  StagePlace place{};
  for (std::size_t i = 0; i < kMostStages; ++i) {
    place[i] = from[i] + share * (block.place[i] - from[i]);
  }
  return place;
}

StagePlace cubic_between(const StagePlace& from, const StagePlace& from_speed, const StageBlock& block, double share) {
  StagePlace place{};
  const double rest = 1 - share;
  for (std::size_t i = 0; i < kMostStages; ++i) {
    const double way = block.place[i] - from[i];
    place[i] = from[i] + share * share * (3 - 2 * share) * way +
               share * rest * block.duration_s * (rest * from_speed[i] - share * block.speed[i]);
  }
  return place;
}

}  // namespace gravure::nc
