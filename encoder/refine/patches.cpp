// SPDX-License-Identifier: Apache-2.0
#include "encoder/refine/patches.h"

#include <cmath>

#include "base/multiversion.h"

namespace slf {
namespace {

constexpr std::size_t kLeastPatches = 3;  // fewer say nothing

// Small parts of what is compiled for several machines.
[[gnu::always_inline]] inline float total(const PatchValues& values) {
  std::array<float, 8> lanes{};
  for (std::size_t i = 0; i < kPatchPadded; i += 8)
    for (std::size_t k = 0; k < 8; ++k) lanes[k] += values[i + k];
  return ((lanes[0] + lanes[4]) + (lanes[1] + lanes[5])) +
         ((lanes[2] + lanes[6]) + (lanes[3] + lanes[7]));
}

[[gnu::always_inline]] inline float squared_length(const PatchValues& values) {
  PatchValues squares;
  for (std::size_t i = 0; i < kPatchPadded; ++i) squares[i] = values[i] * values[i];
  return total(squares);
}

}  // namespace

PatchSampler::PatchSampler(const PhotoView& view, const PatchPath& path, float spacing, float noise)
    : view_(&view), path_(path), noise_(noise) {
  const auto& t = path.tangent;
  std::size_t n = 0;
  for (int i = -kPatchRadius; i <= kPatchRadius; ++i)
    for (int j = -kPatchRadius; j <= kPatchRadius; ++j, ++n) {
      const float a = spacing * float(i), b = spacing * float(j);
      across_[n] = a * t[0] + b * t[2];
      down_[n] = a * t[1] + b * t[3];
    }
  const float reach = spacing * float(kPatchRadius);
  width_ = reach * (std::abs(t[0]) + std::abs(t[2]));
  height_ = reach * (std::abs(t[1]) + std::abs(t[3]));
}

/// Bilinear samples around (u, v), corner convention; false where one is outside.
[[gnu::always_inline]] inline bool PatchSampler::sample(float u, float v,
                                                        PatchValues& value) const {
  constexpr float kMargin = 1e-2f;  // pixels: rounding moves no sample farther
  const float x = u - 0.5f, y = v - 0.5f;
  const PhotoView& view = *view_;
  if (!(x - width_ >= kMargin && x + width_ < float(view.width - 1) - kMargin &&
        y - height_ >= kMargin && y + height_ < float(view.height - 1) - kMargin))
    return false;
  PatchValues right, below;
  std::array<std::int32_t, kPatchPadded> at;
  for (std::size_t i = 0; i < kPatchPadded; ++i) {
    const float xi = x + across_[i], yi = y + down_[i];
    const auto column = std::int32_t(xi), row = std::int32_t(yi);
    right[i] = xi - float(column);
    below[i] = yi - float(row);
    at[i] = row * view.width + column;
  }
  PatchValues corner[4];
  for (std::size_t i = 0; i < kPatchSamples; ++i) {
    const float* top = view.grey.data() + at[i];
    const float* bottom = top + view.width;
    corner[0][i] = top[0];
    corner[1][i] = top[1];
    corner[2][i] = bottom[0];
    corner[3][i] = bottom[1];
  }
  for (std::size_t i = kPatchSamples; i < kPatchPadded; ++i)
    for (PatchValues& c : corner) c[i] = 0;
  for (std::size_t i = 0; i < kPatchPadded; ++i) {
    const float above = corner[0][i] + right[i] * (corner[1][i] - corner[0][i]);
    const float under = corner[2][i] + right[i] * (corner[3][i] - corner[2][i]);
    value[i] = above + below[i] * (under - above);
  }
  return true;
}

SLF_MULTIVERSION_ALL std::optional<float> PatchSampler::add(float offset, PatchValues& sum) const {
  const double w = path_.at[2] + double(offset) * path_.step[2];
  if (!(w > 0)) return {};
  const auto u = float((path_.at[0] + double(offset) * path_.step[0]) / w);
  const auto v = float((path_.at[1] + double(offset) * path_.step[1]) / w);
  PatchValues value;
  if (!sample(u, v, value)) return {};
  const float mean = total(value) / float(kPatchSamples);
  if (!std::isfinite(mean)) return {};  // masked
  for (std::size_t i = 0; i < kPatchSamples; ++i) value[i] -= mean;
  const float squares = squared_length(value);
  const float length = squares + float(kPatchSamples) * noise_ * noise_;
  const float scale = 1 / std::sqrt(length);
  for (std::size_t i = 0; i < kPatchPadded; ++i) sum[i] += scale * value[i];
  return squares / length;
}

float disagreement(const PatchValues& sum, float own, std::size_t patches) {
  if (patches < kLeastPatches) return 1;
  return 1 - (squared_length(sum) - own) / float(patches * (patches - 1));
}

}  // namespace slf
