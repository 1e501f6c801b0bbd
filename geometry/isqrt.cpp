#include "geometry/isqrt.h"

#include <algorithm>
#include <cmath>

namespace slf {

std::uint64_t isqrt(std::uint64_t n) {
  constexpr std::uint64_t kMost = 0xFFFFFFFFu;
  // A guess, off by one at most; what it is made into does not depend on how it was rounded.
  auto root = std::min(static_cast<std::uint64_t>(std::sqrt(static_cast<double>(n))), kMost);
  while (root * root > n) --root;
  while (n - root * root > 2 * root) ++root;  // (root + 1)^2 <= n
  return root;
}

}  // namespace slf
