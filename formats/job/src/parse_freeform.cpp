#include <string>
#include <variant>

#include "gravure/formats/freeform_job.hpp"
#include "gravure/formats/job_file.hpp"
#include "src/freeform_keys.hpp"
#include "src/keyed_reader.hpp"

namespace gravure {
namespace freeform_file {
namespace {

std::string needs(std::string_view section, const std::string& keys) {
  return section == "surface"   ? "one of expression, height_field and mesh"
         : section == "texture" ? keys + ", one of hilbert_order, path, svg and bitmap"
                                : keys;
}

FreeformJob read_freeform(const Document& document, Violations& violations) {
  const JobGrammar grammar{specs_of(key_table()), section_names(), section_is_required, needs};
  KeyedReader reader(document, grammar);
  FreeformJob job;
  read_into(job, reader);
  check_rules(document, reader.violations());
  violations = reader.violations();
  return job;
}

std::string folder_of(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  return slash == std::string::npos ? "" : path.substr(0, slash + 1);
}

}  // namespace
}  // namespace freeform_file

Result<FreeformJob> parse_freeform_job(std::string_view text, const std::string& path) {
  using namespace freeform_file;
  GRAVURE_TRY(const Document document,
              read_document(text, path, "a job file", kMaxJobBytes, freeform_file::parent_names()));
  Violations violations;
  FreeformJob job = read_freeform(document, violations);
  if (!violations.empty()) {
    return violations.to_error(path);
  }
  job.job.path = path;
  job.job.text = std::string(text);
  job.texture.folder = folder_of(path);
  return job;
}

std::optional<Mode> mode_of_job_text(std::string_view text) {
  using namespace freeform_file;
  if (text.size() > kMaxJobBytes) {
    return std::nullopt;
  }
  const auto parsed = parse_toml(text);
  const auto* document = std::get_if<Document>(&parsed);
  const Section* section = document != nullptr ? document->find("job") : nullptr;
  const Entry* entry = section != nullptr ? section->find("mode") : nullptr;
  if (entry == nullptr || entry->value.kind != Kind::text) {
    return std::nullopt;
  }
  for (const Mode mode : {Mode::rotary, Mode::helical, Mode::flat, Mode::freeform, Mode::zones}) {
    if (mode_name(mode) == entry->value.text) {
      return mode;
    }
  }
  return std::nullopt;
}

}  // namespace gravure
