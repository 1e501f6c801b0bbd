// SPDX-License-Identifier: Apache-2.0
// The points of a scene on its grid, in Morton order, in files: what slices read their points from.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "capture/voxelise.h"
#include "slf/capture.h"

namespace slf {

/// Points first .. first + size - 1 of a scene.
struct StoredPoints {
  std::vector<std::uint64_t> codes;           ///< Morton, ascending
  std::vector<std::array<float, 3>> normals;  ///< or empty
  std::vector<std::array<float, 3>> colours;  ///< or empty, 0 .. 255
};

/// Raw arrays of one machine type, in files that are named after what is in them: processes and
/// plans share a directory. Thread-safe.
class PointStore {
 public:
  struct Written {
    std::string digest;  ///< of all points: 64 hexadecimal digits
    std::uint64_t points = 0;
  };

  PointStore() = default;

  using Take = std::function<void(const OccupiedVoxel&)>;
  /// @param give  gives all voxels in Morton order
  /// @param normals, colours  whether voxels have them
  /// @errors kUnwritable, those of give
  static Result<Written, InputError> write(
      const std::filesystem::path& directory, bool normals, bool colours,
      const std::function<Result<Done, InputError>(const Take&)>& give);

  /// @errors kUnreadable: they are not there; kInvalidInput: not as many
  static Result<PointStore, InputError> open(const std::filesystem::path& directory,
                                             const std::string& digest, std::uint64_t points);

  std::uint64_t size() const { return points_; }
  /// @errors kUnreadable
  Result<std::vector<std::uint64_t>, InputError> codes(std::uint64_t first,
                                                       std::uint64_t count) const;
  Result<StoredPoints, InputError> read(std::uint64_t first, std::uint64_t count) const;

 private:
  std::filesystem::path codes_, normals_, colours_;  // empty where there are none
  std::uint64_t points_ = 0;
};

}  // namespace slf
