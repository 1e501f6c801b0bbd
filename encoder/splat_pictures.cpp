// SPDX-License-Identifier: Apache-2.0
#include "encoder/splat_pictures.h"

#include <algorithm>
#include <array>

#include "base/error_sum.h"
#include "slf/gaussian_renderer.h"

namespace slf {
namespace {

constexpr int kSide = 320;  // pixels
constexpr int kTurns = 4;
constexpr std::array kElevations = {-20.0, 15.0, 50.0};  // degrees
constexpr double kSame = 100;                            // dB, of pictures without a difference

}  // namespace

SplatPictures::SplatPictures(const Gaussians& splats, int threads) : threads_(threads) {
  const GaussianRenderer renderer(splats, {.background = {0, 0, 0}, .threads = threads});
  for (std::size_t e = 0; e < kElevations.size(); ++e)
    for (int t = 0; t < kTurns; ++t) {
      // Turned from circle to circle, so that no two views lie above each other.
      const double turn = (t + double(e) / kElevations.size()) / kTurns;
      cameras_.push_back(renderer.orbit(turn, kElevations[e], kSide, kSide));
      pictures_.push_back(renderer.render(cameras_.back()));
    }
}

double SplatPictures::psnr_of(const Gaussians& others) const {
  const GaussianRenderer renderer(others, {.background = {0, 0, 0}, .threads = threads_});
  ErrorSum errors;
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    const Rendering drawn = renderer.render(cameras_[i]);
    const Rendering& was = pictures_[i];
    for (std::size_t p = 0; p < drawn.coverage.size(); ++p) {
      if (drawn.coverage[p] == 0 && was.coverage[p] == 0) continue;
      std::array<double, 3> error{};
      for (std::size_t c = 0; c < 3; ++c)
        error[c] = double(drawn.image.data[3 * p + c]) - double(was.image.data[3 * p + c]);
      errors.add(error);
    }
  }
  return errors.count > 0 ? std::min(errors.psnr(), kSame) : kSame;
}

}  // namespace slf
