#include <algorithm>
#include <string>
#include <utility>
#include <variant>

#include "gravure/formats/toml/edit_distance.hpp"
#include "gravure/formats/toml/violations.hpp"
#include "gravure/formats/zones_job.hpp"
#include "src/key_table.hpp"

namespace gravure {
namespace zones_job_file {
namespace {

std::string shown(std::string_view section, std::string_view key) {
  return "[" + one_line(section) + "] " + one_line(key);
}

bool is_readable_number(const Value& value) {
  return (value.kind == Kind::integer || value.kind == Kind::decimal) && value.is_readable;
}

bool is_plain_text(const Value& value) {
  return value.kind == Kind::text && !value.text.empty() && value.text.size() <= kMaxTextBytes &&
         std::none_of(value.text.begin(), value.text.end(),
                      [](char c) { return static_cast<unsigned char>(c) < 0x20U || c == 0x7F; });
}

bool has_type(const KeySpec& spec, const Value& value) {
  switch (spec.type) {
    case Type::integer:
      return value.kind == Kind::integer;
    case Type::decimal:
      return is_readable_number(value);
    case Type::boolean:
      return value.kind == Kind::boolean;
    case Type::text:
      return is_plain_text(value);
    case Type::word:
      break;
  }
  return value.kind == Kind::text && std::find(spec.words.begin(), spec.words.end(), value.text) != spec.words.end();
}

class Reader {
 public:
  explicit Reader(const Document& document) : document_(document) {}

  ZonesJob read() {
    for (const Section& section : document_.sections) {
      check_section(section);
    }
    for (const KeySpec& spec : key_table()) {
      check_presence(spec);
    }
    ZonesJob job;
    read_what(job);
    read_how(job);
    check_rules(job);
    return job;
  }

  const Violations& violations() const { return violations_; }

 private:
  // --- what stands where ---

  void check_section(const Section& section) {
    if (!section.is_table || !is_section(section.name)) {
      std::vector<Candidate> candidates;
      for (const KeySpec& spec : key_table()) {
        if (candidates.empty() || candidates.back().word != spec.section) {
          candidates.push_back({spec.section, "[" + std::string(spec.section) + "]"});
        }
      }
      violations_.add(section.at, (section.is_table ? "[" + one_line(section.name) + "]: no section of a zones job"
                                                    : one_line(section.name) + ": stands outside every section") +
                                      suggest(section.name, candidates).text);
      return;
    }
    for (const Entry& entry : section.entries) {
      const KeySpec* spec = find_key(section.name, entry.key);
      if (violations_.is_full()) {
        return;
      }
      spec == nullptr ? report_unknown(section, entry) : check_value(*spec, entry.value);
    }
  }

  void report_unknown(const Section& section, const Entry& entry) {
    std::vector<Candidate> candidates;
    for (const KeySpec& spec : key_table()) {
      if (spec.section == section.name) {
        candidates.push_back({spec.key, std::string(spec.key)});
      }
    }
    violations_.add(entry.at, shown(section.name, entry.key) + ": unknown key" + suggest(entry.key, candidates).text);
  }

  void check_value(const KeySpec& spec, const Value& value) {
    const std::string text = shown(spec.section, spec.key) + " = " + value.shown + ": must be " + expectation(spec);
    if (!has_type(spec, value)) {
      violations_.add(value.at, text);
    } else if (!spec.low.empty() &&
               (value.number < parse_decimal(spec.low).value() || value.number > parse_decimal(spec.high).value())) {
      violations_.add_range(value.at, text);
    }
  }

  void check_presence(const KeySpec& spec) {
    const Section* section = document_.find(spec.section);
    const bool wanted = spec.is_required() || (section != nullptr && spec.fallback == "required in [beam]");
    if (wanted && (section == nullptr || (section->is_table && section->find(spec.key) == nullptr))) {
      violations_.add(section != nullptr ? section->at : document_.end,
                      shown(spec.section, spec.key) + " is missing: give " + expectation(spec));
    }
  }

  // --- values: of a key that is right, or what it stands for while something is wrong ---

  const Value* value_of(std::string_view section, std::string_view key) const {
    const Section* found = document_.find(section);
    const Entry* entry = found != nullptr && found->is_table ? found->find(key) : nullptr;
    return entry != nullptr && has_type(*find_key(section, key), entry->value) ? &entry->value : nullptr;
  }
  std::string text_of(std::string_view section, std::string_view key) const {
    const Value* value = value_of(section, key);
    return value != nullptr ? value->text : "";
  }
  std::optional<Rational> number_of(std::string_view section, std::string_view key) const {
    const Value* value = value_of(section, key);
    return value != nullptr ? std::optional(value->number) : std::nullopt;
  }
  std::int64_t integer_of(std::string_view section, std::string_view key, std::int64_t fallback) const {
    const Value* value = value_of(section, key);
    return value != nullptr ? value->integer : fallback;
  }

  void read_what(ZonesJob& job) const {
    job.title = text_of("job", "title");
    job.contours = text_of("contours", "file");
    job.transform = text_of("contours", "transform");
    job.by_kmeans = text_of("zones", "method") == "kmeans";
    job.clusters = static_cast<std::size_t>(integer_of("zones", "k", 0));
    if (const Value* normalised = value_of("zones", "normalised")) {
      job.normalised = normalised->boolean;
    }
    job.seed = static_cast<std::uint64_t>(integer_of("zones", "seed", 1));
    job.max_incidence_deg = number_of("zones", "max_incidence_deg").value_or(0);
    job.layer_mm = number_of("zones", "layer_mm");
    if (document_.find("beam") != nullptr) {
      job.beam = {number_of("beam", "wavelength_um").value_or(0),
                  number_of("beam", "m_squared").value_or(1),
                  number_of("beam", "diameter_mm").value_or(0),
                  number_of("beam", "focal_length_mm").value_or(0),
                  number_of("beam", "fluence_share"),
                  number_of("beam", "average_power_w"),
                  number_of("beam", "threshold_j_cm2")};
    }
  }

  void read_how(ZonesJob& job) const {
    job.laser.seed_hz = integer_of("laser", "seed_hz", 0);
    job.laser.pulse_divider = integer_of("laser", "pulse_divider", 0);
    job.clock_multiplier = integer_of("fpga", "clock_multiplier", 2);
    job.pulse_pitch_um = number_of("marking", "pulse_pitch_um").value_or(0);
    job.mark_speed_mm_s = number_of("marking", "mark_speed_mm_s").value_or(0);
    job.jump_speed_mm_s = number_of("marking", "jump_speed_mm_s");
    job.servo_us = number_of("marking", "servo_us").value_or(50);
    job.machine = text_of("machine", "file");
    job.field_mm = number_of("machine", "field_mm");
    job.max_landing_um = number_of("limits", "landing_um");
  }

  // --- how keys go together ---

  Location at_key(std::string_view section, std::string_view key) const {
    const Section* found = document_.find(section);
    const Entry* entry = found != nullptr ? found->find(key) : nullptr;
    return entry != nullptr ? entry->at : found != nullptr ? found->at : document_.end;
  }

  void check_rules(const ZonesJob& job) {
    const Section* zones = document_.find("zones");
    if (zones == nullptr || !zones->is_table) {
      return;  // said already
    }
    for (const std::string_view key : {"k", "normalised", "seed"}) {
      if (!job.by_kmeans && zones->find(key) != nullptr) {
        violations_.add(at_key("zones", key), shown("zones", key) + ": belongs to method = \"kmeans\": take it out");
      }
    }
    const bool by_share = job.beam && job.beam->fluence_share;
    if (zones->find("layer_mm") == nullptr && !by_share) {
      violations_.add(zones->at,
                      "[zones] layer_mm is missing: give how thick a layer is at most, or [beam] with "
                      "fluence_share");
    } else if (job.layer_mm && by_share) {
      violations_.add(at_key("zones", "layer_mm"),
                      "[zones] layer_mm: [beam] fluence_share decides how thick layers are: take one of them out");
    }
    if (job.beam && job.beam->average_power_w.has_value() != job.beam->threshold_j_cm2.has_value()) {
      violations_.add(at_key("beam", job.beam->average_power_w ? "average_power_w" : "threshold_j_cm2"),
                      "[beam] average_power_w and threshold_j_cm2 belong together: give both, or none");
    }
  }

  const Document& document_;
  Violations violations_;
};

}  // namespace
}  // namespace zones_job_file

Result<ZonesJob> parse_zones_job(std::string_view text, const std::string& path) {
  using namespace zones_job_file;
  if (text.size() > kMaxZonesJobBytes) {
    return Error{ErrorCode::bad_file, path + ": " + std::to_string(text.size()) + " bytes: a job has at most " +
                                          std::to_string(kMaxZonesJobBytes)};
  }
  const auto parsed = parse_toml(text);
  if (const auto* syntax = std::get_if<SyntaxError>(&parsed)) {
    return Error{ErrorCode::bad_argument, place(path, syntax->at) + "not TOML: " + syntax->message};
  }
  Reader reader(std::get<Document>(parsed));
  ZonesJob job = reader.read();
  if (!reader.violations().empty()) {
    return reader.violations().to_error(path);
  }
  return job;
}

}  // namespace gravure
