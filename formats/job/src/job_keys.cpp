#include "gravure/formats/job_keys.hpp"

#include "src/key_table.hpp"

namespace gravure {

std::vector<JobKey> job_keys() {
  std::vector<JobKey> keys;
  for (const job_file::Key& spec : job_file::key_table()) {
    keys.push_back({std::string(spec.section), std::string(spec.key), type_name(spec.type), std::string(spec.unit),
                    job_file::range_text(spec), std::string(spec.fallback)});
  }
  return keys;
}

}  // namespace gravure
