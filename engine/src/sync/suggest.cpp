#include "gravure/sync/suggest.hpp"

#include <algorithm>
#include <cassert>
#include <cstdlib>
#include <string>
#include <tuple>
#include <utility>

#include "check_job.hpp"
#include "exact_criterion.hpp"
#include "gravure/sync/make_plan.hpp"

namespace gravure {

using namespace sync_plan;

namespace {

constexpr std::int64_t kMostCandidates = 100'000'000;

/// An exact (np, nL) and how far it is from the job.
struct Candidate {
  std::int64_t change = 0;  ///< |delta nL| np + delta np nL: the relative changes summed, times np nL
  std::int64_t slots = 0;
  std::int64_t lines = 0;

  bool operator<(const Candidate& other) const {
    return std::tie(change, slots, lines) < std::tie(other.change, other.slots, other.lines);
  }
};

/// How far nL may move each way, by what gives way.
struct LinesReach {
  std::int64_t fewer_by_pitch = 0;
  std::int64_t more_by_pitch = 0;
  std::int64_t fewer_by_diameter = 0;
  std::int64_t more_by_diameter = 0;

  std::int64_t fewer() const { return std::max(fewer_by_pitch, fewer_by_diameter); }
  std::int64_t more() const { return std::max(more_by_pitch, more_by_diameter); }
  bool allows_pitch(std::int64_t delta) const { return delta <= more_by_pitch && -delta <= fewer_by_pitch; }
  bool allows_diameter(std::int64_t delta) const { return delta <= more_by_diameter && -delta <= fewer_by_diameter; }
};

/// The job without extra slots and fraction: what suggestions are measured against.
Job plain_job(const Job& job) {
  Job plain = job;
  plain.scanner.max_extra_slots = 0;
  plain.fpga.fractional = false;
  return plain;
}

Result<void> check_tolerances(const SuggestTolerances& tolerances) {
  const auto check = [](const char* name, const Rational& value, const Rational& most) -> Result<void> {
    if (value < 0 || value > most) {
      return Error{ErrorCode::out_of_range, std::string("tolerance ") + name + " = " + number_text(value) +
                                                ": must be 0 to " + number_text(most)};
    }
    return {};
  };
  GRAVURE_CHECK(check("lines_per_revolution", Rational(tolerances.lines_per_revolution), Rational(kMostCount)));
  GRAVURE_CHECK(check("extra_slots", Rational(tolerances.extra_slots), Rational(kMostCount)));
  GRAVURE_CHECK(check("pitch_percent", tolerances.pitch_percent, Rational(100)));
  return check("diameter_um", tolerances.diameter_um, Rational(kMostCount));
}

/// Circumference in um for `lines` at the pitch of the job, to 1 nm on the key that is in the job.
Rational circumference_for(const Job& job, const Plan& plan, std::int64_t lines) {
  const Rational pitch = job.rotary.line_pitch_um.value_or(plan.rotary.line_pitch_um);
  const Rational per_key = job.rotary.circumference_mm ? Rational(1) : pi();
  const Rational nanometres = pitch * Rational(lines) / per_key * Rational(1000);
  return Rational(round_of(nanometres)) * per_key / Rational(1000);
}

Rational diameter_um_of(const Rational& circumference_um) {
  return circumference_um / pi();
}

bool pitch_allows(const Plan& plan, const SuggestTolerances& tolerances, std::int64_t lines) {
  const Rational pitch_um = plan.rotary.circumference_um / Rational(lines);
  const Rational change = abs(Rational(pitch_um / plan.rotary.line_pitch_um - 1));
  return change * Rational(100) <= tolerances.pitch_percent;
}

bool diameter_allows(const Job& job, const Plan& plan, const SuggestTolerances& tolerances, std::int64_t lines) {
  const Rational circumference_um = circumference_for(job, plan, lines);
  const Rational change_um = abs(Rational(diameter_um_of(circumference_um - plan.rotary.circumference_um)));
  // A pitch of few nanometres could not find its nL again after the rounding.
  const bool same_lines = !job.rotary.line_pitch_um || round_of(circumference_um / *job.rotary.line_pitch_um) == lines;
  return change_um <= tolerances.diameter_um && same_lines;
}

/// Largest distance 0..most that `allows`, which holds up to some distance and not beyond.
template <class Allows>
std::int64_t largest_distance(std::int64_t most, const Allows& allows) {
  std::int64_t good = 0;
  while (good < most) {
    const std::int64_t middle = good + (most - good + 1) / 2;
    if (allows(middle)) {
      good = middle;
    } else {
      most = middle - 1;
    }
  }
  return good;
}

/// Both changes grow with |delta nL|: bisection finds where the tolerances end.
LinesReach lines_reach(const Job& job, const Plan& plan, const SuggestTolerances& tolerances) {
  const std::int64_t lines = plan.rotary.lines_per_revolution;
  const std::int64_t fewer = std::min(tolerances.lines_per_revolution, lines - 1);
  const std::int64_t more = std::min(tolerances.lines_per_revolution, kMostCount - lines);
  const auto by_pitch = [&](std::int64_t side) {
    return [&, side](std::int64_t away) { return pitch_allows(plan, tolerances, lines + side * away); };
  };
  const auto by_diameter = [&](std::int64_t side) {
    return [&, side](std::int64_t away) { return diameter_allows(job, plan, tolerances, lines + side * away); };
  };
  return {.fewer_by_pitch = largest_distance(fewer, by_pitch(-1)),
          .more_by_pitch = largest_distance(more, by_pitch(1)),
          .fewer_by_diameter = largest_distance(fewer, by_diameter(-1)),
          .more_by_diameter = largest_distance(more, by_diameter(1))};
}

/// The nearest exact candidates, best first. Each stands for one suggestion at least.
Result<std::vector<Candidate>> exact_candidates(const Job& job, const Plan& plan, const SuggestTolerances& tolerances,
                                                const LinesReach& reach) {
  const std::int64_t step = plan.line.slots_per_microvector;
  const std::int64_t steps = tolerances.extra_slots / step;
  const Integer count = Integer(steps + 1) * (reach.fewer() + reach.more() + 1);
  if (count > kMostCandidates) {
    return Error{ErrorCode::out_of_range, "tolerances: " + to_string(count) +
                                              " candidates (extra_slots times lines_per_revolution); at most " +
                                              std::to_string(kMostCandidates) + " are looked at"};
  }
  ExactCriterion criterion(job, plan);
  const std::int64_t middle = plan.rotary.lines_per_revolution;
  std::vector<Candidate> nearest;  // a heap, the farthest on top
  for (std::int64_t extra = 0; extra <= steps * step; extra += step) {
    criterion.set_slots(plan.line.slots + extra);
    for (std::int64_t lines = middle - reach.fewer(); lines <= middle + reach.more(); ++lines) {
      if (!criterion.fits(lines)) {
        continue;
      }
      const std::int64_t away = std::abs(lines - middle);
      nearest.push_back(
          {.change = away * plan.line.slots + extra * middle, .slots = plan.line.slots + extra, .lines = lines});
      std::push_heap(nearest.begin(), nearest.end());
      if (nearest.size() > tolerances.most_suggestions) {
        std::pop_heap(nearest.begin(), nearest.end());
        nearest.pop_back();
      }
    }
  }
  std::sort_heap(nearest.begin(), nearest.end());
  return nearest;
}

// --- what a suggestion says ---

void add_geometry_keys(const Job& job, Suggestion& suggestion, const Rational& circumference_um) {
  const RotarySettings& rotary = job.rotary;
  if (suggestion.geometry == GeometryChange::pitch || rotary.lines_per_revolution) {
    suggestion.keys.push_back({"rotary.lines_per_revolution", std::to_string(suggestion.lines_per_revolution)});
  }
  if (suggestion.geometry == GeometryChange::pitch && rotary.line_pitch_um) {
    suggestion.keys.push_back({"rotary.line_pitch_um", std::nullopt});
  }
  if (suggestion.geometry == GeometryChange::diameter) {
    const bool by_circumference = rotary.circumference_mm.has_value();
    const Rational size_um = by_circumference ? circumference_um : diameter_um_of(circumference_um);
    suggestion.keys.push_back({by_circumference ? "rotary.circumference_mm" : "rotary.diameter_mm",
                               to_decimal_string(size_um / Rational(1000))});
  }
}

Suggestion describe(const Job& job, const Plan& plan, const Candidate& candidate, GeometryChange geometry) {
  Suggestion suggestion;
  suggestion.lines_per_revolution = candidate.lines;
  suggestion.slots = candidate.slots;
  suggestion.geometry = geometry;
  const Rational circumference_um = geometry == GeometryChange::diameter ? circumference_for(job, plan, candidate.lines)
                                                                         : plan.rotary.circumference_um;
  suggestion.line_pitch_um = circumference_um / Rational(candidate.lines);
  suggestion.delta_line_pitch_um = suggestion.line_pitch_um - plan.rotary.line_pitch_um;
  suggestion.diameter_mm = diameter_um_of(circumference_um) / Rational(1000);
  suggestion.delta_diameter_um = diameter_um_of(circumference_um - plan.rotary.circumference_um);
  const std::int64_t extra = candidate.slots - plan.line.slots;
  suggestion.delta_line_time_us = Rational(extra) / plan.clock.pulse_hz * Rational(1'000'000);
  suggestion.delta_line_time_percent = ratio(Integer(extra) * 100, plan.line.slots);
  const Rational wanted = plan.ab.wanted_increment * ratio(Integer(plan.line.slots) * plan.rotary.lines_per_revolution,
                                                           Integer(candidate.slots) * candidate.lines);
  const std::optional<AbPair> pair = exact_ab_pair(wanted, job.fpga.counter_bits, job.fpga.max_prescaler);
  assert(pair.has_value());
  suggestion.ab = pair.value_or(AbPair{});
  if (extra != 0) {
    suggestion.keys.push_back({"scanner.turn_slots", std::to_string(candidate.slots - plan.line.pixels)});
  }
  if (geometry != GeometryChange::none) {
    add_geometry_keys(job, suggestion, circumference_um);
  }
  return suggestion;
}

}  // namespace

Result<std::vector<Suggestion>> suggest(const Job& job, std::int64_t pixels_per_line, std::int64_t revolutions,
                                        const SuggestTolerances& tolerances) {
  GRAVURE_CHECK(check_tolerances(tolerances));
  const Job plain = plain_job(job);
  GRAVURE_TRY(const Plan plan, make_plan(plain, pixels_per_line, revolutions));
  const LinesReach reach = lines_reach(plain, plan, tolerances);
  GRAVURE_TRY(const std::vector<Candidate> candidates, exact_candidates(plain, plan, tolerances, reach));
  std::vector<Suggestion> suggestions;
  const auto add = [&](const Candidate& candidate, GeometryChange geometry) {
    if (suggestions.size() < tolerances.most_suggestions) {
      suggestions.push_back(describe(plain, plan, candidate, geometry));
    }
  };
  for (const Candidate& candidate : candidates) {
    const std::int64_t delta = candidate.lines - plan.rotary.lines_per_revolution;
    if (delta == 0) {
      add(candidate, GeometryChange::none);
      continue;
    }
    if (reach.allows_pitch(delta)) {
      add(candidate, GeometryChange::pitch);
    }
    if (reach.allows_diameter(delta)) {
      add(candidate, GeometryChange::diameter);
    }
  }
  return suggestions;
}

Result<SuggestOutlook> suggest_outlook(const Job& job, std::int64_t pixels_per_line, std::int64_t revolutions,
                                       const SuggestTolerances& tolerances) {
  SuggestOutlook outlook;
  SuggestTolerances first_only = tolerances;
  first_only.most_suggestions = 1;
  const Job plain = plain_job(job);
  GRAVURE_TRY(const Plan plan, make_plan(plain, pixels_per_line, revolutions));
  if (const auto fraction = exact_fraction(plan.ab.wanted_increment, plan.ab.counter_bits)) {
    outlook.fraction = fraction.value();
  }
  Job coarser = plain;
  while (coarser.rotary.interpolation_bits > 0 && !outlook.nearest) {
    --coarser.rotary.interpolation_bits;
    GRAVURE_TRY(std::vector<Suggestion> found, suggest(coarser, pixels_per_line, revolutions, first_only));
    if (!found.empty()) {
      outlook.interpolation_bits = coarser.rotary.interpolation_bits;
      outlook.nearest = std::move(found.front());
      outlook.nearest->keys.insert(outlook.nearest->keys.begin(),
                                   {"rotary.interpolation_bits", std::to_string(coarser.rotary.interpolation_bits)});
    }
  }
  return outlook;
}

Job apply(const Job& job, const Suggestion& suggestion) {
  Job changed = job;
  for (const auto& [key, value] : suggestion.keys) {
    // The values are our own: decimals, and whole where the field is.
    const Rational number = value ? parse_decimal(*value).value() : Rational(0);
    const auto whole = static_cast<std::int64_t>(floor_of(number));
    if (key == "scanner.turn_slots") {
      changed.scanner.turn_slots = whole;
    } else if (key == "rotary.interpolation_bits") {
      changed.rotary.interpolation_bits = static_cast<int>(whole);
    } else if (key == "rotary.lines_per_revolution") {
      changed.rotary.lines_per_revolution = whole;
    } else if (key == "rotary.line_pitch_um") {
      changed.rotary.line_pitch_um.reset();
    } else if (key == "rotary.circumference_mm") {
      changed.rotary.circumference_mm = number;
    } else if (key == "rotary.diameter_mm") {
      changed.rotary.diameter_mm = number;
    }
  }
  return changed;
}

}  // namespace gravure
