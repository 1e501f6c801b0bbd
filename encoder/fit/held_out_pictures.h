// SPDX-License-Identifier: Apache-2.0
// Pictures of input cameras that a fit has not used: what a coder's losses are weighed against.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "encoder/fit/fit_pictures.h"
#include "encoder/fit/picture_system.h"

namespace slf {

/// Some of the points, with a fit of them that has not used some of the input cameras, and the
/// pixels of these cameras' photographs that nothing but those points shows.
class HeldOutPictures {
 public:
  /// What a picture fit has when it is done.
  struct Input {
    const PictureFitInput& of;
    const FitSettings& settings;
    const PictureViews& views;   ///< [cameras]; those that are empty are neither used nor held out
    std::span<const Vec3> eyes;  ///< [cameras]
    std::span<const int> fold;   ///< [cameras] camera_folds
    double pull;                 ///< PictureFit::pull
    std::span<const float> coefficients;  ///< [P][K][3] of the fit that all cameras have
  };

  /// Holds a quarter of the cameras out, in groups of neighbours, so that the error is that of
  /// views between what was photographed: small groups where cameras are few, else it is that of
  /// views that nothing is near.
  /// @return the points may be none, where no camera or no pixel can be held out: see cameras(),
  ///         pixels()
  /// @errors those of fit_view_maps
  /// The same for any thread count. A fit of a sixth of the points.
  static Result<std::shared_ptr<const HeldOutPictures>, InputError> of(const Input& input);

  std::size_t cameras() const { return cameras_; }  ///< that are held out; 0: too few for that
  std::size_t pixels() const { return pixels_; }    ///< of their photographs
  const std::vector<Voxel>& positions() const { return positions_; }        ///< Morton order
  const std::vector<float>& coefficients() const { return coefficients_; }  ///< [points][K][3]
  /// [points][K][3] of the same points, by all cameras: what is coded.
  const std::vector<float>& coded() const { return coded_; }
  double seconds() const { return seconds_; }  ///< that the fit took

  /// The error over pixels and channels of the held-out pictures, colours clamped to 0 .. 255.
  double mean_squared_error(std::span<const float> coefficients) const;
  /// By how much two sets of coefficients differ in the same pixels and channels.
  double mean_squared_change(std::span<const float> from, std::span<const float> to) const;

  HeldOutPictures(const HeldOutPictures&) = delete;
  HeldOutPictures& operator=(const HeldOutPictures&) = delete;

 private:
  HeldOutPictures() = default;
  Result<Done, InputError> fit(const Input& input, std::span<const std::uint32_t> points,
                               const std::vector<bool>& held_out);

  Grid grid_;
  std::vector<Voxel> positions_;
  std::vector<float> coefficients_, coded_;
  PictureViews views_;                     // those that are held out; the others are empty
  std::unique_ptr<PictureSystem> system_;  // of the members above
  std::size_t cameras_ = 0, pixels_ = 0;
  double seconds_ = 0;
};

/// Indices of the points that are fitted again.
/// @param positions     Morton order
/// @param spacing_log2  between points, voxels
std::vector<std::uint32_t> held_out_points(std::span<const Voxel> positions, int spacing_log2);

/// What was seen of some of the points.
Observations observations_of(const Observations& seen, std::span<const std::uint32_t> points);

/// Indices of about so many points: whole cells, spread evenly, that are as large as so few allow.
/// @param positions     Morton order
/// @param spacing_log2  between points, voxels
std::vector<std::uint32_t> spread_cells(std::span<const Voxel> positions, int spacing_log2,
                                        std::size_t about);

}  // namespace slf
