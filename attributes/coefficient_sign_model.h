// SPDX-License-Identifier: Apache-2.0
// The sign of a value of a vector, predicted from the signs around it: an edge that runs on gives
// neighbouring differences the same sign, and the colours of a picture change together. Written
// once for decoder and encoder. Spec 8.7.2.
#pragma once

#include <array>
#include <cstdint>

#include "entropy/context_shape.h"
#include "entropy/mixed_bit.h"

namespace slf {

/// Values of one function in the rows around, channel by channel; all three exist.
struct SignEvidence {
  const std::int16_t* own;  ///< earlier channels of the value itself
  const std::int16_t* parent;
  const std::int16_t* grandparent;
  const std::int16_t* same_axis;  ///< the nearest above whose split is along the same axis
  std::array<const std::int16_t*, 3> faces;
  const std::int16_t* previous;
  std::uint32_t axis;     ///< 0 .. 2
  std::uint32_t channel;  ///< 0 .. 2
};

class CoefficientSignModel {
 public:
  /// Codes a sign, true for negative.
  template <class Coder>
  bool code(Coder& coder, const SignEvidence& e, bool negative) {
    const std::uint32_t c = e.channel;
    // Are the signs of an earlier channel and of channel c alike?
    const auto product = [c](const std::int16_t* values, std::uint32_t earlier) {
      return sign(values[earlier] * values[c] * (earlier < c));
    };
    const std::uint32_t own0 = sign(e.own[0]), own1 = sign(e.own[1]);
    const std::uint32_t parent = product(e.parent, 0), previous = product(e.previous, 0);
    const std::array<std::uint32_t, 4> contexts = {
        Above::index(own0, parent, product(e.grandparent, 0), previous, c),
        Faces::index(sign(e.faces[0][c]), sign(e.faces[1][c]), sign(e.faces[2][c]), e.axis, c),
        Channels::index(own0, own1, parent, product(e.parent, 1), product(e.previous, 1), c),
        Strong::index(strong_sign(e.same_axis[c]), strong_sign(e.parent[c]),
                      strong_sign(e.previous[c]), own0, e.axis, c)};
    return negative_.code(coder, contexts, Set::index(c, own0), negative) != 0;
  }

 private:
  /// 1: more than 0, 2: less.
  static std::uint32_t sign(std::int32_t value) {
    return static_cast<std::uint32_t>(value > 0) + 2 * static_cast<std::uint32_t>(value < 0);
  }
  static std::uint32_t strong_sign(std::int32_t value) {
    return sign(value) + 2 * static_cast<std::uint32_t>(value > 1 || value < -1);
  }

  using Above = ContextShape<3, 3, 3, 3, 3>;
  using Faces = ContextShape<3, 3, 3, 3, 3>;
  using Channels = ContextShape<3, 3, 3, 3, 3, 3>;
  using Strong = ContextShape<5, 5, 5, 3, 3, 3>;
  using Set = ContextShape<3, 3>;  // channel; the sign of the first
  MixedBit<Set::kCount, Above, Faces, Channels, Strong> negative_;
};

}  // namespace slf
