#include "gravure/twin/error_budget.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <new>
#include <set>
#include <system_error>
#include <thread>

#include "error_model.hpp"
#include "figure.hpp"
#include "gravure/twin/exposure.hpp"

namespace gravure {
namespace {

constexpr std::int64_t kMostRevolutions = 12;
/// Positions in the field are doubles of mm: what the geometry leaves below this is their arithmetic.
constexpr double kResidueUm = 1e-9;

bool is_of_scanner(ErrorTerm term) noexcept {
  return term == ErrorTerm::galvo_resolution || term == ErrorTerm::microvectors || term == ErrorTerm::cross_scan ||
         term == ErrorTerm::lag || term == ErrorTerm::defocus;
}

bool& switch_of(TwinSettings& twin, ErrorTerm term) noexcept {
  switch (term) {
    case ErrorTerm::drift:
      return twin.drift;
    case ErrorTerm::ab_step:
      return twin.ab_step;
    case ErrorTerm::galvo_resolution:
      return twin.galvo_resolution;
    case ErrorTerm::microvectors:
      return twin.microvectors;
    case ErrorTerm::cross_scan:
      return twin.cross_scan;
    case ErrorTerm::lag:
      return twin.lag;
    case ErrorTerm::defocus:
      return twin.defocus;
    case ErrorTerm::servo:
      return twin.servo.enabled;
    case ErrorTerm::run_out:
      return twin.run_out.enabled;
    case ErrorTerm::thermal:
      break;
  }
  return twin.thermal.enabled;
}

TwinSettings alone(TwinSettings twin, ErrorTerm wanted) {
  for (const ErrorTerm term : kAllErrorTerms) {
    switch_of(twin, term) = term == wanted;
  }
  return twin;
}

/// The bound of each term by itself.
Result<void> fill_budget(const Plan& plan, const ErrorBudgetRequest& request, ErrorBudget& budget) {
  TwinSettings twin = request.twin;
  for (const ErrorTerm term : kAllErrorTerms) {
    std::optional<double>& value = budget.budget_um[static_cast<std::size_t>(term)];
    budget.enabled[static_cast<std::size_t>(term)] = switch_of(twin, term);
    if (!switch_of(twin, term)) {
      value = 0;
      continue;
    }
    if (is_of_scanner(term) && request.trajectory == nullptr) {
      continue;
    }
    GRAVURE_TRY(const ErrorModel model, ErrorModel::make(plan, request.trajectory, alone(twin, term), request.back));
    const ErrorModel::Bound bound = model.job_bound().bound;
    value = term == ErrorTerm::defocus ? bound.defocus_um : bound.landing_um;
    if (is_of_scanner(term) && *value < kResidueUm) {
      value = 0;
    }
  }
  return {};
}

void say_notes(const Plan& plan, const ErrorBudgetRequest& request, ErrorBudget& budget) {
  if (request.trajectory == nullptr) {
    budget.notes.emplace_back(
        plan.scanner ? "error budget: the scanner has no path for these lines, so galvo_resolution, microvectors, "
                       "cross_scan, lag and defocus are not in it"
                     : "error budget: the scanner is not described, so galvo_resolution, microvectors, cross_scan, lag "
                       "and defocus are not in it: give scanner.field_mm");
  }
  if (std::none_of(budget.enabled.begin(), budget.enabled.end(), [](bool enabled) { return enabled; })) {
    budget.notes.emplace_back("error budget: every term is switched off in [twin], so nothing is judged");
  }
  if (request.trajectory != nullptr && request.trajectory->field_grid_error_um > 0) {
    budget.notes.push_back("error budget: the field grid between its nodes is not in it, estimated at most " +
                           figure(request.trajectory->field_grid_error_um) + " um; more nodes make that less");
  }
  if (request.twin.run_out.enabled && plan.mode == Mode::flat) {
    budget.notes.emplace_back("error budget: nothing turns in a flat job, twin.run_out adds nothing");
  }
}

/// A part of the simulation.
struct Piece {
  std::int64_t revolution = 0;
  std::int64_t chunk = 0;
};

class Simulation {
 public:
  Simulation(const ProgramHeader& header, std::int64_t lines_per_chunk, const ErrorModel& model,
             const ErrorBudgetRequest& request)
      : header_(header),
        plan_(header.plan),
        lines_per_chunk_(lines_per_chunk),
        chunks_((plan_.rotary.lines_per_revolution + lines_per_chunk - 1) / lines_per_chunk),
        model_(model),
        request_(request) {}

  /// The first and the last revolution, the worst by bound, and others evenly between; where even three have too many
  /// pulses, evenly spaced chunks of them, the worst line's included.
  void choose(const ErrorModel::JobBound& worst) {
    const std::int64_t revolutions = plan_.job.revolutions;
    const std::int64_t each = std::max<std::int64_t>(1, plan_.rotary.lines_per_revolution * plan_.line.pixels);
    const std::int64_t wanted =
        std::min(revolutions, std::clamp(request_.most_pulses / each, std::int64_t{3}, kMostRevolutions));
    chosen_ = {0, worst.revolution, revolutions - 1};
    for (std::int64_t i = 1; i + 1 < wanted; ++i) {
      if (static_cast<std::int64_t>(chosen_.size()) < wanted) {
        chosen_.insert(revolutions / (wanted - 1) * i);
      }
    }
    const std::int64_t pulses = static_cast<std::int64_t>(chosen_.size()) * each;
    const std::int64_t stride = std::clamp(pulses / std::max<std::int64_t>(1, request_.most_pulses), std::int64_t{1},
                                           std::max<std::int64_t>(1, chunks_ / 4));
    for (const std::int64_t revolution : chosen_) {
      for (std::int64_t chunk = 0; chunk < chunks_; ++chunk) {
        if (chunk % stride == 0 || chunk + 1 == chunks_ || chunk == worst.line / lines_per_chunk_) {
          pieces_.push_back({revolution, chunk});
        }
      }
    }
    sums_.resize(pieces_.size());
  }

  Result<PulseSums> run(const std::function<Result<std::unique_ptr<LineSource>>()>& programs) {
    const int wanted = request_.threads > 0 ? request_.threads : static_cast<int>(std::thread::hardware_concurrency());
    std::vector<std::thread> workers;
    try {
      for (int i = 1; i < std::min<int>(wanted, static_cast<int>(pieces_.size())); ++i) {
        workers.emplace_back([&] { work(programs); });
      }
    } catch (const std::system_error&) {  // no more threads to be had: those there are do it
    }
    work(programs);
    for (std::thread& worker : workers) {
      worker.join();
    }
    if (error_) {
      return *error_;
    }
    PulseSums all;
    for (const PulseSums& part : sums_) {  // in order, whoever did which
      all.merge(part);
    }
    return all;
  }

  const std::set<std::int64_t>& chosen() const noexcept { return chosen_; }

 private:
  void work(const std::function<Result<std::unique_ptr<LineSource>>()>& programs) {
    try {
      if (const Result<void> worked = work_on_pieces(programs); !worked) {
        fail(worked.error());
      }
    } catch (const std::bad_alloc&) {
      fail({ErrorCode::io, "out of memory: lower --threads"});
    }
  }

  Result<void> work_on_pieces(const std::function<Result<std::unique_ptr<LineSource>>()>& programs) {
    GRAVURE_TRY(const std::unique_ptr<LineSource> program, programs());
    ProgramChunk chunk;
    for (std::size_t i = next_.fetch_add(1); i < pieces_.size() && !stop_; i = next_.fetch_add(1)) {
      if (request_.cancel != nullptr && request_.cancel->cancelled()) {
        return Error{ErrorCode::cancelled, "stopped before the landing of the pulses was computed"};
      }
      const Piece& piece = pieces_[i];
      const std::int64_t layer = header_.layer_of_revolution[static_cast<std::size_t>(piece.revolution)];
      GRAVURE_CHECK(chunk.load(*program, {layer, piece.chunk}));
      const std::span<const std::byte> lines = chunk.lines_for(header_, piece.revolution);
      const auto bytes = static_cast<std::size_t>(header_.line_bytes());
      for (std::int64_t line = 0; line < chunk.lines(); ++line) {
        model_.simulate(piece.revolution, chunk.first_line() + line,
                        lines.subspan(static_cast<std::size_t>(line) * bytes, bytes), sums_[i]);
      }
    }
    return {};
  }

  void fail(const Error& error) {
    const std::lock_guard lock(mutex_);
    if (!error_) {
      error_ = error;
    }
    stop_ = true;
  }

  const ProgramHeader& header_;
  const Plan& plan_;
  const std::int64_t lines_per_chunk_;
  const std::int64_t chunks_;
  const ErrorModel& model_;
  const ErrorBudgetRequest& request_;
  std::set<std::int64_t> chosen_;
  std::vector<Piece> pieces_;
  std::vector<PulseSums> sums_;
  std::atomic<std::size_t> next_{0};
  std::atomic<bool> stop_{false};
  std::mutex mutex_;
  std::optional<Error> error_;
};

}  // namespace

std::string_view term_name(ErrorTerm term) noexcept {
  constexpr std::array<std::string_view, kErrorTerms> kNames = {
      "drift",   "ab_step", "galvo_resolution", "microvectors", "cross_scan", "lag",
      "defocus", "servo",   "run_out",          "thermal"};
  return kNames[static_cast<std::size_t>(term)];
}

Result<ErrorBudget> error_budget(const std::function<Result<std::unique_ptr<LineSource>>()>& programs,
                                 const ErrorBudgetRequest& request) {
  GRAVURE_TRY(const std::unique_ptr<LineSource> program, programs());
  const ProgramHeader& header = program->header();
  const Plan& plan = header.plan;
  GRAVURE_TRY(const ErrorModel model, ErrorModel::make(plan, request.trajectory, request.twin, request.back));
  const ErrorModel::JobBound worst = model.job_bound();
  ErrorBudget budget;
  budget.max_um = worst.bound.landing_um;
  if (request.trajectory != nullptr && request.twin.defocus) {
    budget.defocus_max_um = worst.bound.defocus_um;
  }
  GRAVURE_CHECK(fill_budget(plan, request, budget));
  say_notes(plan, request, budget);
  Simulation simulation(header, program->lines_per_chunk(), model, request);
  simulation.choose(worst);
  GRAVURE_TRY(const PulseSums sums, simulation.run(programs));
  budget.simulated_revolutions.assign(simulation.chosen().begin(), simulation.chosen().end());
  budget.simulated_pulses = sums.pulses;
  if (sums.pulses > 0) {
    budget.rms_um = std::sqrt(sums.squares_um2 / static_cast<double>(sums.pulses));
    budget.simulated_max_um = std::sqrt(sums.worst_um2);
    budget.worst = sums.worst;
  }
  return budget;
}

}  // namespace gravure
