// SPDX-License-Identifier: Apache-2.0
// Source of the layout that is looked through: Draco bitstream specification 2.2.
#include "capture/draco_mesh.h"

#if SLF_WITH_DRACO
#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/core/varint_decoding.h>
#include <draco/mesh/mesh.h>

#include <algorithm>
#include <array>
#include <memory>
#include <type_traits>
#endif

namespace slf {

#if SLF_WITH_DRACO
namespace {

constexpr std::uint8_t kEdgebreaker = 1;  // or 0: sequential
constexpr std::size_t kHeaderBytes = 11;
constexpr std::uint64_t kMostValues = std::uint64_t{1} << 28;  // of all attributes together

/// Faces and points of the connectivity's header.
bool counts_fit(std::span<const std::uint8_t> bytes, const DracoRequest& request) {
  draco::DecoderBuffer in;
  in.Init(reinterpret_cast<const char*>(bytes.data()) + kHeaderBytes, bytes.size() - kHeaderBytes);
  in.set_bitstream_version(static_cast<std::uint16_t>(bytes[5] << 8 | bytes[6]));
  const bool edgebreaker = bytes[8] == kEdgebreaker;
  std::uint8_t traversal = 0;
  std::uint32_t first = 0, second = 0;
  if (edgebreaker && !in.Decode(&traversal)) return false;
  if (!draco::DecodeVarint(&first, &in) || !draco::DecodeVarint(&second, &in)) return false;
  const std::uint64_t faces = edgebreaker ? second : first, points = edgebreaker ? first : second;
  const std::uint64_t most = (std::uint64_t{1} << 19) + 4096 * std::uint64_t{bytes.size()};
  return faces <= std::min(request.max_faces, most) && points <= std::min(request.max_points, most);
}

/// Looks through the headers of attributes before Draco allocates by them.
template <class Decoder>
class BoundedDecoder : public Decoder {
 protected:
  bool DecodePointAttributes() override {
    return attributes_fit(*this->buffer()) && Decoder::DecodePointAttributes();
  }

 private:
  bool attributes_fit(draco::DecoderBuffer in) const {  // a copy: nothing is taken from it
    constexpr bool kSeamed = std::is_base_of_v<draco::MeshEdgebreakerDecoder, Decoder>;
    std::uint8_t decoders = 0, skipped = 0;
    if (!in.Decode(&decoders)) return false;
    for (int i = 0; kSeamed && i < 3 * decoders; ++i)  // data id, kind, traversal
      if (!in.Decode(&skipped)) return false;
    std::uint64_t components = 0;
    for (int d = 0; d < decoders; ++d) {
      std::uint32_t attributes = 0, id = 0;
      if (!draco::DecodeVarint(&attributes, &in)) return false;
      for (std::uint32_t a = 0; a < attributes; ++a) {  // ends with the bytes
        std::array<std::uint8_t, 4> kind{};             // attribute, type, components, normalised
        if (!in.Decode(kind.data(), kind.size()) || !draco::DecodeVarint(&id, &in)) return false;
        components += kind[2];
      }
      for (std::uint32_t a = 0; a < attributes; ++a)
        if (!in.Decode(&skipped)) return false;
    }
    // Seams part points: there are at most as many as corners.
    const std::uint64_t points =
        std::max<std::uint64_t>(this->point_cloud()->num_points(),
                                kSeamed ? 3 * std::uint64_t{this->mesh()->num_faces()} : 0);
    return components * points <= kMostValues;
  }
};

std::unique_ptr<draco::Mesh> decoded(std::span<const std::uint8_t> bytes) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  auto mesh = std::make_unique<draco::Mesh>();
  const draco::DecoderOptions options;
  BoundedDecoder<draco::MeshEdgebreakerDecoder> edgebreaker;
  BoundedDecoder<draco::MeshSequentialDecoder> sequential;
  draco::MeshDecoder& decoder = bytes[8] == kEdgebreaker
                                    ? static_cast<draco::MeshDecoder&>(edgebreaker)
                                    : static_cast<draco::MeshDecoder&>(sequential);
  return decoder.Decode(options, &buffer, mesh.get()).ok() ? std::move(mesh) : nullptr;
}

/// Three numbers of each point; empty where there is no such attribute.
std::vector<double> values_of(const draco::Mesh& mesh, std::uint32_t id) {
  const draco::PointAttribute* attribute = mesh.GetAttributeByUniqueId(id);
  std::vector<double> values;
  if (attribute == nullptr || attribute->num_components() != 3) return values;
  values.reserve(std::size_t{3} * mesh.num_points());
  for (std::uint32_t i = 0; i < mesh.num_points(); ++i) {
    const auto at = attribute->mapped_index(draco::PointIndex(i));
    std::array<float, 3> xyz{};
    if (at.value() >= attribute->size() || !attribute->ConvertValue<float>(at, 3, xyz.data()))
      return {};
    values.insert(values.end(), xyz.begin(), xyz.end());
  }
  return values;
}

}  // namespace

Result<DracoMesh, const char*> decode_draco_mesh(std::span<const std::uint8_t> bytes,
                                                 const DracoRequest& request) {
  constexpr std::array<std::uint8_t, 6> kBegin = {'D', 'R', 'A', 'C', 'O', 2};  // version 2.x
  if (bytes.size() < kHeaderBytes || !std::equal(kBegin.begin(), kBegin.end(), bytes.begin()) ||
      bytes[7] != 1 || bytes[8] > kEdgebreaker)
    return "no mesh of Draco 2";
  if (bytes[9] != 0 || bytes[10] != 0) return "Draco's metadata are not read";
  if (!counts_fit(bytes, request)) return "more faces or points than the accessors have";
  const auto mesh = decoded(bytes);
  if (mesh == nullptr || mesh->num_points() > request.max_points) return "damaged Draco data";
  DracoMesh result;
  result.positions = values_of(*mesh, request.position);
  if (result.positions.empty()) return "Draco's data have no such POSITION";
  if (request.normal) result.normals = values_of(*mesh, *request.normal);
  for (std::uint32_t f = 0; f < mesh->num_faces(); ++f)
    for (const draco::PointIndex& corner : mesh->face(draco::FaceIndex(f))) {
      if (corner.value() >= mesh->num_points()) return "damaged Draco data";
      result.indices.push_back(corner.value());
    }
  return result;
}
#else
Result<DracoMesh, const char*> decode_draco_mesh(std::span<const std::uint8_t>,
                                                 const DracoRequest&) {
  return "this build has no Draco: export the mesh without compression";
}
#endif

}  // namespace slf
