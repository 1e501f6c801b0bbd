// SPDX-License-Identifier: Apache-2.0
// Surfels to pictures, front to back, and gradients back again.
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/train/trained_surfel.h"
#include "encoder/train/training_view.h"

namespace slf {

/// A surfel in a picture, where r^2 = a du^2 + 2 b du dv + c dv^2 < reach: alpha = opacity times
/// (1 - r^2)^4, or a Gaussian's.
struct ProjectedSurfel {
  float u = 0, v = 0;                     ///< pixels, corner convention
  float a = 0, b = 0, c = 0;              ///< 1 / pixel^2
  float reach = 1;                        ///< less: alpha is less than 1/255 sooner
  float half_width = 0, half_height = 0;  ///< of the box within the reach
  float opacity = 0;
  Float3 colour{};
  /// Inverse depth of its plane in units of 1 / TrainingCamera::depth: linear in the picture.
  float near = 0, near_du = 0, near_dv = 0;
  std::uint32_t surfel = 0;
};

/// What one picture's loss says about one projected surfel.
struct ProjectedGradient {
  Float3 colour{};
  float opacity = 0, a = 0, b = 0, c = 0, u = 0, v = 0;
  float near = 0, near_du = 0, near_dv = 0;
  float drawn = 0;  ///< sum over pixels of the weight
  float pull = 0;   ///< sum over pixels of the length of the gradient by (u, v): where it is large
                    ///< one surfel has to do the work of two
};

/// Which surfels are seen, nearest first, and which tiles of 16 x 16 pixels each touches.
struct SurfelTiles {
  std::vector<ProjectedSurfel> projected;  ///< ascending depth, then index
  int columns = 0, rows = 0;
  std::vector<std::uint32_t> first;       ///< [tiles + 1] where each one's list begins
  std::vector<std::uint32_t> list;        ///< indices of `projected`, ascending in each tile
  std::vector<std::uint32_t> blocks;      ///< [list] blocks of the tile that it may touch
  std::vector<std::uint32_t> pair_first;  ///< [projected + 1]
  std::vector<std::uint32_t> pair;        ///< [list] its place, projected by projected
};

/// What a pixel sums up.
struct DrawnSurfels {
  PlanarPicture picture;                 ///< over the background
  std::vector<float> transparency;       ///< [height][width] share of the background
  std::vector<float> near, near_square;  ///< sums of weighted inverse depths less `pivot`
  std::vector<float> pivot;              ///< the nearest surfel's inverse depth: keeps digits
  std::vector<std::uint32_t> blocks;     ///< [SurfelTiles::list] blocks that show it
};

/// Gradients of a picture's loss.
struct ProjectedGradients {
  std::vector<ProjectedGradient> sums;  ///< [projected]
  std::vector<ProjectedGradient>
      pairs;  ///< [list] of a tile each, in the order of SurfelTiles::pair
};

SurfelTiles tile_surfels(const TrainedSurfels& surfels, const TrainingCamera& camera, int threads);
void draw_surfels(const SurfelTiles& tiles, const TrainingView& view, int threads,
                  DrawnSurfels& drawn);

/// Gradients of a loss with a given gradient by the picture plus
///   spread * sum over pixels of sum_i<j w_i w_j (near_i - near_j)^2,
/// which draws what a pixel sums up together in depth, and so planes into one another, plus
///   sum over pixels of TrainingView::hiding * the share of the background that is hidden.
/// @param picture  gradient by the picture, as DrawnSurfels::picture
/// The same for any number of threads.
void surfel_gradients(const SurfelTiles& tiles, const TrainingView& view, const DrawnSurfels& drawn,
                      const PlanarPicture& picture, float spread, int threads,
                      ProjectedGradients& gradients);

/// From gradients of projected surfels to those of the surfels.
/// @param gradients  [surfels] receives them where something is seen, and else stays as it is
void set_surfel_gradients(const TrainedSurfels& surfels, const TrainingCamera& camera,
                          const SurfelTiles& tiles, const std::vector<ProjectedGradient>& projected,
                          std::vector<TrainedSurfel>& gradients, int threads);

/// Where the surfels become opaque, of every pixel.
struct SurfelDepths {
  std::vector<float> depth;           ///< [height][width] along the axis; 0: they do not
  std::vector<std::uint32_t> surfel;  ///< [height][width] the one that it is
};
SurfelDepths surfel_depths(const SurfelTiles& tiles, const TrainingCamera& camera, int threads);

}  // namespace slf
