// SPDX-License-Identifier: Apache-2.0
#include "attributes/kept_means.h"

#include <algorithm>

#include "attributes/level_prediction.h"
#include "attributes/raht_arithmetic.h"
#include "attributes/weight_roots.h"

namespace slf {

void keep_means(std::span<const std::int32_t> values, std::span<const std::uint32_t> rows,
                std::span<const NodePlace> places, std::size_t planes, std::size_t begin,
                std::size_t end, std::vector<std::int32_t>& means) {
  for (std::size_t n = 0; n < places.size(); ++n)
    node_means(&values[rows[n] * planes + begin], places[n].weight, &means[n * planes + begin],
               end - begin);
}

std::int32_t predicted_root(std::int32_t mean, std::uint32_t weight) {
  return static_cast<std::int32_t>(
      rounded<19>(std::int64_t{mean} * roots_of(small_roots(), weight).root_q19));
}

void predict_root(std::span<const std::int32_t> means, std::size_t points,
                  std::span<std::int32_t> row) {
  for (std::size_t j = 0; j < row.size(); ++j)
    row[j] = std::clamp(row[j] + predicted_root(means[j], static_cast<std::uint32_t>(points)),
                        -kPredictedLimit, kPredictedLimit);
}

}  // namespace slf
