#include "geometry/occupancy_states.h"

namespace slf {

OccupancyStates::OccupancyStates(std::uint64_t points)
    : hashed_bits(hashed_bits_of(points)),
      corner(Corner::kCount),
      beside(Places::kCount),
      latest(Places::kCount),
      rows(kRows) {
  for (auto& contexts : hashed) contexts.resize(std::size_t{1} << hashed_bits);
}

}  // namespace slf
