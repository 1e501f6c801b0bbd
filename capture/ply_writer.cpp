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

}  // namespace

Result<Done, InputError> write_ply(const std::filesystem::path& file, const PointCloud& cloud) {
  const std::size_t count = cloud.positions.size();
  const bool normals = !cloud.normals.empty(), colours = !cloud.colours.empty();
  if ((normals && cloud.normals.size() != count) || (colours && cloud.colours.size() != count))
    return InputError{Errc::kInvalidArgument,
                      file.string() + ": as many normals and colours as positions are needed"};
  std::string header = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                       std::to_string(count) +
                       "\nproperty float x\nproperty float y\nproperty float z\n";
  if (normals) header += "property float nx\nproperty float ny\nproperty float nz\n";
  if (colours) header += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  header += "end_header\n";

  std::vector<std::uint8_t> out(header.begin(), header.end());
  out.reserve(header.size() + count * (12 + (normals ? 12u : 0u) + (colours ? 3u : 0u)));
  for (std::size_t i = 0; i < count; ++i) {
    for (const float value : cloud.positions[i]) put(out, value);
    if (normals)
      for (const float value : cloud.normals[i]) put(out, value);
    if (colours) out.insert(out.end(), cloud.colours[i].begin(), cloud.colours[i].end());
  }
  return write_file(file, out.data(), out.size());
}

}  // namespace slf
