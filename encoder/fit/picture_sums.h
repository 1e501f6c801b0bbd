// SPDX-License-Identifier: Apache-2.0
// A picture as sums over what its pixels are made of: the renderer's weights W, both ways.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "encoder/fit/picture_views.h"

namespace slf {

/// What a vector of the solver has of a ray.
using Colour3 = std::array<float, 3>;

inline Colour4 widened(const Colour3& x) { return {x[0], x[1], x[2], 0}; }

inline void add_scaled(float factor, const Colour4& x, Colour4& to) {
  for (std::size_t c = 0; c < 4; ++c) to[c] += factor * x[c];
}

/// The sum of what a pixel is made of.
inline Colour4 mixed(const PictureView& view, std::size_t pixel,
                     const std::vector<Colour4>& local) {
  Colour4 sum{};
  for (auto j = view.first[pixel]; j < view.first[pixel + 1]; ++j)
    add_scaled(view.weight[j], local[view.local(j)], sum);
  return sum;
}

/// Photograph less picture.
inline Colour4 error_of(const PictureView& view, std::size_t pixel,
                        const std::vector<Colour4>& local) {
  const Colour4 is = mixed(view, pixel, local);
  Colour4 error{};
  const Colour4 photograph = view.photograph(pixel);
  for (std::size_t c = 0; c < 3; ++c) error[c] = photograph[c] - is[c];
  return error;
}

inline float square(const Colour4& error) {
  return error[0] * error[0] + error[1] * error[1] + error[2] * error[2];
}

/// The view's own part of a vector; colours as a renderer clamps them.
inline std::vector<Colour4> gathered(const PictureView& view, const std::vector<Colour3>& x,
                                     bool clamped) {
  std::vector<Colour4> local(view.points.size());
  for (std::size_t i = 0; i < local.size(); ++i) {
    local[i] = widened(x[static_cast<std::size_t>(view.ray[i])]);
    if (clamped)
      for (float& c : local[i]) c = std::clamp(c, 0.0f, 255.0f);
  }
  return local;
}

/// x += W^T of what `pixel` gives for each.
template <class Pixel>
void spread(const PictureView& view, const Pixel& pixel, std::vector<Colour3>& x) {
  std::vector<Colour4> sums(view.points.size());
  for (std::size_t i = 0; i < view.pixels(); ++i) {
    Colour4 value = pixel(i);
    for (float& c : value) c *= view.trust[i];
    for (auto j = view.first[i]; j < view.first[i + 1]; ++j)
      add_scaled(view.weight[j], value, sums[view.local(j)]);
  }
  for (std::size_t i = 0; i < sums.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) x[static_cast<std::size_t>(view.ray[i])][c] += sums[i][c];
}

}  // namespace slf
