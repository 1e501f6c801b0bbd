// SPDX-License-Identifier: Apache-2.0
// Splats of one instant after the other: what a list of files and a training share.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "encoder/gaussian_coding.h"
#include "slf/frames.h"
#include "slf/gaussians.h"

namespace slf {

/// What has to be known of all frames before the first is coded.
class GaussianExtent {
 public:
  /// @param shown  that_show() of a frame; may be none
  /// @errors kInvalidInput: another degree, or another axis is up, than in the frames before
  Result<Done, InputError> add(const Gaussians& shown);

  /// Makes room for frames that are not there yet: a box that they stay in, in the axes of the
  /// splats, and how many splats they have at most.
  void widen(const std::array<Vec3, 2>& box, std::size_t splats);

  bool is_empty() const { return !first_; }
  /// The grid of all. There is a splat.
  /// @errors kInvalidInput: no picture shows what is in it
  Result<Grid, InputError> grid(double q, const EncoderSettings& settings) const;
  /// The header of all, on that grid.
  LightFieldHeader header(const Grid& grid) const;

 private:
  /// What the first frame that shows something has.
  struct First {
    int degree;
    UpAxis up;
    SplatSizes sizes;
  };
  std::optional<First> first_;
  std::array<Vec3, 2> box_{};
  std::size_t most_ = 0;  // splats of a frame
  bool has_box_ = false;
};

/// Codes frames of splats, one after the other, with one Q and on one grid.
class GaussianFrameEncoder {
 public:
  /// @param extent    of all frames; not empty
  /// @param settings  as of encode_gaussian_frames(), but for the target; q may be automatic
  /// @param group     frames from one that is not predicted to the next
  /// @param first     number of the first frame
  /// @param origin    world place that positions are from, of all frames
  /// @errors those of GaussianExtent::grid
  static Result<GaussianFrameEncoder, InputError> open(const GaussianExtent& extent,
                                                       const EncoderSettings& settings,
                                                       int group = 16, std::uint32_t first = 0,
                                                       const Vec3& origin = {0, 0, 0});

  /// @param shown  that_show() of the frame; none: the frame is empty. What is beyond the extent
  ///               is moved to its border
  /// @param time   seconds, more than that of the frame before
  /// @return the bytes of the frame, which follow those of the frame before
  /// @errors kInvalidInput: more splats than the grid has voxels; those of FrameEncoder::add
  Result<std::vector<std::uint8_t>, InputError> add(const Gaussians& shown, double time);

  const Grid& grid() const { return header_.grid; }  ///< from the world's origin
  double q() const { return q_; }

 private:
  GaussianFrameEncoder(LightFieldHeader header, const Grid& local, double q,
                       const EncoderSettings& settings, int group, std::uint32_t first);

  LightFieldHeader header_;  // of all frames, in the world
  Grid local_;               // the same grid from where positions are from
  double q_;
  int threads_;
  FrameEncoder encoder_;
};

}  // namespace slf
