// SPDX-License-Identifier: Apache-2.0
#include "encoder/encode_warnings.h"

#include <algorithm>

namespace slf {
namespace {

constexpr std::size_t kMany = 4;         // one in so many
constexpr std::size_t kHardlyAny = 500;  // points of which one is seen

}  // namespace

std::string left_out_warning(std::size_t left_out, std::size_t points) {
  return std::to_string(left_out) + " of " + std::to_string(points) +
         " points lie outside of the object that the photographs show, and are left out";
}

void warn_of_cameras(std::span<const CameraTrust> cameras, std::size_t used, const Capture& capture,
                     std::vector<std::string>& warnings) {
  std::size_t dropped = 0;
  for (const CameraTrust& trust : cameras) {
    dropped += trust.verdict == CameraVerdict::kDropped;
    if (trust.verdict != CameraVerdict::kKept)
      warnings.push_back(capture.cameras[std::size_t(trust.camera)].name + ": " + reason_of(trust));
  }
  if (dropped > 0 && dropped * kMany >= used)
    warnings.push_back(std::to_string(dropped) + " of " + std::to_string(used) +
                       " photographs are dropped: poses may be mirrored, or of another capture");
}

Result<Done, InputError> check_unseen(std::size_t unseen, std::size_t points,
                                      std::vector<std::string>& warnings) {
  const std::size_t seen = points - unseen;
  const std::string few =
      "photographs show " + std::to_string(seen) + " of " + std::to_string(points) + " points: ";
  if (seen * kHardlyAny < points)
    return InputError{Errc::kInvalidInput,
                      few + "masks may be inverted, or points of another place or world"};
  if (seen < points / 2) warnings.push_back(few + "colours of the others are made up");
  return Done{};
}

}  // namespace slf
