// SPDX-License-Identifier: Apache-2.0
// What the codes weigh over which a transform tree stands: points 1, cells of a base their classes.
// Spec 8.2.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace slf {

/// By default every code weighs 1.
class CodeWeights {
 public:
  CodeWeights() = default;
  /// before: [codes + 1] what the codes before each weigh together, 0 first: ascending, at most
  /// 2^24. Kept by reference.
  explicit CodeWeights(std::span<const std::uint32_t> before) : before_(before) {}

  /// Weight of codes begin .. end - 1 together.
  std::uint32_t of(std::size_t begin, std::size_t end) const {
    return before_.empty() ? static_cast<std::uint32_t>(end - begin)
                           : before_[end] - before_[begin];
  }
  std::uint32_t of(std::size_t code) const { return of(code, code + 1); }

 private:
  std::span<const std::uint32_t> before_;
};

}  // namespace slf
