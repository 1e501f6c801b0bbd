// SPDX-License-Identifier: Apache-2.0
#include "geometry/encoder/draco_encoder.h"

#if SLF_WITH_DRACO
#include <draco/compression/encode.h>
#include <draco/point_cloud/point_cloud.h>
#endif

namespace slf {

#if SLF_WITH_DRACO
std::optional<std::vector<std::uint8_t>> encode_draco(std::span<const Voxel> positions) {
  const auto count = static_cast<std::uint32_t>(positions.size());
  draco::PointCloud cloud;
  cloud.set_num_points(count);
  draco::GeometryAttribute attribute;
  attribute.Init(draco::GeometryAttribute::POSITION, nullptr, 3, draco::DT_UINT32, false,
                 3 * sizeof(std::uint32_t), 0);
  const int id = cloud.AddAttribute(attribute, true, count);
  for (std::uint32_t i = 0; i < count; ++i)
    cloud.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i), positions[i].data());

  draco::Encoder encoder;
  encoder.SetEncodingMethod(draco::POINT_CLOUD_KD_TREE_ENCODING);
  encoder.SetSpeedOptions(0, 0);
  draco::EncoderBuffer buffer;
  if (!encoder.EncodePointCloudToBuffer(cloud, &buffer).ok()) return std::nullopt;
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(buffer.data());
  return std::vector<std::uint8_t>(bytes, bytes + buffer.size());
}
#else
std::optional<std::vector<std::uint8_t>> encode_draco(std::span<const Voxel>) {
  return std::nullopt;
}
#endif

}  // namespace slf
