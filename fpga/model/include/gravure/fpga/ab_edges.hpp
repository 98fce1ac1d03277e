#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include "gravure/fpga/ab_registers.hpp"

namespace gravure::fpga {

/// Where an A-B channel stands after some clock since reset, in closed form.
struct AbPosition {
  std::uint64_t steps = 0;        ///< K = floor(clock / m)
  Uint128 counts = 0;             ///< the counter unwrapped: K * increment + floor(K * num / den)
  std::uint64_t accumulator = 0;  ///< K * num mod den
  std::uint64_t edges = 0;        ///< floor(counts / 2^(bits-2)); at most K, so 64 bits hold it
  AbPins pins;
};

/// The position after `clock` clocks. check(registers) must be none; then counts < 2^126 + 2^64 at any clock.
AbPosition position_after(const AbRegisters& registers, std::uint64_t clock) noexcept;

/// One change of a pin; exactly one of A and B changed.
struct AbEdge {
  std::uint64_t clock = 0;  ///< the first clock after which the pins show this
  AbPins pins;
};

/// The A-B generator, edge by edge: the same edges as AbCounter, without visiting the clocks between them.
///
/// With P = increment * den + num and Q = 2^(bits-2) * den, edge e falls on step K_e = ceil(e Q / P), which is clock
/// m K_e. Writing e Q = K_e P - slack, the next edge follows from Q = q P + rest by one comparison and one addition:
/// slack < rest: q + 1 steps, slack += P - rest; else q steps, slack -= rest. No division an edge. P and Q are reduced
/// to lowest terms first, so that nearly always 64 bits hold them; 128 bits do where not.
class AbEdges {
 public:
  /// Nothing where check() refuses the registers. Starts after clock 0.
  static std::optional<AbEdges> make(const AbRegisters& registers) noexcept;

  /// Continues from just after `clock`: next_edge() is the first edge on a later clock.
  void seek(std::uint64_t clock) noexcept;

  /// Next edge, or nothing where none is left up to clock 2^64 - 1.
  std::optional<AbEdge> next_edge() noexcept {
    if (exhausted_) {
      return std::nullopt;
    }
    const AbEdge edge{next_clock_, pins_of_quarter(++edges_)};
    if (wide_) {
      advance(wide_walk_);
    } else {
      advance(narrow_walk_);
    }
    return edge;
  }

  /// Calls sink(const AbEdge&) for every edge up to and including clock `last`.
  template <class Sink>
  void run_to(std::uint64_t last, Sink&& sink) {
    if (wide_) {
      run(wide_walk_, last, sink);
    } else {
      run(narrow_walk_, last, sink);
    }
  }

  /// Edges put out since reset, those skipped by seek() included.
  std::uint64_t edges() const noexcept { return edges_; }
  const AbRegisters& registers() const noexcept { return registers_; }

 private:
  /// The state of the recurrence, in the narrower word that holds it.
  template <class Word>
  struct Walk {
    Word slack = 0;  ///< of the pending edge
    Word rest = 0;   ///< Q mod P
    Word back = 0;   ///< P - rest
  };

  explicit AbEdges(const AbRegisters& registers) noexcept;

  template <class Word>
  void advance(Walk<Word>& walk) noexcept {
    const bool longer = walk.slack < walk.rest;
    walk.slack = longer ? walk.slack + walk.back : walk.slack - walk.rest;
    exhausted_ = __builtin_add_overflow(next_clock_, longer ? long_gap_ : short_gap_, &next_clock_);
  }

  template <class Word, class Sink>
  void run(Walk<Word>& walk, std::uint64_t last, Sink& sink) {
    AbEdges local = *this;  // lets the compiler keep the state in registers across calls of the sink
    Walk<Word> local_walk = walk;
    const auto one_edge = [&] {
      const AbEdge edge{local.next_clock_, pins_of_quarter(++local.edges_)};
      local.advance(local_walk);
      sink(edge);
    };
    while (!local.exhausted_ && local.next_clock_ <= last) {
      if (local.edges_ % 4 == 0 && last >= local.next_clock_ && (last - local.next_clock_) / 4 > local.long_gap_) {
        local.run_turns(local_walk, last - 4 * local.long_gap_, sink);
      } else {
        one_edge();
      }
    }
    *this = local;
    walk = local_walk;
  }

  /// Whole A-B periods while one starts up to `last_start`: the pins are constants, and no clock can overflow. This is
  /// what keeps the walk ahead of AbCounter even where every clock has an edge.
  template <class Word, class Sink>
  void run_turns(Walk<Word>& walk, std::uint64_t last_start, Sink& sink) {
    Word slack = walk.slack;
    std::uint64_t clock = next_clock_;
    const Word rest = walk.rest;
    const Word back = walk.back;
    const std::uint64_t short_gap = short_gap_;
    const std::uint64_t extra = long_gap_ - short_gap_;
    std::uint64_t turns = 0;
    const auto next_after = [&](std::uint64_t now, std::uint64_t number) {
      sink(AbEdge{now, pins_of_quarter(number)});
      const bool longer = slack < rest;
      slack += longer ? back : Word{0} - rest;
      return now + short_gap + (longer ? extra : 0);
    };
    for (; clock <= last_start; ++turns) {
      for (const std::uint64_t number : {1U, 2U, 3U, 4U}) {
        clock = next_after(clock, number);
      }
    }
    walk.slack = slack;
    next_clock_ = clock;
    edges_ += 4 * turns;
  }

  AbRegisters registers_;
  Uint128 reduced_p_ = 0;  ///< P and Q in lowest terms
  Uint128 reduced_q_ = 0;
  Uint128 common_ = 1;           ///< what they were divided by
  std::uint64_t short_gap_ = 0;  ///< clocks of q and of q + 1 steps; 2^64 - 1 stands for anything longer
  std::uint64_t long_gap_ = 0;
  bool wide_ = false;

  bool exhausted_ = false;
  std::uint64_t edges_ = 0;
  std::uint64_t next_clock_ = 0;  ///< of the pending edge
  Walk<std::uint64_t> narrow_walk_;
  Walk<Uint128> wide_walk_;
};

}  // namespace gravure::fpga
