// SPDX-License-Identifier: Apache-2.0
// Surfels as a camera sees them, and their rasterisation. Botsch, Hornung, Zwicker, Kobbelt,
// "High-quality surface splatting on today's GPUs" (2005), with the screen-space filter of
// Zwicker et al., "EWA splatting" (2002), on the CPU.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "slf/capture.h"

namespace slf {

/// A disc in world space.
struct Disc {
  Vec3 centre;
  Vec3 normal;  ///< unit, of either sign; 0: faces the camera
  double radius;
  double area = 0;  ///< of the surface that it stands for; 0: as much as in a cloud of even spacing
};

/// A disc in the image: an ellipse  a x^2 + 2 b x y + c y^2 < 1  around (u, v), filtered to the
/// pixel grid, with the plane's inverse depth, which is linear in the image.
struct Splat {
  float u, v;                     ///< pixels, centre of the top left pixel at (0.5, 0.5)
  float a, b, c;                  ///< 1 / pixel^2
  float half_width, half_height;  ///< of the ellipse's box, pixels
  float half_chord;               ///< of the ellipse, along the row through its centre
  float slope;                    ///< columns that the middles of chords move by a row, to the left
  float inverse_depth, inverse_depth_du, inverse_depth_dv;
  float inverse_depth_change;  ///< at most, within the ellipse
  float fade;    ///< 1 / the inverse depth behind the nearest at which it no longer counts
  float weight;  ///< at the centre: the number of such discs on a pixel times it is their density
  std::uint32_t point;
};

/// Nothing where the disc is behind the camera, or its ellipse outside the image.
std::optional<Splat> project_disc(const Camera& camera, const Disc& disc, std::uint32_t point);

/// Weighted means per pixel, of an image or some rows of it.
struct SplatImage {
  std::vector<std::array<float, 3>> colour;  ///< [height][width] 0 where nothing is
  std::vector<float> coverage;               ///< [height][width] 0 .. 1
  std::vector<float> depth;                  ///< [height][width] +inf where nothing is
};

/// Receives some rows from the one of `first_pixel` on; called from several threads.
using RowSink = std::function<void(std::size_t first_pixel, const SplatImage& rows)>;

/// Writes the colours of points, [points]; called from several threads, once per point at most.
using ColourSource =
    std::function<void(std::span<const std::uint32_t> points, std::span<std::array<float, 3>>)>;

/// Depth of the nearest discs, then the mean of what lies close behind it, spec annex E. Asks for
/// the colours of points that show, no others. The same for any thread count.
SplatImage rasterise(const std::vector<Splat>& splats, int width, int height, int threads,
                     const ColourSource& source);

/// Was the work given up? `ended` may be none.
inline bool is_ended(const std::atomic<bool>* ended) { return ended != nullptr && ended->load(); }

/// The same with rows as they are done, in any order.
/// @param ended  or none: where it is set, bands that are not begun stay away
void rasterise(const std::vector<Splat>& splats, int width, int height, int threads,
               const ColourSource& source, const RowSink& sink,
               const std::atomic<bool>* ended = nullptr);

/// The same with one colour at a time.
SplatImage rasterise(const std::vector<Splat>& splats, int width, int height, int threads,
                     const std::function<std::array<float, 3>(std::uint32_t point)>& colour);

}  // namespace slf
