// The points of a scene on its grid, in Morton order, in files: what slices read their points from.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "slf/capture.h"

namespace slf {

/// Points first .. first + size - 1 of a scene.
struct StoredPoints {
  std::vector<std::uint64_t> codes;           ///< Morton, ascending
  std::vector<std::array<float, 3>> normals;  ///< or empty
  std::vector<std::array<float, 3>> colours;  ///< or empty, 0 .. 255
};

/// Files of one machine type: raw arrays, checked by their size and by the digest beside them.
/// Thread-safe.
class PointStore {
 public:
  PointStore() = default;

  /// @return the digest: SHA-256 of all points, hexadecimal
  /// @errors kUnwritable
  static Result<std::string, InputError> write(const std::filesystem::path& directory,
                                               const VoxelCloud& cloud);

  /// @param digest  of the points that are wanted
  /// @errors kUnreadable: they are not there, or others are; kInvalidInput: not as many
  static Result<PointStore, InputError> open(const std::filesystem::path& directory,
                                             const std::string& digest, std::uint64_t points);

  std::uint64_t size() const { return points_; }
  /// @errors kUnreadable
  Result<std::vector<std::uint64_t>, InputError> codes(std::uint64_t first,
                                                       std::uint64_t count) const;
  Result<StoredPoints, InputError> read(std::uint64_t first, std::uint64_t count) const;

 private:
  PointStore(std::filesystem::path directory, std::uint64_t points)
      : directory_(std::move(directory)), points_(points) {}

  std::filesystem::path directory_;
  std::uint64_t points_ = 0;
  bool normals_ = false, colours_ = false;
};

}  // namespace slf
