// SPDX-License-Identifier: Apache-2.0
// Patches of a surface as photographs show them, and how far they agree.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "encoder/refine/photo_views.h"

namespace slf {

/// A patch has (2 kPatchRadius + 1)^2 samples.
inline constexpr int kPatchRadius = 2;
inline constexpr std::size_t kPatchSamples = (2 * kPatchRadius + 1) * (2 * kPatchRadius + 1);
/// Filled up with zeros to whole vectors of eight.
inline constexpr std::size_t kPatchPadded = (kPatchSamples + 7) / 8 * 8;

using PatchValues = std::array<float, kPatchPadded>;

/// What one photograph shows of a patch, moved along a line through space.
class PatchSampler {
 public:
  /// @param spacing  of samples, world units
  /// @param noise  grey levels: what drowns weaker texture
  /// The view is kept by reference.
  PatchSampler(const PhotoView& view, const PatchPath& path, float spacing, float noise);

  /// Samples without their mean, of length at most 1 (less where noise drowns them), added to
  /// `sum`; their squared length. Nothing: not all of it is in the photograph.
  std::optional<float> add(float offset, PatchValues& sum) const;

 private:
  bool sample(float u, float v, PatchValues& value) const;

  const PhotoView* view_;
  PatchPath path_;
  PatchValues across_{}, down_{};  ///< of each sample from the middle, pixels
  float width_, height_;           ///< of half the patch
  float noise_;
};

/// 1 - mean correlation of all pairs of patches; 1 where they are too few to say anything.
/// @param sum  of the patches
/// @param own  sum of their squared lengths
float disagreement(const PatchValues& sum, float own, std::size_t patches);

}  // namespace slf
