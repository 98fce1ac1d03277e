#pragma once

#include <deque>
#include <map>

#include "frame_maker.hpp"
#include "gravure/fpga/register_map.hpp"
#include "stimulus.hpp"

namespace gravure::cosim {

/// Frames into the parser, with idle clocks and damage; after damage it waits and clears.
class FrameStimulus {
 public:
  explicit FrameStimulus(const std::vector<Port>& ports);
  void operator()(Dice& dice, std::span<std::uint64_t> in);

 private:
  std::map<std::string, std::size_t> places_;
  FrameMaker maker_;
  std::deque<std::uint8_t> frame_;  ///< what is left to send
  bool spoilt_ = false;
  int waiting_ = 0;
};

/// A host that drives the whole board: sets it up, fills it, starts it, keeps it fed, now and then does wrong.
class HostStimulus {
 public:
  explicit HostStimulus(const std::vector<Port>& ports);
  void operator()(Dice& dice, std::span<std::uint64_t> in);

 private:
  struct Action {
    enum class Kind { idle, write, byte, start } kind = Kind::idle;
    std::uint64_t address = 0;
    std::uint64_t data = 0;
  };
  void set_up(Dice& dice);
  void set_up_axes(Dice& dice);
  void feed(Dice& dice);
  void set_control(Dice& dice, std::uint64_t bits);
  void write(const fpga::Register& target, std::uint64_t data);
  void send(Dice& dice, FrameMaker::Damage damage);

  std::map<std::string, std::size_t> places_;
  FrameMaker maker_;
  std::deque<Action> actions_;
  std::uint64_t clock_ = 0;
  std::uint64_t started_at_ = 0;
  std::uint64_t line_ticks_ = 1;  ///< in seed clocks, like all here
  std::uint64_t turn_ticks_ = 1;
  std::uint64_t next_index_ = 0;
  std::uint64_t lines_sent_ = 0;
  std::uint64_t control_ = 0;  ///< without the ways of the axes
  bool ready_ = false;
  bool held_ = false;
};

}  // namespace gravure::cosim
