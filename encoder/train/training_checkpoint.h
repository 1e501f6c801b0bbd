// SPDX-License-Identifier: Apache-2.0
// What a training needs to go on where it was interrupted, in a file.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "encoder/train/adam.h"
#include "encoder/train/grow_surfels.h"
#include "slf/error.h"
#include "slf/types.h"

namespace slf {

/// Before an iteration. What follows is the same as if it had never been written.
struct TrainingState {
  int iteration = 0;
  std::size_t drawn_views = 0;  ///< since surfels last split
  TrainedSurfels surfels;
  AdamState adam;
  SurfelUse use;
  std::vector<double> twists;  ///< CameraTwists::state()
};

/// A digest of settings, photographs and first surfels: another training is never gone on with.
using TrainingDigest = std::array<std::uint8_t, 32>;

/// One file of one training.
class TrainingCheckpoint {
 public:
  /// @param directory  made where it is not there, with the first write
  TrainingCheckpoint(std::filesystem::path directory, const TrainingDigest& digest);

  /// Nothing where there is no file, or it is damaged or of another training.
  /// @param iterations, twists  of the whole training; numbers of a state of twists
  std::optional<TrainingState> read(int iterations, std::size_t twists = 0) const;
  /// The file is there whole or as it was before.
  /// @errors kUnwritable
  Result<Done, InputError> write(const TrainingState& state) const;

  const std::filesystem::path& file() const { return file_; }

 private:
  std::filesystem::path directory_, file_;
  TrainingDigest digest_;
};

}  // namespace slf
