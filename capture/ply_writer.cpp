// A point cloud as a binary little endian PLY.
#include <bit>
#include <string>

#include "slf/capture.h"

namespace slf {

namespace {

void put(std::vector<std::uint8_t>& out, float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  for (int shift = 0; shift < 32; shift += 8)
    out.push_back(static_cast<std::uint8_t>(bits >> shift));
}

void put(std::vector<std::uint8_t>& out, double value) {
  const auto bits = std::bit_cast<std::uint64_t>(value);
  for (int shift = 0; shift < 64; shift += 8)
    out.push_back(static_cast<std::uint8_t>(bits >> shift));
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

  std::vector<std::uint8_t> out(header.begin(), header.end());
  out.reserve(header.size() +
              count * ((exact ? 24u : 12u) + (normals ? 12u : 0u) + (colours ? 3u : 0u)));
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const float value = cloud.positions[i][k];
      if (exact)
        put(out, cloud.origin[k] + double{value});
      else
        put(out, value);
    }
    if (normals)
      for (const float value : cloud.normals[i]) put(out, value);
    if (colours) out.insert(out.end(), cloud.colours[i].begin(), cloud.colours[i].end());
  }
  return write_file(file, out.data(), out.size());
}

}  // namespace slf
