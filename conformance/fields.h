// SPDX-License-Identifier: Apache-2.0
// Deterministic light fields of integers.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "geometry/morton.h"
#include "slf/encoder.h"
#include "slf/types.h"

namespace slf::conformance {

/// xorshift64*: the same on every platform, unlike the distributions of <random>.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  std::uint32_t below(std::uint32_t n) {
    state_ ^= state_ >> 12;
    state_ ^= state_ << 25;
    state_ ^= state_ >> 27;
    return static_cast<std::uint32_t>((state_ * 2685821657736338717u >> 32) % n);
  }

 private:
  std::uint64_t state_;
};

inline std::vector<Voxel> sorted(std::vector<Voxel> voxels) {
  std::sort(voxels.begin(), voxels.end(),
            [](const Voxel& a, const Voxel& b) { return morton(a) < morton(b); });
  voxels.erase(std::unique(voxels.begin(), voxels.end()), voxels.end());
  return voxels;
}

/// A box of voxels at the origin.
inline std::vector<Voxel> lattice(std::int32_t nx, std::int32_t ny, std::int32_t nz) {
  std::vector<Voxel> voxels;
  for (std::int32_t z = 0; z < nz; ++z)
    for (std::int32_t y = 0; y < ny; ++y)
      for (std::int32_t x = 0; x < nx; ++x) voxels.push_back({x, y, z});
  return sorted(voxels);
}

/// Surface voxels of a sphere in the middle of the grid; every `thin`-th dropped at random.
/// radius: 0: as large as the grid
inline std::vector<Voxel> sphere(int bits, std::uint32_t thin = 0, std::int32_t radius = 0) {
  Random random(11);
  const std::int32_t side = 1 << bits, middle = side / 2 - 1, r = radius > 0 ? radius : middle;
  std::vector<Voxel> voxels;
  for (std::int32_t z = 0; z < side; ++z)
    for (std::int32_t y = 0; y < side; ++y)
      for (std::int32_t x = 0; x < side; ++x) {
        const std::int32_t d =
            (x - middle) * (x - middle) + (y - middle) * (y - middle) + (z - middle) * (z - middle);
        if (d <= r * r && d > (r - 1) * (r - 1) && (thin == 0 || random.below(thin) != 0))
          voxels.push_back({x, y, z});
      }
  return sorted(voxels);
}

/// Some thousand points of a surface: what a stream of many planes is decoded in a second for by
/// the text decoder.
inline std::vector<Voxel> small_sphere() { return sphere(5, 0, 10); }

inline std::vector<Voxel> scattered(std::size_t count, int bits, std::uint64_t seed) {
  Random random(seed);
  std::vector<Voxel> voxels;
  for (std::size_t i = 0; i < count; ++i) {
    Voxel v;
    for (auto& c : v) c = static_cast<std::int32_t>(random.below(1u << bits));
    voxels.push_back(v);
  }
  return sorted(voxels);
}

/// A stair of voxels, and voxels later in order whose nodes at `level` have the entries of a
/// history table of 2^18 that nodes of the stair have, if entries are hashed (spec 8.4.3).
inline std::vector<Voxel> colliding_voxels(int level) {
  const std::uint32_t side = 1u << level;
  const auto entry = [](std::uint32_t a, std::uint32_t b) {
    return (a * 2654435761u ^ b * 2246822519u) >> 14;
  };
  std::vector<Voxel> voxels;
  const auto add = [&](std::uint32_t x, std::uint32_t y, std::uint32_t z, std::uint32_t child) {
    voxels.push_back({static_cast<std::int32_t>(2 * x + child % 2),
                      static_cast<std::int32_t>(2 * y + child / 2 % 2),
                      static_cast<std::int32_t>(2 * z + child / 4)});
  };
  std::vector<std::uint32_t> of_stair(1u << 18);  // 1 + step
  const std::uint32_t steps = side / 4, most = 60;
  for (std::uint32_t i = 0; i < steps; ++i) of_stair[entry(i, i)] = i + 1;
  for (std::uint32_t b = side / 2, found = 0; b < side && found < most; ++b)
    for (std::uint32_t a = side / 2; a < side && found < most; ++a)
      if (const std::uint32_t step = of_stair[entry(a, b)]; step > 0) {
        for (std::uint32_t child = 0; child < 3; ++child) add(step - 1, step - 1, step - 1, child);
        add(a, b, side - 1 - found, 7);
        ++found;
      }
  return sorted(std::move(voxels));
}

/// A mean that varies over the surface, functions that fade, and some noise.
inline LightField field(std::vector<Voxel> voxels, int bits, int functions,
                        std::int32_t size = 8000) {
  Random random(5);
  LightField f;
  f.header.grid = {{0, 0, 0}, 1, bits};
  f.header.has_basis = false;
  f.header.num_functions = functions;
  f.positions = std::move(voxels);
  for (const Voxel& v : f.positions)
    for (int k = 0; k < functions; ++k)
      for (int c = 0; c < 3; ++c) {
        const std::int32_t wave = (v[0] * (k + 3) * 7 + v[1] * (c + 2) * 5 + v[2] * 3) % 64 - 32;
        const auto noise = static_cast<std::int32_t>(random.below(65)) - 32;
        f.components.push_back(k == 0 ? size * wave / 32 + noise
                                      : (size / 8 * wave / 32 + noise) / (k + c));
      }
  return f;
}

inline CodingParameters with_steps(int functions, std::uint32_t step) {
  CodingParameters parameters;
  for (int k = 0; k < functions; ++k) parameters.step.push_back({step, step, step});
  return parameters;
}

}  // namespace slf::conformance
