// SPDX-License-Identifier: Apache-2.0
// From a capture to an integer light field: the encoder's steps before coding. The decoder of
// image-plus-geometry files (tools/rd/igc/) runs the same ones on what it decoded.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "encoder/fit/fitted_rows.h"
#include "encoder/fit/held_out_pictures.h"
#include "encoder/fit/observe_points.h"
#include "slf/encoder.h"

namespace slf {

/// Without photographs a point has a colour, whatever the direction.
void fit_colours_alone(EncoderSettings& settings);

/// The cloud on the grid, which is from capture.origin. With normals, those of the capture or
/// estimated ones, where cameras or settings.normal_bits need them. Errors as voxelise.
Result<VoxelCloud, InputError> voxelise_capture(const Capture& capture,
                                                std::span<const int> cameras,
                                                const EncoderSettings& settings);

/// The same with geometry mended first, where photographs gain.
/// @param pays  RefineSettings::pays
/// @param report  receives what became of the points
Result<VoxelCloud, InputError> voxelise_mended(const Capture& capture, std::span<const int> cameras,
                                               const EncoderSettings& settings, RefineGeometry mode,
                                               std::function<Result<bool, InputError>()> pays,
                                               RefineReport& report, const Progress& progress);

/// View maps in floating point.
struct CaptureFit {
  std::vector<float> coefficients;  ///< [P][K][3] in R, G, B; K of chosen.settings.basis
  ChosenFit chosen;
  PictureFit pictures;                              ///< where chosen.settings.pictures has rounds
  std::shared_ptr<const HeldOutPictures> held_out;  ///< of a picture fit, where it was wanted
  std::vector<CameraTrust> cameras;  ///< of settings.check_cameras, ascending; else empty
  int gamma_min_q7 = -127, gamma_max_q7 = 127;
  std::size_t observations = 0, unobserved_points = 0;
  double seconds_observe = 0, seconds_choose = 0, seconds_fit = 0, seconds_pictures = 0;
};

/// The points of a fit, as the world has them.
ObservedPoints world_points(const VoxelCloud& cloud);

/// Settings whose lengths are in spacings of points, in voxels. positions: Morton order, or a part
FitSettings in_spacings(FitSettings fit, std::span<const Voxel> positions, int grid_bits);

/// What view maps are fitted to.
struct FittedCloud {
  const Capture& capture;
  std::span<const int> cameras;  ///< ascending
  const VoxelCloud& cloud;       ///< with normals
  DepthOfCamera hidden_by;       ///< of what is not in the cloud; or empty
  bool hold_out = false;         ///< CaptureFit::held_out is wanted
};

/// The last steps of fit_capture: to settings that are chosen, with cameras that are checked.
/// @param world  observations of the trusted cameras, of world directions
/// @param fit    `chosen` and `cameras` are there; receives the rest
Result<Done, InputError> fit_chosen(const FittedCloud& of, Observations world,
                                    const EncoderSettings& settings, const Progress& progress,
                                    CaptureFit& fit);

/// View maps from what the cameras saw of a cloud with normals. Paper II, III-A. Errors as observe,
/// choose_fit and fit_view_maps.
/// @param hold_out  CaptureFit::held_out is wanted
Result<CaptureFit, InputError> fit_capture(const Capture& capture, std::span<const int> cameras,
                                           const VoxelCloud& cloud, const EncoderSettings& settings,
                                           const Progress& progress, bool hold_out = false);

/// The integer light field, its shifts as fine as the coder takes them. Spec 6.3, 6.5.
/// @param origin    of the capture that the cloud was made of: the field is in the world
/// @param settings  their fit is fit.chosen.settings
/// @param shift     of the functions; empty: as fine as they can be
LightField quantise_grid(const VoxelCloud& cloud, CaptureFit fit, const Vec3& origin, UpAxis up,
                         const EncoderSettings& settings, const std::vector<int>& shift = {});

/// The same of coefficients in pieces, without normals and at the origin of the grid; what is held
/// is little more than the components.
/// @param fit  without its coefficients
LightField quantise_rows(const Grid& grid, std::vector<Voxel> positions, FittedRows rows,
                         const CaptureFit& fit, const EncoderSettings& settings,
                         const std::vector<int>& shift = {});

/// Without cameras: the colours that the points have.
/// @errors kInvalidInput: they have none
Result<CaptureFit, InputError> colours_alone(const VoxelCloud& cloud);

}  // namespace slf
