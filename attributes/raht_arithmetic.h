// SPDX-License-Identifier: Apache-2.0
// The arithmetic of a merge, both ways. Spec 8.6.2.
#pragma once

#include <cstdint>

#include "attributes/four_values.h"
#include "attributes/raht_tree.h"

namespace slf {

/// The butterfly of a merge, of both rows in one plane: values of left and right to the sum, which
/// stays in the left row, and the difference.
inline void forward_merge(const Merge& m, std::int32_t& left, std::int32_t& right) {
  const std::int32_t a = left, b = right;
  left = rounded<30>(product(a, m.cos_q30) + product(b, m.sin_q30));
  right = rounded<30>(product(b, m.cos_q30) - product(a, m.sin_q30));
}

/// And back. Spec 8.8.1.
template <class Values>
SLF_IN_LINE void inverse_merge(const Merge& m, Values sum, Values difference, Values& left,
                               Values& right) {
  const Values cosine = m.cos_q30, sine = m.sin_q30;
  left = rounded<30>(product(sum, cosine) - product(difference, sine));
  right = rounded<30>(product(sum, sine) + product(difference, cosine));
}

}  // namespace slf
