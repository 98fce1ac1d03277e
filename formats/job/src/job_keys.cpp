#include "gravure/formats/job_keys.hpp"

#include "src/key_table.hpp"

namespace gravure {
namespace {

using job_file::Type;

std::string type_name(Type type) {
  switch (type) {
    case Type::boolean:
      return "boolean";
    case Type::integer:
      return "integer";
    case Type::decimal:
      return "decimal";
    case Type::title:
    case Type::path:
    case Type::word:
      return "string";
    case Type::paths:
      return "list of strings";
    case Type::two_integers:
      return "two integers";
  }
  return "";
}

}  // namespace

std::vector<JobKey> job_keys() {
  std::vector<JobKey> keys;
  for (const job_file::KeySpec& spec : job_file::key_table()) {
    keys.push_back({std::string(spec.section), std::string(spec.key), type_name(spec.type), std::string(spec.unit),
                    job_file::range_text(spec), std::string(spec.fallback)});
  }
  return keys;
}

}  // namespace gravure
