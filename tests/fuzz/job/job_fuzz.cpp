// Any bytes are a job or an Error; what either promises holds.

#include <cstdint>
#include <string>
#include <string_view>

#include "gravure/formats/freeform_job.hpp"
#include "gravure/formats/job_file.hpp"
#include "text_reader.hpp"

namespace {

using gravure::fuzz::check_error;
using gravure::fuzz::kPath;
using gravure::fuzz::require;

void check_job(const gravure::Job& job, std::string_view text) {
  require(job.text == text && job.path == kPath);
  require(job.laser.seed_hz > 0 && job.laser.pulse_divider > 0 && job.fpga.counter_bits >= 8);
  const bool turns = job.mode != gravure::Mode::flat;
  require((job.rotary.diameter_mm.has_value() != job.rotary.circumference_mm.has_value()) == turns);
  require((job.rotary.line_pitch_um.has_value() != job.rotary.lines_per_revolution.has_value()) == turns);
  require(!job.image.files.empty() || job.image.depth_map || job.image.pixels_per_line);
  require(job.limits.seam_um > 0);
}

void check_freeform(const gravure::FreeformJob& job, std::string_view text) {
  require(job.job.text == text && job.job.path == kPath && job.job.mode == gravure::Mode::freeform);
  require(gravure::mode_of_job_text(text) == gravure::Mode::freeform);
  const gravure::TextureSettings& of = job.texture;
  require(int{!of.surface.empty()} + int{!of.height_field.empty()} + int{!of.mesh.empty()} == 1);
  require(int{of.hilbert_order != 0} + int{!of.path.empty()} + int{!of.svg.empty()} + int{!of.bitmap.empty()} == 1);
  require(of.pitch_um && *of.pitch_um > 0 && of.fires.empty() == of.bitmap.empty());
  require((of.height_mm.empty() || of.height_mm.size() == 2) && job.axes.origin_mm.size() == 3);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = gravure::fuzz::text_of(data, size);
  const gravure::Result<gravure::Job> result = gravure::parse_job(text, std::string(kPath));
  if (result) {
    check_job(result.value(), text);
  } else {
    check_error(result.error());
  }
  const gravure::Result<gravure::FreeformJob> freeform = gravure::parse_freeform_job(text, std::string(kPath));
  if (freeform) {
    check_freeform(freeform.value(), text);
  } else {
    check_error(freeform.error());
  }
  return 0;
}
