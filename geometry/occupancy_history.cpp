#include "geometry/occupancy_history.h"

#include <algorithm>

namespace slf {

void OccupancyHistory::start_level(int level) {
  level_ = level;
  for (auto& latest : latest_) latest.assign(std::size_t{1} << std::min(2 * level, kSlotBits), 0);
}

}  // namespace slf
