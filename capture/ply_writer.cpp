// SPDX-License-Identifier: Apache-2.0
// A point cloud as a binary little endian PLY.
#include <algorithm>
#include <bit>
#include <string>

#include "base/huge_pages.h"
#include "slf/capture.h"

namespace slf {

namespace {

/// Little endian; where it ends.
template <class Bits>
std::uint8_t* put(std::uint8_t* to, Bits bits) {
  for (std::size_t i = 0; i < sizeof(Bits); ++i) to[i] = static_cast<std::uint8_t>(bits >> 8 * i);
  return to + sizeof(Bits);
}
std::uint8_t* put(std::uint8_t* to, float value) {
  return put(to, std::bit_cast<std::uint32_t>(value));
}
std::uint8_t* put(std::uint8_t* to, double value) {
  return put(to, std::bit_cast<std::uint64_t>(value));
}

}  // namespace

Result<Done, InputError> write_ply(const std::filesystem::path& file, const PointCloud& cloud) {
  const std::size_t count = cloud.positions.size();
  const bool normals = !cloud.normals.empty(), colours = !cloud.colours.empty();
  if ((normals && cloud.normals.size() != count) || (colours && cloud.colours.size() != count))
    return InputError{Errc::kInvalidArgument,
                      file.string() + ": as many normals and colours as positions are needed"};
  const bool exact = cloud.origin != Vec3{0, 0, 0};
  std::string header =
      "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(count) + "\n";
  for (const char* axis : {"x", "y", "z"})
    header += std::string("property ") + (exact ? "double " : "float ") + axis + "\n";
  if (normals) header += "property float nx\nproperty float ny\nproperty float nz\n";
  if (colours) header += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  header += "end_header\n";

  std::vector<std::uint8_t> out;
  const std::size_t row = (exact ? 24u : 12u) + (normals ? 12u : 0u) + (colours ? 3u : 0u);
  reserve_large(out, header.size() + count * row);
  out.assign(header.begin(), header.end());
  out.resize(header.size() + count * row);
  std::uint8_t* to = out.data() + header.size();
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const float value = cloud.positions[i][k];
      to = exact ? put(to, cloud.origin[k] + double{value}) : put(to, value);
    }
    if (normals)
      for (const float value : cloud.normals[i]) to = put(to, value);
    if (colours) to = std::copy(cloud.colours[i].begin(), cloud.colours[i].end(), to);
  }
  return write_file(file, out.data(), out.size());
}

}  // namespace slf
