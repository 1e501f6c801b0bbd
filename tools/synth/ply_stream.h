// SPDX-License-Identifier: Apache-2.0
// A point cloud file that is written piece by piece.
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>

#include "slf/capture.h"

namespace slf::synth {

/// Binary little endian, with normals and colours, as write_ply has it: to a temporary name beside
/// `file`, renamed once it is whole. What is not finished is removed.
class PlyStream {
 public:
  explicit PlyStream(std::filesystem::path file);
  ~PlyStream();
  PlyStream(const PlyStream&) = delete;
  PlyStream& operator=(const PlyStream&) = delete;

  /// @param cloud  with normals and colours; its origin is 0
  void append(const PointCloud& cloud);
  /// @errors kUnwritable: the file, or a piece of it before.
  Result<Done, InputError> finish();

 private:
  struct Close {
    void operator()(std::FILE* open) const { std::fclose(open); }
  };
  bool put(const void* data, std::size_t size);

  std::filesystem::path file_, temporary_;
  std::unique_ptr<std::FILE, Close> open_;
  std::uint64_t points_ = 0;
  int failed_ = 0;  ///< errno of the first failure
};

}  // namespace slf::synth
