#include "gravure/formats/plan_json.hpp"

#include <nlohmann/json.hpp>

#include "check_plan.hpp"
#include "plan_fields.hpp"
#include "plan_reader.hpp"
#include "plan_writer.hpp"

namespace gravure {

std::string plan_to_json(const Plan& plan) {
  constexpr int kIndent = 2;
  plan_json::PlanWriter writer;
  plan_json::describe_plan(writer, plan);
  return writer.result().dump(kIndent, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

Result<Plan> plan_from_json(std::string_view text) {
  if (text.size() > kLargestPlanJson) {
    return Error{ErrorCode::bad_file, "plan: " + std::to_string(text.size()) + " bytes of JSON; at most " +
                                          std::to_string(kLargestPlanJson) + " are a plan"};
  }
  const nlohmann::json root = nlohmann::json::parse(text, nullptr, false);
  if (root.is_discarded() || !root.is_object()) {
    return Error{ErrorCode::bad_file, "plan: is not a JSON object; the text is damaged or something else"};
  }
  Plan plan;
  plan_json::PlanReader reader(root);
  plan_json::describe_plan(reader, plan);
  if (reader.error()) {
    return *reader.error();
  }
  GRAVURE_CHECK(plan_json::check_plan(plan));
  return plan;
}

}  // namespace gravure
