// SPDX-License-Identifier: Apache-2.0
// The constants of the reference reconstruction, spec annex E. A picture fit inverts exactly this
// kernel, so a renderer with another one shows a fitted file less sharp or too sharp.
#pragma once

namespace slf {

/// Discs of points, their weights in a pixel, and how much of a pixel they cover. What a change of
/// each costs in pictures: docs/decisions/018.
struct ReferenceKernel {
  int version = 2;  ///< 1: that of drafts before format 0.4

  // Weights (E.3).
  double filter_pixels = 1.0;  ///< radius added, in squares, to every ellipse; with exponent 4 as
                               ///< wide (standard deviation) as a pixel's own box
  int exponent = 4;            ///< n of the kernel (1 - r^2)^n; the code has it unrolled
  // Radii of discs (E.2), voxels where there is no other unit.
  double spacing_reach = 1.38;  ///< of the spacing around the point
  double least_reach = 0.98;    ///< of the distance to the sixth nearest: no hole in uneven clouds
  double most_reach = 1.15;     ///< of the same: rims of a surface have half the density
  double smallest = 1.035;
  // Depth (E.4).
  double core = 0.4;  ///< squared ellipse radius within which a disc fixes a pixel's depth
  double band = 0.8;  ///< depth behind the nearest at which a disc no longer counts, in radii of
                      ///< its filtered disc over the cosine to the view ...
  double steepest = 0.3;  ///< ... which counts as no less than this
  double flattest = 0.1;  ///< cosine; flatter discs are tilted towards the eye: voxels have a
                          ///< thickness
  // Coverage (E.5).
  double disc_share = 0.85;  ///< of a disc's radius that covers pixels
  double density_gain = 2;   ///< coverage = gain * density - offset, or that of a disc
  double density_offset = 0.5;
};

inline constexpr ReferenceKernel kReferenceKernel;

}  // namespace slf
