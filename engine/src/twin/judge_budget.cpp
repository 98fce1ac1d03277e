#include "judge_budget.hpp"

#include <algorithm>
#include <cmath>

#include "figure.hpp"

namespace gravure {
namespace {

std::string text_of(const PulsePlace& place) {
  return "revolution " + std::to_string(place.revolution) + ", line " + std::to_string(place.line) + ", slot " +
         std::to_string(place.slot);
}

/// The term that alone does most to the landing of pulses.
ErrorTerm largest_term(const ErrorBudget& budget) {
  ErrorTerm largest = ErrorTerm::drift;
  double most = -1;
  for (const ErrorTerm term : kAllErrorTerms) {
    const double um = budget.budget_um[static_cast<std::size_t>(term)].value_or(0);
    if (term != ErrorTerm::defocus && um > most) {
      most = um;
      largest = term;
    }
  }
  return largest;
}

void judge_landing(const ErrorBudget& budget, const Rational& limit_um, bool has_scanner, VerifyReport& report) {
  if (budget.max_um > to_double(limit_um)) {
    report.violations.push_back(
        "a pulse may land " + figure(budget.max_um) +
        " um from its target, which exceeds limits.landing_um = " + to_decimal_string(limit_um) +
        ": the largest term is " + std::string(term_name(largest_term(budget))) + "; the worst simulated pulse, at " +
        text_of(budget.worst) + ", is off by " + figure(budget.simulated_max_um) + " um");
  }
  if (!has_scanner) {
    report.violations.emplace_back(
        "limits.landing_um cannot be judged without the scanner: give scanner.field_mm, or take the limit out");
  }
}

void judge_defocus(const ErrorBudget& budget, const Rational& limit_um, VerifyReport& report) {
  if (!budget.defocus_max_um) {
    report.violations.emplace_back(
        "limits.defocus_um cannot be judged: give scanner.field_mm and leave twin.defocus enabled, or take the limit "
        "out");
  } else if (*budget.defocus_max_um > to_double(limit_um)) {
    report.violations.push_back(
        "the surface is up to " + figure(*budget.defocus_max_um) +
        " um from focus, which exceeds limits.defocus_um = " + to_decimal_string(limit_um) +
        ": more lines or a shorter window flatten the arc of a line; run-out and growth lift the surface");
  }
}

}  // namespace

void judge_bound(const ErrorBudget& budget, VerifyReport& report) {
  constexpr double kArithmetic = 1e-9;
  if (budget.simulated_max_um > budget.max_um * (1 + kArithmetic) + kArithmetic) {
    report.violations.push_back("the pulse at " + text_of(budget.worst) + " lands " + figure(budget.simulated_max_um) +
                                " um from its target, beyond the bound of " + figure(budget.max_um) +
                                " um for all pulses: the error budget contradicts itself, trust neither figure");
  }
}

std::optional<scan::JobTrajectory> judge_scanner(const ProgramHeader& header, VerifyReport& report) {
  if (!header.plan.scanner) {
    return std::nullopt;
  }
  Result<scan::JobTrajectory> made = scan::JobTrajectory::make(header.plan);
  if (!made) {
    report.violations.push_back("the scanner has no path for these lines: " + made.error().message);
    return std::nullopt;
  }
  if (header.set_points.empty()) {
    report.notes.emplace_back("the program stores no set-points: those of its plan are judged");
  } else if (const Result<void> checked = made.value().check_stored(header.set_points); !checked) {
    report.violations.push_back("the scanner's orders are not those of the plan: " + checked.error().message);
  }
  return std::move(made).value();
}

Result<void> judge_budget(const std::function<Result<std::unique_ptr<LineSource>>()>& programs,
                          const std::optional<scan::JobTrajectory>& trajectory, const VerifyOptions& options,
                          VerifyReport& report) {
  const BudgetOptions& asked = *options.budget;
  ErrorBudgetRequest request;
  request.twin = asked.twin;
  request.threads = options.threads;
  request.cancel = options.cancel;
  if (trajectory) {
    request.trajectory = &trajectory->of_revolution(0);
    if (trajectory->plan().mode == Mode::flat && trajectory->plan().job.revolutions > 1) {
      request.back = &trajectory->of_revolution(1);
    }
  }
  Result<ErrorBudget> budget = error_budget(programs, request);
  if (!budget && budget.error().code == ErrorCode::out_of_range) {
    report.violations.push_back("no error budget: " + budget.error().message);
    return {};
  }
  GRAVURE_TRY(report.error, std::move(budget));
  judge_bound(*report.error, report);
  report.notes.insert(report.notes.end(), report.error->notes.begin(), report.error->notes.end());
  if (asked.landing_um) {
    judge_landing(*report.error, *asked.landing_um, trajectory.has_value(), report);
  }
  if (asked.defocus_um) {
    judge_defocus(*report.error, *asked.defocus_um, report);
  }
  return {};
}

}  // namespace gravure
