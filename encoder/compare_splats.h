// SPDX-License-Identifier: Apache-2.0
// Splats against the surfaces that a capture may be coded by.
#pragma once

#include <cstdint>
#include <span>

#include "encoder/judge_surface.h"
#include "encoder/refine/held_out.h"
#include "encoder/train/training_cache.h"
#include "slf/encoder.h"

namespace slf {

/// What a surface is chosen of and by.
struct SurfaceChoice {
  const Capture& capture;
  std::span<const int> cameras;
  const EncoderSettings& settings;
  SurfaceReport& report;
  const Progress& progress;
  TrainingCache& cache;
  bool splats;  // they may be chosen
};

/// A surface after a quick fit to some photographs, by the others.
Result<DrawnQuality, InputError> judged(const SurfaceChoice& job, const CameraParts& parts,
                                        const VoxelCloud& cloud);

/// A file of splats, of some photographs, judged by the others: once a capture.
Result<Done, InputError> try_splats_once(const SurfaceChoice& job, const CameraParts& parts);

/// Whether the file of splats that was tried, or one of more of them, is worth more than one of the
/// best surface, which is made as well, unless a quick fit says so already.
/// @param quick  of the surface, after a quick fit
Result<bool, InputError> splats_are_better(const SurfaceChoice& job, const CameraParts& parts,
                                           const VoxelCloud& surface, const DrawnQuality& quick);

/// Points that lie where photographs agree are left alone, but for things that are thin or let
/// light through: there splats that are trained for a moment draw photographs almost as well as a
/// quick fit, or better.
Result<bool, InputError> exact_yields(const SurfaceChoice& job, const VoxelCloud& exact);

/// Photographs that agree nowhere with a surface that was trained.
Result<Done, InputError> find_foreign(const SurfaceChoice& job, const PointCloud& trained);

/// Whether splats leave nothing to find out: nothing brings dense points near them.
/// @param quick  of the points, after a quick fit
Result<bool, InputError> splats_are_beyond(const SurfaceChoice& job, const CameraParts& parts,
                                           const DrawnQuality& quick);

}  // namespace slf
