// SPDX-License-Identifier: Apache-2.0
// Photographs to splats: what EncoderSettings::surface kSplats asks for.
#pragma once

#include <cstddef>
#include <span>

#include "encoder/train/train_geometry.h"
#include "encoder/train/training_cache.h"
#include "slf/encoder.h"
#include "slf/gaussians.h"

namespace slf {

/// The training of poses: splats, as many as the photographs resolve.
TrainGeometrySettings pose_training_of(const EncoderSettings& settings, StartId start);

/// The training of the first of several frames.
TrainGeometrySettings training_of_frames(const EncoderSettings& settings);

/// With the step and the share of rate that splats have which photographs train, where no other is
/// given.
EncoderSettings coding_of_splats(EncoderSettings settings);

/// What splats are tried with.
struct SplatJob {
  const Capture& capture;
  StartId start;  ///< where the capture's points are from
  std::span<const int> fitted, held_out;
  const EncoderSettings& settings;
  const Progress& progress;
  TrainingCache& cache;  ///< of the capture
};

/// A file of splats of some cameras, for others.
/// @errors those of train_gaussians, encode_gaussians and load_image
Result<SplatTrial, InputError> try_splats(const SplatJob& job);

/// The same after few iterations.
Result<TrialFile, InputError> glance_at_splats(const SplatJob& job);

/// Whether photographs may say how many there are: no setting does.
bool is_number_open(const EncoderSettings& settings);

/// How many splats are worth their bytes, found once a capture: trials of more and more of them go
/// on as long as photographs that they have not seen gain.
/// @errors those of try_splats
Result<Done, InputError> find_splats_that_pay(const SplatJob& job);

/// Whether no setting asks for what only a surface has, or for bytes that splats take another way.
bool may_be_splats(const EncoderSettings& settings);

/// Whether splats are so much better than the best surface after a quick fit, at no more bytes,
/// that no fit makes it up.
/// @param points  of that surface
bool splats_win(const SurfaceReport& report, std::size_t points);

/// As many splats as settings say; a target in bytes has no more than it has room for at the usual
/// step. Else photographs say how many: trials of more and more of them are files of three quarters
/// of the photographs, and the others judge whether more are worth their bytes.
/// @param start  where the capture's points are from
/// @param cache  of the capture
/// @errors kInvalidInput: photographs train nothing; those of train_gaussians, encode_gaussians
Result<Encoded, InputError> encode_splats(const Capture& capture, StartId start,
                                          std::span<const int> cameras,
                                          const EncoderSettings& settings, const Progress& progress,
                                          TrainingCache& cache);

}  // namespace slf
