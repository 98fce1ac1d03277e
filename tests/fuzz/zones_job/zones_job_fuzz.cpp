// Any bytes are a zones job or an Error; a job keeps every range that the table of keys names.

#include <cstdint>
#include <string>
#include <string_view>

#include "gravure/formats/zones_job.hpp"
#include "text_reader.hpp"

namespace {

using gravure::fuzz::check_error;
using gravure::fuzz::kPath;
using gravure::fuzz::require;

void check_job(const gravure::ZonesJob& job) {
  require(!job.contours.empty());
  require(job.max_incidence_deg > 0 && job.max_incidence_deg < 90);
  require(job.layer_mm.has_value() != (job.beam && job.beam->fluence_share));
  require(!job.layer_mm || *job.layer_mm > 0);
  require(job.job.laser.seed_hz > 0 && job.job.laser.pulse_divider > 0 && job.job.laser.pulse_divider <= 65'535);
  require(job.pulse_pitch_um > 0 && job.mark_speed_mm_s > 0 && job.servo_us > 0);
  if (job.beam) {
    require(job.beam->wavelength_um > 0 && job.beam->m_squared >= 1 && job.beam->focal_length_mm > 0);
    require(job.beam->average_power_w.has_value() == job.beam->threshold_j_cm2.has_value());
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = gravure::fuzz::text_of(data, size);
  const auto job = gravure::parse_zones_job(text, std::string(kPath));
  job ? check_job(job.value()) : check_error(job.error());
  return 0;
}
