#include "find_profiles.hpp"

#include <limits>
#include <vector>

#include "search_global.hpp"
#include "worst_case.hpp"

namespace gravure::motion {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

/// The best so far, by what it was judged by.
struct Best {
  Candidate candidate;
  MovePoint point{};
  double time_s = kNever;
  bool any = false;
};

class ProfileSearch {
 public:
  ProfileSearch(const SearchProblem& problem, const SearchOptions& options)
      : problem_(problem), options_(options), space_(problem) {}

  Result<FoundProfiles> run() {
    for (std::uint64_t round = 0; round <= options_.effort; ++round) {
      // The first round does not know the seed; the others take streams of their own.
      GRAVURE_CHECK(search_round(round == 0 ? 0 : (options_.seed << 10) + round));
    }
    if (options_.grid) {
      GRAVURE_CHECK(search_grids());
    }
    found_.symmetric = symmetric_.candidate;
    found_.asymmetric = asymmetric_.candidate;
    if (options_.robust) {
      found_.robust = robust_.candidate;
    }
    found_.evaluated += space_.evaluated();
    return std::move(found_);
  }

 private:
  Result<void> search_round(std::uint64_t stream) {
    for (const MovePoint& end : search_global(space_, problem_, stream, SearchFor::symmetric, points({&symmetric_}))) {
      GRAVURE_CHECK(offer_symmetric(space_.candidate_at(end)));
    }
    const auto seeds = points({&asymmetric_, &symmetric_});
    for (const MovePoint& end : search_global(space_, problem_, stream, SearchFor::asymmetric, seeds)) {
      GRAVURE_CHECK(offer_asymmetric(space_.candidate_at(end)));
    }
    if (!options_.robust) {
      return {};
    }
    GRAVURE_CHECK(offer_robust());
    return harden(
        search_global(space_, problem_, stream, SearchFor::robust, points({&robust_, &asymmetric_, &symmetric_})));
  }

  /// The tuned profiles, which may be the best for the worst case as well.
  Result<void> offer_robust() {
    for (const Candidate& candidate : {symmetric_.candidate, asymmetric_.candidate}) {
      GRAVURE_TRY(const Profile profile, plan_profile(request_of(problem_, candidate)));
      take(robust_, candidate, worst_positioning_time_s(problem_, input_of(profile)));
    }
    return {};
  }

  Result<void> search_grids() {
    GRAVURE_TRY(const GridSearch symmetric, search_grid(problem_, *options_.grid, false));
    GRAVURE_TRY(const GridSearch asymmetric, search_grid(problem_, *options_.grid, true));
    found_.grids = SearchedGrids{symmetric, asymmetric};
    found_.evaluated += symmetric.evaluated + asymmetric.evaluated;
    const MovePoint of_symmetric = MoveSpace::point_of(space_.durations_of(symmetric.best));
    const MovePoint of_asymmetric = MoveSpace::point_of(space_.durations_of(asymmetric.best));
    GRAVURE_CHECK(offer_symmetric(symmetric.best));
    GRAVURE_CHECK(offer_asymmetric(asymmetric.best));
    for (const MovePoint& end : polish(space_, SearchFor::symmetric, {of_symmetric})) {
      GRAVURE_CHECK(offer_symmetric(space_.candidate_at(end)));
    }
    for (const MovePoint& end : polish(space_, SearchFor::asymmetric, {of_asymmetric, symmetric_.point})) {
      GRAVURE_CHECK(offer_asymmetric(space_.candidate_at(end)));
    }
    if (!options_.robust) {
      return {};
    }
    GRAVURE_CHECK(offer_robust());
    return harden(polish(space_, SearchFor::robust, {of_asymmetric, asymmetric_.point}));
  }

  /// The descents know the corners of the errors only. Where the true worst case of an end is another one, that one
  /// counts from now on and the end is refined anew.
  Result<void> harden(std::vector<MovePoint> ends) {
    constexpr int kMostCuts = 4;
    for (int cut = 0; cut <= kMostCuts && !ends.empty(); ++cut) {
      std::vector<MovePoint> again;
      for (const MovePoint& end : ends) {
        const Candidate candidate = space_.candidate_at(end);
        GRAVURE_TRY(const Profile profile, plan_profile(request_of(problem_, candidate)));
        const std::vector<InputJump> input = input_of(profile);
        const WorstCase worst = worst_case(problem_, input);
        const double time_s = input.back().time_s + worst.after_s;
        take(robust_, candidate, time_s);
        if (time_s > space_.worst_cost(end, kNever) * (1 + 1e-3)) {
          space_.also_under(worst.modes);
          again.assign({robust_.point, ends.front()});
        }
      }
      again = polish(space_, SearchFor::robust, again);
      ends = std::move(again);
    }
    return {};
  }

  Result<double> positioning_time_s(const Candidate& candidate) const {
    GRAVURE_TRY(const Profile profile, plan_profile(request_of(problem_, candidate)));
    GRAVURE_TRY(const Settling settling, settle(problem_.modes, input_of(profile), problem_.band));
    return settling.positioning_time_s;
  }

  /// The first is taken whatever it costs: nothing may settle at all.
  void take(Best& best, const Candidate& candidate, double time_s) const {
    if (!best.any || time_s < best.time_s) {
      best = {candidate, MoveSpace::point_of(space_.durations_of(candidate)), time_s, true};
    }
  }
  Result<void> offer_symmetric(const Candidate& candidate) {
    GRAVURE_TRY(const double time_s, positioning_time_s(candidate));
    take(symmetric_, candidate, time_s);
    return offer_asymmetric(candidate);
  }
  Result<void> offer_asymmetric(const Candidate& candidate) {
    GRAVURE_TRY(const double time_s, positioning_time_s(candidate));
    take(asymmetric_, candidate, time_s);
    return {};
  }

  static std::vector<MovePoint> points(std::initializer_list<const Best*> bests) {
    std::vector<MovePoint> points;
    for (const Best* best : bests) {
      if (best->any) {
        points.push_back(best->point);
      }
    }
    return points;
  }

  const SearchProblem& problem_;
  const SearchOptions& options_;
  MoveSpace space_;
  Best symmetric_;
  Best asymmetric_;
  Best robust_;
  FoundProfiles found_;
};

}  // namespace

SFactorRequest request_of(const SearchProblem& problem, const Candidate& c) {
  return {{problem.stroke_mm, c.v_mm_s, c.a_up_mm_s2, c.a_down_mm_s2, 0, 0}, c.s_factor, problem.update_us};
}

Result<FoundProfiles> find_profiles(const SearchProblem& problem, const SearchOptions& options) {
  return ProfileSearch(problem, options).run();
}

}  // namespace gravure::motion
