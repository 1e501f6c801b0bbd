// SPDX-License-Identifier: Apache-2.0
// Pictures of splats, by which others are judged: where there are no photographs.
#pragma once

#include <vector>

#include "slf/gaussians.h"
#include "slf/render.h"

namespace slf {

/// Pictures from around the splats, of which others are to be like.
class SplatPictures {
 public:
  /// O(views (splats + pixels)).
  SplatPictures(const Gaussians& splats, int threads);

  /// dB, pooled over views, channels and the pixels that either shows; 100 where all are the same.
  /// The same for any thread count.
  double psnr_of(const Gaussians& others) const;

 private:
  int threads_;
  std::vector<Camera> cameras_;
  std::vector<Rendering> pictures_;  ///< [cameras]
};

}  // namespace slf
