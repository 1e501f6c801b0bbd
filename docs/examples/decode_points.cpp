// SPDX-License-Identifier: Apache-2.0
// Decodes an .slf file and prints where a point lies and what colour it has seen from a direction.
//
//   decode_points FILE [POINT X Y Z]     POINT: its number; X Y Z: towards the eye, any length
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <vector>

#include "slf/decoder.h"
#include "slf/view_map.h"

int main(int argc, char** argv) {
  if (argc != 2 && argc != 6) {
    std::fprintf(stderr, "usage: decode_points FILE [POINT X Y Z]\n");
    return 2;
  }
  std::ifstream file(argv[1], std::ios::binary);
  const std::vector<char> bytes((std::istreambuf_iterator<char>(file)),
                                std::istreambuf_iterator<char>());
  const auto* first = reinterpret_cast<const std::uint8_t*>(bytes.data());

  const auto field = slf::decode({first, bytes.size()});
  if (!field) {
    std::fprintf(stderr, "%s: %s\n", argv[1], slf::to_string(field.error()).c_str());
    return 4;
  }
  if (argc == 2) {
    std::printf("%zu points, %d functions of direction\n", field->num_points(),
                field->header.num_functions);
    return 0;
  }
  const auto point = static_cast<std::size_t>(std::strtoull(argv[2], nullptr, 10));
  const auto maps = slf::ViewMaps::of(*field);  // once; then every radiance costs a few fetches
  if (!maps || point >= field->num_points()) {
    std::fprintf(stderr, "%s: no such point, or no colours\n", argv[1]);
    return 4;
  }
  const auto [theta, gamma] =
      slf::direction_of({std::atof(argv[3]), std::atof(argv[4]), std::atof(argv[5])});
  const auto rgb = maps->radiance(point, theta, gamma);
  const slf::Vec3 at = field->header.grid.world(field->positions[point]);
  std::printf("%.10g %.10g %.10g  %.3f %.3f %.3f\n", at[0], at[1], at[2],
              static_cast<double>(rgb[0]), static_cast<double>(rgb[1]),
              static_cast<double>(rgb[2]));
  return 0;
}
