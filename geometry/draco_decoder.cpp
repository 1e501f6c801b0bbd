// SPDX-License-Identifier: Apache-2.0
#include "geometry/draco_decoder.h"

#include <algorithm>
#include <array>

#include "bitstream/units.h"

#if SLF_WITH_DRACO
#include <draco/compression/decode.h>
#include <draco/point_cloud/point_cloud.h>

#include "geometry/morton.h"
#endif

namespace slf {

#if SLF_WITH_DRACO
namespace {

/// Spec 8.5. Draco allocates by its header, by the number, types and lengths of attributes too,
/// before it looks for the points, so that these are held against the bytes.
bool is_cloud_of_positions(std::span<const std::uint8_t> payload, std::uint64_t max_points) {
  constexpr std::size_t kHeaderBytes = 22;
  constexpr std::array<std::uint8_t, 6> kBegin = {'D', 'R', 'A', 'C', 'O', 2};  // version 2.x
  // One decoder of one attribute: position, uint32, three components, not normalised.
  constexpr std::array<std::uint8_t, 6> kAttribute = {1, 1, 0, 6, 3, 0};
  if (payload.size() < kHeaderBytes) return false;
  if (!std::equal(kBegin.begin(), kBegin.end(), payload.begin())) return false;
  const bool point_cloud = payload[7] == 0 && payload[8] <= 1;
  const bool metadata = payload[9] != 0 || payload[10] != 0;
  const std::uint32_t count = payload[11] | std::uint32_t{payload[12]} << 8 |
                              std::uint32_t{payload[13]} << 16 | std::uint32_t{payload[14]} << 24;
  const std::uint64_t most = (std::uint64_t{1} << 19) + 4096 * std::uint64_t{payload.size()};
  return point_cloud && !metadata && count <= std::min(max_points, most) &&
         std::equal(kAttribute.begin(), kAttribute.end(), payload.begin() + 15);
}

}  // namespace

Result<std::vector<std::uint64_t>> decode_draco(std::span<const std::uint8_t> payload, int bits,
                                                std::uint64_t max_points) {
  const Error damaged{Errc::kOutOfRange, "gu_draco"};
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(payload.data()), payload.size());
  if (!is_cloud_of_positions(payload, max_points)) return damaged;
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
  std::vector<std::uint64_t> codes;
  codes.reserve(cloud.num_points());
  for (std::uint32_t i = 0; i < cloud.num_points(); ++i) {
    std::uint32_t xyz[3];
    if (!position->ConvertValue<std::uint32_t>(position->mapped_index(draco::PointIndex(i)), 3,
                                               xyz))
      return damaged;
    Voxel voxel;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (xyz[axis] >> bits != 0) return damaged;
      voxel[axis] = static_cast<std::int32_t>(xyz[axis]);
    }
    codes.push_back(morton(voxel));
  }
  std::sort(codes.begin(), codes.end());
  if (std::adjacent_find(codes.begin(), codes.end()) != codes.end()) return damaged;
  return codes;
}
#else
Result<std::vector<std::uint64_t>> decode_draco(std::span<const std::uint8_t>, int, std::uint64_t) {
  return of_sequence(Errc::kUnsupported, "sps_geometry_coder");
}
#endif

}  // namespace slf
