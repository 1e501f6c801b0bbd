// SPDX-License-Identifier: Apache-2.0
// Fits without some of the cameras, and how they predict these: what settings are chosen by.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "encoder/fit/camera_folds.h"
#include "encoder/fit/environment_fit.h"
#include "encoder/fit/environment_prior.h"
#include "encoder/fit/fit_hierarchical.h"
#include "slf/fit.h"

namespace slf {

/// Some of the points, with what was seen of them in world directions.
struct FoldSample {
  std::vector<Voxel> positions;
  MirrorPoints points;
  Observations seen;
};

/// Whole blocks, every n-th: the sums of a block stay what they are. Blocks beside it are missing
/// more often than not, so that less is interpolated.
FoldSample sample_blocks(const PointwiseObservations& seen, std::span<const Voxel> positions,
                         const MirrorPoints& points, int block_log2, std::size_t about);

/// The observations of one fold, or of all others.
Observations of_fold(const Observations& seen, const CameraFolds& folds, int fold, bool others);

struct FoldError {
  double squared = 0;
  std::size_t samples = 0;

  double mean() const { return samples > 0 ? squared / static_cast<double>(samples) : 0; }
};

double mean(const std::vector<FoldError>& of_fold);

class FoldFit;

/// Fits without each fold, of one kind of directions and one basis.
class FoldTrial {
 public:
  /// @param lights  of the other folds
  /// @param project  the light as functions of the basis, as a decoder has it; slow
  FoldTrial(const FoldSample& sample, const CameraFolds& folds,
            const std::vector<std::optional<Environment>>& lights, bool project,
            const FitSettings& settings);
  ~FoldTrial();

  /// [tried][fold]; see HierarchicalFit::solve_points.
  std::vector<std::vector<FoldError>> errors(std::span<const HierarchySettings> tried) const;
  std::vector<FoldError> errors(const HierarchySettings& tried) const {
    return errors(std::span(&tried, 1)).front();
  }

 private:
  std::vector<std::unique_ptr<FoldFit>> fits_;
};

}  // namespace slf
