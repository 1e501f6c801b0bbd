// SPDX-License-Identifier: Apache-2.0
// Settings that go with the capture, by the rules of `slf encode` (tools/verb_encode.cpp).
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "failure.h"
#include "slf/settings.h"

namespace slf::python {

/// Points alone cannot be mended or trained: a setting that changes nothing is refused.
/// @throws Failure  names the option and, where not all are wrong, the value
inline void check_photographs(const std::vector<int>& cameras, const GivenSettings& given) {
  if (!cameras.empty()) return;
  constexpr std::array<std::string_view, 4> kOfPhotographs = {
      "splats", "surface-seconds", "surface-memory", "photograph-pixels"};
  const auto refused = [](const std::string& option) {
    return failure_of(InputError{Errc::kInvalidArgument,
                                 option + " is for photographs, and the capture has none"});
  };
  for (const auto& [name, value] : given) {
    if (name == "surface" && value != "given" && value != "auto")
      throw refused("--surface " + value);
    if ((name == "match-exposure" || name == "refine-cameras") && value == "on")
      throw refused("--" + name + " on");
    if (std::find(kOfPhotographs.begin(), kOfPhotographs.end(), name) != kOfPhotographs.end())
      throw refused("--" + name);
  }
}

}  // namespace slf::python
