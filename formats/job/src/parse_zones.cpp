#include <string>

#include "gravure/formats/job_file.hpp"
#include "gravure/formats/zones_job.hpp"
#include "src/keyed_reader.hpp"
#include "src/zones_keys.hpp"

namespace gravure {
namespace zones_file {
namespace {

Location at_key(const Section& section, std::string_view key) {
  const Entry* entry = section.find(key);
  return entry != nullptr ? entry->at : section.at;
}

bool has(const Section* section, std::string_view key) {
  return section != nullptr && section->is_table && section->find(key) != nullptr;
}

void check_zones(const Section& zones, bool by_kmeans, bool by_share, Violations& violations) {
  for (const std::string_view key : {"k", "normalised", "seed"}) {
    if (!by_kmeans && zones.find(key) != nullptr) {
      violations.add(at_key(zones, key),
                     "[zones] " + std::string(key) + ": belongs to method = \"kmeans\": take it out");
    }
  }
  if (!has(&zones, "layer_mm") && !by_share) {
    violations.add(zones.at,
                   "[zones] layer_mm is missing: give how thick a layer is at most, or [beam] with fluence_share");
  } else if (has(&zones, "layer_mm") && by_share) {
    violations.add(at_key(zones, "layer_mm"),
                   "[zones] layer_mm: [beam] fluence_share decides how thick layers are: take one of them out");
  }
}

/// How keys go together: they count as given where they stand in the file, even with a wrong value.
void check_rules(const Document& document, const ZonesJob& job, Violations& violations) {
  const Section* beam = document.find("beam");
  if (const Section* zones = document.find("zones"); zones != nullptr && zones->is_table) {
    check_zones(*zones, job.by_kmeans, has(beam, "fluence_share"), violations);
  }
  if (has(beam, "average_power_w") != has(beam, "threshold_j_cm2")) {
    violations.add(at_key(*beam, has(beam, "average_power_w") ? "average_power_w" : "threshold_j_cm2"),
                   "[beam] average_power_w and threshold_j_cm2 belong together: give both, or none");
  }
}

std::string required_keys(std::string_view /*section*/, const std::string& keys) {
  return keys;
}

ZonesJob read_zones(const Document& document, Violations& violations) {
  const JobGrammar grammar{specs_of(key_table()), section_names(), section_is_required, required_keys};
  KeyedReader reader(document, grammar);
  ZonesJob job;
  job.job.fpga.clock_multiplier = 2;
  read_into(job, reader);
  check_rules(document, job, reader.violations());
  violations = reader.violations();
  return job;
}

}  // namespace
}  // namespace zones_file

Result<ZonesJob> parse_zones_job(std::string_view text, const std::string& path) {
  using namespace zones_file;
  GRAVURE_TRY(const Document document, read_document(text, path, "a job file", kMaxJobBytes));
  Violations violations;
  ZonesJob job = read_zones(document, violations);
  if (!violations.empty()) {
    return violations.to_error(path);
  }
  job.job.path = path;
  job.job.text = std::string(text);
  return job;
}

}  // namespace gravure
