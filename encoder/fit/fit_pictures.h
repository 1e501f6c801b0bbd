// SPDX-License-Identifier: Apache-2.0
// View maps whose pictures look like the photographs.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "encoder/fit/observe_points.h"
#include "slf/capture.h"
#include "slf/fit.h"

namespace slf {

/// What a picture fit is about.
struct PictureFitInput {
  const Capture& capture;
  std::span<const int> cameras;
  std::span<const std::array<float, 3>> gains;  ///< [cameras] of their photographs, or empty: 1
  const Grid& grid;
  std::span<const Voxel> positions;        ///< Morton order
  const CodedNormals& normals;             ///< those of the file, or none
  Transfer transfer = Transfer::kDisplay;  ///< of the coefficients
  std::array<float, 2> gamma_range{-1, 1};
  DepthOfCamera hidden_by = {};  ///< of points that are not among these; or empty
  /// Observations along local directions, at the points held_out_points() alone. Where they are
  /// given, pictures are held out from another fit
  const Observations* seen = nullptr;
};

class HeldOutPictures;

/// Moves coefficients so that the renderer's pictures of them have the least squared error to the
/// photographs, with a pull to where they started (picture_system.h). Rays along the surface count
/// as any other; pixels that are far off count little, and again so after every round.
/// @param coefficients  [P][K][3], in R, G, B
/// @param search  whether held-out cameras choose the pull (FitSearch::pictures), of 8 cameras or
/// more
/// @param settings  its basis and directions are those of the coefficients
/// @param held_out  receives pictures of a fit that has not used them, where input.seen is given
/// @errors those of load_image
/// The same for any thread count. O(rays x cameras of a point) and O(pixels) a step.
Result<PictureFit, InputError> fit_to_pictures(
    const PictureFitInput& input, const FitSettings& settings, bool search,
    std::vector<float>& coefficients, const Progress& progress = {},
    std::shared_ptr<const HeldOutPictures>* held_out = nullptr);

}  // namespace slf
