// SPDX-License-Identifier: Apache-2.0
#include "encoder/train/training_digest.h"

#include <array>
#include <cstdint>

#include "base/sha256.h"

namespace slf {

TrainingDigest digest_of_training(std::span<const TrainingView> views,
                                  const TrainSettings& settings, const TrainedSurfels& surfels) {
  Sha256 hash;
  const auto add = [&](const auto* values, std::size_t count) {
    hash.update({reinterpret_cast<const std::uint8_t*>(values), count * sizeof *values});
  };
  const std::array numbers = {double(settings.iterations),
                              settings.from,
                              double(settings.surfels),
                              double(settings.levels),
                              double(settings.structure),
                              double(settings.squared),
                              double(settings.spread),
                              double(settings.together),
                              double(settings.decided),
                              settings.coarse,
                              double(settings.least_opacity),
                              settings.replaced,
                              double(views.size()),
                              double(surfels.size()),
                              double(settings.twists != nullptr),
                              double(settings.harmonics.degree),
                              double(settings.harmonics.rate),
                              double(settings.harmonics.sparsity)};
  add(numbers.data(), numbers.size());
  for (const TrainedSurfel& surfel : surfels) add(surfel.value.data(), surfel.value.size());
  for (const TrainingView& view : views) {
    const TrainingCamera& c = view.camera;
    const std::array whole = {view.index, c.width, c.height, int(c.gaussian)};
    const std::array lens = {c.fx, c.fy, c.cx, c.cy, c.depth};
    add(whole.data(), whole.size());
    add(lens.data(), lens.size());
    for (const Float3& row : c.rotation) add(row.data(), row.size());
    for (const Float3* at : {&c.translation, &c.centre, &view.background})
      add(at->data(), at->size());
    add(view.picture.value.data(), view.picture.value.size());
    add(view.hiding.data(), view.hiding.size());
  }
  return hash.finish();
}

}  // namespace slf
