#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "gravure/core/error.hpp"
#include "gravure/core/progress.hpp"
#include "gravure/texture/decomposition.hpp"
#include "gravure/texture/split.hpp"

namespace gravure::texture {

/// Ways to make the stages' path out of a texture's. The linear ones halve waves of the same length for the same sigma:
/// 2 pi sigma / (2 ln 2)^(1/2) = 5.34 sigma of arc length.
enum class SplitMethod : std::uint8_t {
  gaussian,        ///< [A]: slow_part()
  savitzky_golay,  ///< least squares of a cubic over a window: keeps cubics as they are
  fft,             ///< 1 / (1 + (w / w_half)^8) of each wave: flat up to where it falls
  adaptive,        ///< a Gaussian that gets narrower where limits would be broken, and only there
  optimal,         ///< least third differences of all paths that stay close enough to the texture at every point
};
std::string_view split_method_name(SplitMethod method) noexcept;

struct SplitRequest {
  const Surface& surface;
  const TexturePath& path;
  std::span<const SurfacePoint> targets;  ///< the path's points on the surface
  double sigma_mm = 0;                    ///< adaptive: the widest; optimal: not looked at
  DeviationLimits limits;                 ///< adaptive, optimal: what every point is to keep to
};

class Splitter {
 public:
  virtual ~Splitter() = default;
  /// The stages' path in the plane. out_of_range for filters that are none and for limits that cannot be kept to,
  /// naming a point; errors of Surface::project(); cancelled on request.
  virtual Result<std::vector<Vector2>> stages_mm(const SplitRequest& request, const CancelToken& cancel) const = 0;
  /// Keeps to the limits at every point whatever sigma is.
  virtual bool keeps_limits() const noexcept = 0;
};

/// `filter` gives cut and ends; its sigma is not looked at. Ways but the Gaussian end odd.
std::unique_ptr<Splitter> make_splitter(SplitMethod method, const GaussianFilter& filter);

/// Splits by a splitter. Errors as Splitter::stages_mm().
Result<Split> split_path(const Splitter& splitter, const Surface& surface, const TexturePath& path,
                         const DeviationLimits& limits, double sigma_mm, const CancelToken& cancel);

/// Splits by the rule of [A] (split_by_published_rule() of split.hpp) with any splitter; one that keeps to the limits
/// itself is run once, from 30 mm.
Result<Split> split_by_published_rule(const Splitter& splitter, const Surface& surface, const TexturePath& path,
                                      const DeviationLimits& limits, const CancelToken& cancel);

/// How hard the stages' points are to follow, by length of path: at a feed of v mm/s their acceleration is v^2 times
/// the one, their jerk v^3 times the other.
struct StageDemand {
  double max_bend_per_mm = 0;  ///< second differences / step^2
  double max_jerk_per_mm2 = 0;
  double rms_jerk_per_mm2 = 0;  ///< third differences / step^3
};
StageDemand stage_demand(std::span<const SurfacePoint> stages, double step_mm);

}  // namespace gravure::texture
