// Quantisation of transform coefficients against the prediction a decoder will make: a closed loop,
// level by level. Mirror of raht_inverse. Informative.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "attributes/coefficient_decoder.h"
#include "attributes/raht_tree.h"
#include "attributes/transform_levels.h"

namespace slf {

struct QuantiserInput {
  const RahtTree& tree;
  std::span<const std::uint64_t> morton;  ///< of the slice's points
  int depth = 0;                          ///< of the slice
  const PlaneGroups& groups;
  std::span<const std::uint32_t> steps;  ///< [planes]
  bool predict = false;
  double rdo = 0;  ///< 0 .. 1
};

struct Quantised {
  std::vector<std::vector<std::uint8_t>> modes;  ///< [groups][levels] cu_prediction
  std::vector<std::int32_t> values;              ///< [P][planes] what a decoder gets
};

/// @param coefficients  [P][planes] of raht_forward; replaced by quantised values.
/// The same result for any number of threads. O(P * planes), several times that with prediction.
Quantised quantise_coefficients(const QuantiserInput& input, std::span<std::int32_t> coefficients,
                                int threads);

}  // namespace slf
