#include "program/error_budget_text.hpp"

#include <fmt/format.h>

namespace gravure::cli {
namespace {

/// "0, 4 and 7".
std::string list_of(const std::vector<std::int64_t>& numbers) {
  std::string text;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    text += (i == 0 ? "" : i + 1 == numbers.size() ? " and " : ", ") + std::to_string(numbers[i]);
  }
  return text;
}

Json number(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}

}  // namespace

std::string error_budget_text(const ErrorBudget& budget) {
  std::string text = fmt::format("\n{:>16}  {:>12}\n", "error budget", "at most um");
  for (const ErrorTerm term : kAllErrorTerms) {
    const std::optional<double>& um = budget.budget_um[static_cast<std::size_t>(term)];
    if (!budget.enabled[static_cast<std::size_t>(term)]) {
      text += fmt::format("{:>16}  {:>12}\n", term_name(term), "off");
      continue;
    }
    text += um ? fmt::format("{:>16}  {:>12.6g}\n", term_name(term), *um)
               : fmt::format("{:>16}  {:>12}\n", term_name(term), "unknown");
  }
  text += fmt::format("landing: no pulse is more than {:.6g} um from its target\n", budget.max_um);
  if (budget.simulated_pulses > 0) {
    text += fmt::format(
        "landing: {} fired pulses simulated (revolution{} {}): rms {:.6g} um, worst {:.6g} um at revolution {}, "
        "line {}, slot {}\n",
        budget.simulated_pulses, budget.simulated_revolutions.size() == 1 ? "" : "s",
        list_of(budget.simulated_revolutions), budget.rms_um, budget.simulated_max_um, budget.worst.revolution,
        budget.worst.line, budget.worst.slot);
  }
  if (budget.defocus_max_um) {
    text += fmt::format("focus: the surface is at most {:.6g} um from it\n", *budget.defocus_max_um);
  }
  return text;
}

Json error_budget_json(const ErrorBudget& budget) {
  Json terms = Json::object();
  Json off = Json::array();
  for (const ErrorTerm term : kAllErrorTerms) {
    if (!budget.enabled[static_cast<std::size_t>(term)]) {
      off.push_back(std::string(term_name(term)));
    }
    terms[std::string(term_name(term))] = number(budget.budget_um[static_cast<std::size_t>(term)]);
  }
  return {
      {"max", budget.max_um},
      {"rms", budget.rms_um},
      {"worst", {{"revolution", budget.worst.revolution}, {"line", budget.worst.line}, {"slot", budget.worst.slot}}},
      {"budget", terms},
      {"off", off},
      {"simulated_max", budget.simulated_max_um},
      {"defocus_max", number(budget.defocus_max_um)},
      {"simulated_pulses", budget.simulated_pulses},
      {"simulated_revolutions", budget.simulated_revolutions}};
}

}  // namespace gravure::cli
