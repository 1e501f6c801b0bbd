// SPDX-License-Identifier: Apache-2.0
#include "slf/surface.h"

namespace slf {

const char* word_of(Surface surface) {
  switch (surface) {
    case Surface::kGiven:
      return "given";
    case Surface::kMended:
      return "mended";
    case Surface::kTrained:
      return "trained";
    case Surface::kAuto:
      return "auto";
    case Surface::kSplats:
      return "splats";
  }
  return "";
}

const char* word_of(StartId start) {
  return start == StartId::kPoints ? "points" : start == StartId::kHull ? "hull" : "volume";
}

}  // namespace slf
