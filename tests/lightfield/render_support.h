// SPDX-License-Identifier: Apache-2.0
// Light fields made by hand, of one colour per point.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "slf/capture.h"
#include "slf/types.h"

namespace slf::test {

/// One function per point: the constant. Colours are exact to 1/16 grey level.
inline LightField constant_light_field(const std::vector<Voxel>& positions,
                                       const std::vector<std::array<int, 3>>& colours, int bits,
                                       double step = 1) {
  LightField field;
  field.header.grid = {{0, 0, 0}, step, bits};
  field.header.basis = {BasisId::kBspline, 2, 0, 0};
  field.header.num_functions = 1;
  field.header.shift = {4};
  field.positions = positions;
  for (std::size_t p = 0; p < positions.size(); ++p)
    for (const int c : colours[p % colours.size()]) field.components.push_back(c * 16);
  return field;
}

/// Voxels of the plane z = `depth`, side x side of them.
inline std::vector<Voxel> plane(int side, int depth) {
  std::vector<Voxel> voxels;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) voxels.push_back({x, y, depth});
  return voxels;
}

/// Voxels within half a voxel of a sphere.
inline std::vector<Voxel> sphere(int centre, double radius) {
  std::vector<Voxel> voxels;
  const int reach = static_cast<int>(radius) + 2;
  for (int z = -reach; z <= reach; ++z)
    for (int y = -reach; y <= reach; ++y)
      for (int x = -reach; x <= reach; ++x)
        if (std::abs(std::sqrt(double(x * x + y * y + z * z)) - radius) <= 0.5)
          voxels.push_back({centre + x, centre + y, centre + z});
  return voxels;
}

/// Looks along +z from `distance` in front of z = 0, centred on (x, y); at z = 0 a world unit is
/// `pixels_per_unit` pixels.
inline Camera frontal_camera(double x, double y, double distance, int size,
                             double pixels_per_unit) {
  Camera camera;
  camera.name = "frontal";
  camera.width = camera.height = size;
  camera.fx = camera.fy = pixels_per_unit * distance;
  camera.cx = camera.cy = size / 2.0;
  camera.translation = {-x, -y, distance};
  return camera;
}

}  // namespace slf::test
