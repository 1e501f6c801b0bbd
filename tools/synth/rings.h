// SPDX-License-Identifier: Apache-2.0
// The paper's camera arrangement: circles around the object, evenly spaced in height.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "slf/capture.h"

namespace slf::synth {

struct Rings {
  std::vector<Camera> cameras;                     ///< those that a split names, by number
  std::vector<int> circle, index;                  ///< [cameras]
  std::map<std::string, std::vector<int>> splits;  ///< indices into cameras, ascending
};

/// `circles` x `per_circle` cameras on a sphere around the origin, all looking at it, such that a
/// ball of `radius` fits into the image. Image number = per_circle * circle + index + 1.
/// Splits (paper Table II): dense is every second camera of the odd circles, intermediate 13 each
/// of three circles, sparse 7 each of two. evaluation is what is in none of these, thinned to 100
/// evenly chosen cameras: the paper's 425 would take three times as long and say the same.
/// Fewer than 5 circles, or fewer than 14 cameras on each, have no room for these splits: they are
/// even rings.
Rings make_rings(int circles, int per_circle, int width, int height, double radius);
/// The same circles, all of their cameras: every fourth is "evaluation", the others are "dense".
Rings make_even_rings(int circles, int per_circle, int width, int height, double radius);

}  // namespace slf::synth
