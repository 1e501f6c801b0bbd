#include "geometry/occupancy_model.h"

namespace slf {
OccupancyModel::OccupancyModel(std::uint64_t points)
    : faces_(std::size_t{1} << kFacesBits), corner_(std::size_t{1} << kCornerBits) {
  const int useful = std::max(static_cast<int>(std::bit_width(points)) + 4, 10);
  hashed_bits_ = std::min(kMostHashedBits, useful);
  for (auto& contexts : hashed_) contexts.resize(std::size_t{1} << hashed_bits_);
}

}  // namespace slf
