// SPDX-License-Identifier: Apache-2.0
// Units of a light field that does not move, as its bytes come. Spec 7.1, 8.9.
#pragma once

#include <cstdint>
#include <span>

#include "bitstream/units.h"
#include "slf/error.h"
#include "slf/limits.h"

namespace slf {

/// Looks at each unit once, when it is whole.
class ArrivingUnits {
 public:
  /// @param bytes  of the stream so far, from its first on
  /// @param ended  none follow
  /// @errors those of split_units, the first of the stream, when its unit has come
  Result<Done> take(std::span<const std::uint8_t> bytes, bool ended);

  /// Signature and units that have come whole: what can be decoded.
  std::uint64_t bytes() const { return walk_.at(); }
  /// The slices unit, last of those that say what is coded, is there.
  bool has_headers() const { return has_headers_; }
  bool complete() const { return walk_.complete(); }

 private:
  UnitWalk walk_{DecodeLimits{}.max_memory};
  std::uint64_t needed_ = 0;  // bytes without which there is no other unit
  bool has_headers_ = false;
};

}  // namespace slf
