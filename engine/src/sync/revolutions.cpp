#include <algorithm>
#include <cassert>
#include <string>

#include "gravure/sync/make_plan.hpp"

namespace gravure {

std::int64_t layer_of_revolution(LayerOrder order, std::int64_t layers, std::int64_t revolution) {
  assert(layers >= 1 && revolution >= 0);
  switch (order) {
    case LayerOrder::cycle:
      return revolution % layers;
    case LayerOrder::hold:
      return std::min(revolution, layers - 1);
    case LayerOrder::sequence:
      break;
  }
  assert(revolution < layers);
  return revolution;
}

Result<std::int64_t> resolve_revolutions(const Job& job, std::optional<std::int64_t> layers) {
  const ImageSettings& image = job.image;
  if (job.mode == Mode::helical && !layers && !image.depth_map) {
    return job.carriage.layers;
  }
  if (!layers && image.depth_map) {
    layers = image.levels;
  }
  if (layers && *layers < 1) {
    return Error{ErrorCode::bad_argument,
                 job.place_of("image.files") + "image.files: there is no layer in them; at least 1 is needed"};
  }
  if (!layers && !image.revolutions) {
    return Error{
        ErrorCode::bad_argument,
        job.place_of("image") +
            "image.revolutions is missing: one per layer is the default, and the number of layers is not known "
            "without the images; give image.revolutions, or the images"};
  }
  const std::int64_t revolutions = image.revolutions.value_or(layers.value_or(0));
  if (revolutions < 1) {
    return Error{ErrorCode::out_of_range, job.place_of("image.revolutions") + "image.revolutions = " +
                                              std::to_string(revolutions) + ": must be at least 1"};
  }
  if (layers && image.order == LayerOrder::sequence && revolutions != *layers) {
    return Error{ErrorCode::bad_argument,
                 job.place_of("image.revolutions") + "image.revolutions = " + std::to_string(revolutions) +
                     ": image.order = \"sequence\" needs as many as " + "there are layers, " + std::to_string(*layers) +
                     "; set image.revolutions = " + std::to_string(*layers) +
                     ", or image.order = \"cycle\" or \"hold\""};
  }
  return revolutions;
}

}  // namespace gravure
