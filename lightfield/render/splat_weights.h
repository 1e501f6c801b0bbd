// SPDX-License-Identifier: Apache-2.0
// A picture as a linear function of the colours of points: what a fit to pictures inverts.
#pragma once

#include <cstdint>
#include <vector>

#include "lightfield/render/render_splats.h"

namespace slf {

/// The picture of a view before the background: the colour of pixel i is the sum of weight[e] *
/// colour of point[e] over first[i] <= e < first[i + 1].
struct SplatWeights {
  std::vector<std::uint32_t> first;  ///< [height * width + 1]
  std::vector<std::uint32_t> point;
  std::vector<float> weight;    ///< > 0, of sum 1 over a pixel that shows anything
  std::vector<float> coverage;  ///< [height * width], as in SplatImage
  std::vector<float> depth;     ///< [height * width], as in SplatImage
};

/// The weights with which rasterise() would blend. The same for any thread count.
SplatWeights splat_weights(const std::vector<Splat>& splats, int width, int height, int threads);

}  // namespace slf
