#include "geometry/draco_decoder.h"

#if SLF_WITH_DRACO
#include <draco/compression/decode.h>
#include <draco/point_cloud/point_cloud.h>
#endif

namespace slf {

#if SLF_WITH_DRACO
Result<std::vector<Voxel>> decode_draco(std::span<const std::uint8_t> payload, int bits,
                                        std::uint64_t max_points) {
  const Error damaged{Errc::kOutOfRange, "gu_draco", 0};
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(payload.data()), payload.size());
  // Draco allocates by the count at byte 11 of its header before it looks for the points.
  if (payload.size() < 15) return damaged;
  const std::uint32_t count = payload[11] | std::uint32_t{payload[12]} << 8 |
                              std::uint32_t{payload[13]} << 16 | std::uint32_t{payload[14]} << 24;
  if (count > max_points) return damaged;
  const auto type = draco::Decoder::GetEncodedGeometryType(&buffer);
  if (!type.ok() || type.value() != draco::POINT_CLOUD) return damaged;
  draco::Decoder decoder;
  auto decoded = decoder.DecodePointCloudFromBuffer(&buffer);
  if (!decoded.ok() || decoded.value() == nullptr) return damaged;
  const draco::PointCloud& cloud = *decoded.value();
  const draco::PointAttribute* position =
      cloud.GetNamedAttribute(draco::GeometryAttribute::POSITION);
  if (position == nullptr || position->num_components() != 3 ||
      position->data_type() != draco::DT_UINT32 || cloud.num_points() > max_points)
    return damaged;
  std::vector<Voxel> voxels(cloud.num_points());
  for (std::uint32_t i = 0; i < cloud.num_points(); ++i) {
    std::uint32_t xyz[3];
    if (!position->ConvertValue<std::uint32_t>(position->mapped_index(draco::PointIndex(i)), 3,
                                               xyz))
      return damaged;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (xyz[axis] >> bits != 0) return damaged;
      voxels[i][axis] = static_cast<std::int32_t>(xyz[axis]);
    }
  }
  return voxels;
}
#else
Result<std::vector<Voxel>> decode_draco(std::span<const std::uint8_t>, int, std::uint64_t) {
  return Error{Errc::kUnsupported, "sps_geometry_coder", 0};
}
#endif

}  // namespace slf
