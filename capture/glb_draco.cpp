// SPDX-License-Identifier: Apache-2.0
// Source: Khronos, KHR_draco_mesh_compression.
#include "capture/glb_draco.h"

#include <algorithm>

namespace slf {

namespace {

constexpr std::uint64_t kMostDracoVertices = std::uint64_t{1} << 25,
                        kMostCorners = std::uint64_t{3} << 24;

/// Elements of the accessor that a member names.
Result<std::uint64_t, InputError> count_at(const GlbData& data, const JsonView& object,
                                           const char* name, std::uint64_t most) {
  SLF_TRY(const JsonView index, object.at(name));
  SLF_TRY(const JsonView accessor, glb_item(index, data.accessors, "accessor"));
  return glb_number(accessor, "count", 0, most);
}

}  // namespace

Result<std::optional<DracoMesh>, InputError> draco_mesh_of(const GlbData& data,
                                                           const JsonView& primitive) {
  using Found = std::optional<DracoMesh>;
  const auto extensions = primitive.find("extensions");
  const auto draco = extensions ? extensions->find("KHR_draco_mesh_compression") : std::nullopt;
  if (!draco) return Found{};
  DracoRequest request;
  SLF_TRY(const JsonView attributes, primitive.at("attributes"));
  SLF_TRY(request.max_points, count_at(data, attributes, "POSITION", kMostDracoVertices));
  SLF_TRY(const auto corners, count_at(data, primitive, "indices", kMostCorners));
  request.max_faces = corners / 3;
  SLF_TRY(const JsonView ids, draco->at("attributes"));
  SLF_TRY(const JsonView position, ids.at("POSITION"));
  SLF_TRY(const double id, position.number());
  if (!(id >= 0 && id <= UINT32_MAX)) return position.error("there is no such attribute");
  request.position = static_cast<std::uint32_t>(id);
  if (ids.find("NORMAL")) {
    SLF_TRY(const auto normal, glb_number(ids, "NORMAL", 0, UINT32_MAX));
    request.normal = static_cast<std::uint32_t>(normal);
  }
  SLF_TRY(const JsonView index, draco->at("bufferView"));
  SLF_TRY(const JsonView view, glb_item(index, data.buffer_views, "buffer view"));
  SLF_TRY(const auto bytes, glb_view_bytes(data, view));
  auto mesh = decode_draco_mesh(bytes, request);
  if (!mesh) return draco->error(mesh.error());
  return Found{*std::move(mesh)};
}

}  // namespace slf
