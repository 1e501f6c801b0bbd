// SPDX-License-Identifier: Apache-2.0
// Splats to bytes: points with a view map, a shape and an opacity. Spec 6.8.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "slf/encoder.h"
#include "slf/gaussians.h"

namespace slf {

/// Where EncoderSettings::q is kAutomaticQ. It costs about 0.25 dB of pictures
/// (docs/decisions/024).
inline constexpr double kGaussianQ = 7;
/// The same of splats that photographs train: with kAutomaticRdo, docs/decisions/073.
inline constexpr double kTrainedGaussianQ = 6.5;

struct EncodedGaussians {
  std::vector<std::uint8_t> stream;
  double q = 0;
  Grid grid;
  std::size_t splats = 0, left_out = 0;  ///< that were coded; that no pixel shows
  std::string warning;                   ///< that no step meets a target; empty: one does
};

/// Splats that no pixel can show (opacity below 1 / 255) are left out. One Q says how fine all is:
/// harmonics have steps of Q grey levels, logits and logarithms of deviations steps in proportion,
/// and so has the grid, against the median deviation along the middle axis.
/// @param splats    move them in where they are not needed again: a copy is saved
/// @param settings  q, or target_bytes, or target_psnr: of twelve pictures from around the splats,
///                  against those of the splats as they are given, where either shows something,
///                  to 0.05 dB more; the nearest file where no step meets a target;
///                  grid_bits or voxel_size in place of the grid; what CodingParameters are made
///                  of; metadata, threads. Nothing else of it counts.
/// @param origin  world place that splats.origin is from
/// @errors kInvalidInput: no splats, or none that shows; those of check_gaussians().
///         kInvalidArgument: a setting out of its range, with its name; another coder than splats
///         have; those of pack(). The same bytes for any thread count.
Result<EncodedGaussians, InputError> encode_gaussians(Gaussians splats,
                                                      const EncoderSettings& settings,
                                                      const Vec3& origin = {0, 0, 0});

}  // namespace slf
