#include "gravure/motion/search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "find_profiles.hpp"
#include "gravure/motion/plan_profile.hpp"
#include "gravure/motion/shaper.hpp"
#include "move_space.hpp"
#include "search_problem.hpp"
#include "worst_case.hpp"

namespace gravure::motion {
namespace {

Alternative measure(const SearchProblem& problem, std::string name, const std::vector<InputJump>& input) {
  Alternative row;
  row.name = std::move(name);
  const ResidualSignal signal = residual_of(problem.modes, input, problem.band.of);
  row.access_time_s = input.back().time_s;
  row.positioning_time_s = row.access_time_s + signal.last_exit_s(problem.band.tolerance);
  row.envelope_time_s = row.access_time_s + signal.envelope_time_s(problem.band.tolerance);
  row.residual = signal.envelope(0);
  row.worst_positioning_time_s = worst_positioning_time_s(problem, input);
  return row;
}

/// The profile of a candidate, planned again from its parameters, so that what is reported is what will run.
Result<Alternative> measure_candidate(const SearchProblem& problem, std::string name, Candidate candidate) {
  GRAVURE_TRY(const Profile profile, plan_profile(request_of(problem, candidate)));
  Alternative row = measure(problem, std::move(name), input_of(profile));
  candidate.access_time_s = row.access_time_s;
  candidate.positioning_time_s = row.positioning_time_s;
  row.profile = candidate;
  return row;
}

/// All limits at once, with the shortest jerk time that keeps the jerk limit.
Candidate fastest_of(const SearchProblem& problem) {
  const double s_factor = least_s_factor(problem, std::max(problem.a_up_max_mm_s2, problem.a_down_max_mm_s2));
  return {problem.v_max_mm_s, problem.a_up_max_mm_s2, problem.a_down_max_mm_s2, s_factor, 0, 0};
}

Result<void> add_shaped(const SearchProblem& problem, ShaperKind kind, SearchReport& report) {
  if (problem.modes.size() > 4) {
    return {};  // make_shaper() says why
  }
  GRAVURE_TRY(const Profile fastest, plan_profile(request_of(problem, fastest_of(problem))));
  GRAVURE_TRY(const auto shaper, make_shaper(kind, problem.modes));
  const char* name = kind == ShaperKind::zv ? "zv" : "zvd";
  report.alternatives.push_back(measure(problem, name, shape_input(input_of(fastest), shaper)));
  report.alternatives.back().profile = fastest_of(problem);
  return {};
}

std::string gain(const SearchReport& report, const Alternative& best, double Alternative::*time) {
  std::string text;
  for (const Alternative& other : report.alternatives) {
    if (other.name != best.name) {
      text += fmt::format("{} {}: {:.3f} ms ({:+.1f} %)", text.empty() ? "" : ",", other.name, other.*time * 1e3,
                          100 * (other.*time / (best.*time) - 1));
    }
  }
  return text;
}

/// How much sooner the asymmetric profile settles than each other row, for exact modes and under their errors.
std::string gains_of_asymmetric(const SearchReport& report) {
  const auto asymmetric = std::find_if(report.alternatives.begin(), report.alternatives.end(),
                                       [](const Alternative& row) { return row.name == "best_asymmetric"; });
  const auto gain = [&](const Alternative& other, double Alternative::*time) {
    return 100 * (1 - *asymmetric.*time / (other.*time));
  };
  std::string text;
  for (const Alternative& other : report.alternatives) {
    if (&other != &*asymmetric) {
      text += fmt::format("{} {} {:+.1f} % ({:+.1f} %)", text.empty() ? "" : ",", other.name,
                          gain(other, &Alternative::positioning_time_s),
                          gain(other, &Alternative::worst_positioning_time_s));
    }
  }
  return text;
}

void judge(const SearchProblem& problem, SearchReport& report) {
  const auto shortest = [&report](double Alternative::*time) {
    return *std::min_element(report.alternatives.begin(), report.alternatives.end(),
                             [time](const Alternative& a, const Alternative& b) { return a.*time < b.*time; });
  };
  const Alternative exact = shortest(&Alternative::positioning_time_s);
  const Alternative worst = shortest(&Alternative::worst_positioning_time_s);
  report.shortest = exact.name;
  report.shortest_worst = worst.name;
  report.verdict = fmt::format(
      "For exact modes {} is shortest with {:.3f} ms; others:{}. With modes off by up to {} % {} is shortest with "
      "{:.3f} ms; "
      "others:{}. Gain of best_asymmetric over (with such errors):{}.",
      exact.name, exact.positioning_time_s * 1e3, gain(report, exact, &Alternative::positioning_time_s),
      problem.mode_error_percent, worst.name, worst.worst_positioning_time_s * 1e3,
      gain(report, worst, &Alternative::worst_positioning_time_s), gains_of_asymmetric(report));
  const auto worst_of = [&report](std::string_view name) {
    const auto row = std::find_if(report.alternatives.begin(), report.alternatives.end(),
                                  [name](const Alternative& other) { return other.name == name; });
    return row->worst_positioning_time_s;
  };
  for (const char* other : {"fastest", "best_symmetric"}) {
    if (worst_of("best_asymmetric") > worst_of(other)) {
      report.verdict +=
          fmt::format(" With such errors best_asymmetric is slower than {}: it is tuned to exact modes.", other);
    }
  }
  if (exact.name == "zv" || exact.name == "zvd" || worst.name == "zv" || worst.name == "zvd") {
    report.verdict +=
        " An input shaper wins: run it as a second stage after the fastest profile, with the same shaper on all axes "
        "of a "
        "contour.";
  }
}

/// What there is to say where there is nothing to move.
SearchReport standing(const SearchProblem& problem, const SearchOptions& options) {
  SearchReport report;
  report.best = {problem.v_max_mm_s, problem.a_up_max_mm_s2, problem.a_down_max_mm_s2, 0, 0, 0};
  for (const char* name : {"fastest", "best_symmetric", "best_asymmetric", "robust", "zv", "zvd"}) {
    if (options.robust || std::string_view(name) != "robust") {
      report.alternatives.push_back({name, report.best, 0, 0, 0, 0, 0});
    }
  }
  report.verdict = "The stroke is 0: nothing moves, and every profile has settled at once.";
  report.shortest = report.shortest_worst = "fastest";
  return report;
}

}  // namespace

double worst_positioning_time_s(const SearchProblem& problem, std::span<const InputJump> input) {
  return input.empty() ? 0 : input.back().time_s + worst_case(problem, input).after_s;
}

Result<SearchReport> search(const SearchProblem& given, const SearchOptions& options) {
  GRAVURE_CHECK(check_problem(given));
  if (given.stroke_mm == 0) {
    return standing(given, options);
  }
  SearchProblem problem = given;  // limits go with the sense of the move, so its sign does not matter
  problem.stroke_mm = std::abs(given.stroke_mm);
  GRAVURE_TRY(const FoundProfiles found, find_profiles(problem, options));
  SearchReport report;
  report.evaluated = found.evaluated;
  report.grids = found.grids;
  const auto add = [&](const char* name, const Candidate& candidate) -> Result<void> {
    GRAVURE_TRY(Alternative row, measure_candidate(problem, name, candidate));
    report.alternatives.push_back(std::move(row));
    return {};
  };
  GRAVURE_CHECK(add("fastest", fastest_of(problem)));
  GRAVURE_CHECK(add("best_symmetric", found.symmetric));
  GRAVURE_CHECK(add("best_asymmetric", found.asymmetric));
  report.best = *report.alternatives.back().profile;
  if (found.robust) {
    GRAVURE_CHECK(add("robust", *found.robust));
  }
  GRAVURE_CHECK(add_shaped(problem, ShaperKind::zv, report));
  GRAVURE_CHECK(add_shaped(problem, ShaperKind::zvd, report));
  judge(problem, report);
  return report;
}

}  // namespace gravure::motion
