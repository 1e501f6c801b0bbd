// SPDX-License-Identifier: Apache-2.0
#include "tools/synth/disturb.h"

#include <array>
#include <cmath>
#include <numbers>

#include "tools/synth/vec.h"

namespace slf::synth {
namespace {

constexpr double kHullScale = 30;  // spacings over which the push changes

/// splitmix64 (Steele, Lea, Flood 2014): a stream of numbers from one seed, the same everywhere.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  double uniform() {  ///< above 0, at most 1
    state_ += 0x9e3779b97f4a7c15u;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return static_cast<double>(((z ^ (z >> 31)) >> 11) + 1) * 0x1p-53;
  }
  double gaussian() {  ///< Box-Muller
    const double radius = std::sqrt(-2 * std::log(uniform()));
    return radius * std::cos(2 * std::numbers::pi * uniform());
  }

 private:
  std::uint64_t state_;
};

/// A function of place of mean 0 and variance 1, about Gaussian, that changes over `scale`: waves
/// of random direction, length and phase (Rahimi and Recht 2007).
class SmoothNoise {
 public:
  SmoothNoise(Random& random, double scale) {
    for (Wave& wave : waves_) {
      for (double& k : wave.k) k = random.gaussian() / scale;
      wave.phase = 2 * std::numbers::pi * random.uniform();
    }
  }
  double at(const Vec3& x) const {
    double sum = 0;
    for (const Wave& wave : waves_) sum += std::cos(dot(wave.k, x) + wave.phase);
    return sum * std::sqrt(2.0 / static_cast<double>(waves_.size()));
  }

 private:
  struct Wave {
    Vec3 k{};
    double phase = 0;
  };
  std::array<Wave, 48> waves_;
};

}  // namespace

void disturb(PointCloud& cloud, double spacing, const DisturbSettings& settings) {
  Random random(settings.seed);
  const SmoothNoise hull(random, kHullScale * spacing);
  const double scale = settings.noise_scale > 0 ? settings.noise_scale : 1;
  const SmoothNoise smooth(random, scale * spacing);
  for (std::size_t p = 0; p < cloud.positions.size(); ++p) {
    auto& position = cloud.positions[p];
    const Vec3 at{position[0], position[1], position[2]};
    // From about 2 standard deviations below the mean, nothing, to 2 above, all.
    double offset = settings.hull * smoothstep(-2, 2, hull.at(at));
    offset += settings.noise * (settings.noise_scale > 0 ? smooth.at(at) : random.gaussian());
    for (std::size_t a = 0; a < 3; ++a)
      position[a] =
          static_cast<float>(at[a] + spacing * offset * static_cast<double>(cloud.normals[p][a]));
  }
  cloud.normals.clear();
}

}  // namespace slf::synth
