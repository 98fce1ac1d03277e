// Any bytes are a zones job or an Error; a job keeps every range that the table of keys names.

#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "gravure/formats/zones_job.hpp"

namespace {

constexpr std::string_view kPath = "fuzz.toml";

void require(bool holds) {
  if (!holds) {
    std::abort();
  }
}

void check_error(const gravure::Error& error) {
  require(error.code == gravure::ErrorCode::bad_argument || error.code == gravure::ErrorCode::out_of_range ||
          error.code == gravure::ErrorCode::bad_file);
  require(error.message.substr(0, kPath.size()) == kPath);
  for (const char c : error.message) {
    require(c == '\n' || static_cast<unsigned char>(c) >= 0x20U);
  }
}

void check_job(const gravure::ZonesJob& job) {
  require(!job.contours.empty());
  require(job.max_incidence_deg > 0 && job.max_incidence_deg < 90);
  require(job.layer_mm.has_value() != (job.beam && job.beam->fluence_share));
  require(!job.layer_mm || *job.layer_mm > 0);
  require(job.laser.seed_hz > 0 && job.laser.pulse_divider > 0 && job.laser.pulse_divider <= 65'535);
  require(job.pulse_pitch_um > 0 && job.mark_speed_mm_s > 0 && job.servo_us > 0);
  if (job.beam) {
    require(job.beam->wavelength_um > 0 && job.beam->m_squared >= 1 && job.beam->focal_length_mm > 0);
    require(job.beam->average_power_w.has_value() == job.beam->threshold_j_cm2.has_value());
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto job = gravure::parse_zones_job(text, std::string(kPath));
  job ? check_job(job.value()) : check_error(job.error());
  return 0;
}
