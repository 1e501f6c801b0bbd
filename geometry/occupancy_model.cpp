#include "geometry/occupancy_model.h"

namespace slf {

OccupancyStates::OccupancyStates(std::uint64_t points)
    : hashed_bits(
          std::min(kMostHashedBits, std::max(static_cast<int>(std::bit_width(points)) + 4, 10))),
      faces(std::size_t{1} << kFacesBits),
      corner(std::size_t{1} << kCornerBits) {
  for (auto& contexts : hashed) contexts.resize(std::size_t{1} << hashed_bits);
}

}  // namespace slf
