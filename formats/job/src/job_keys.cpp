#include "gravure/formats/job_keys.hpp"

#include "src/key_rows.hpp"
#include "src/key_table.hpp"

namespace gravure {

std::vector<JobKey> job_keys() {
  return job_file::documented(job_file::key_table());
}

}  // namespace gravure
