// SPDX-License-Identifier: Apache-2.0
// glTF 2.0 binary with KHR_gaussian_splatting: linear scales and opacity, quaternions w last, an
// accessor for every harmonic; COLOR_0 for programs that know points alone.
#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "lightfield/colour.h"
#include "lightfield/splats/splat_writers.h"

namespace slf {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint32_t kGlb = 0x46546c67, kJsonChunk = 0x4e4f534a, kBinaryChunk = 0x004e4942;
constexpr int kFloat = 5126, kUnsignedShort = 5123, kArrayBuffer = 34962, kPoints = 0;
constexpr int kGlbDegree = 3;  // the most that the extension has
/// More than what stands beside the buffer: headers, and the JSON of 21 attributes at most.
constexpr std::uint32_t kBesideBuffer = 1 << 16;
constexpr double kDegreeZero = 0.28209479177387814;  // the harmonic of degree 0: 1 / sqrt(4 pi)
const std::string kExtension = "KHR_gaussian_splatting";

/// Buffer views, accessors and attributes as they are added; each a run of the buffer.
struct Attributes {
  Json views = Json::array(), accessors = Json::array(), names = Json::object();
  Bytes buffer;
  std::size_t begin = 0;

  /// @param fill  appends the values of all splats to the buffer
  void add(const std::string& name, const char* type, int component, std::size_t count,
           const std::function<void(Bytes&)>& fill) {
    begin = buffer.size();
    fill(buffer);
    names[name] = accessors.size();
    accessors.push_back({{"bufferView", views.size()},
                         {"componentType", component},
                         {"count", count},
                         {"type", type}});
    if (component != kFloat) accessors.back()["normalized"] = true;
    views.push_back({{"buffer", 0},
                     {"byteOffset", begin},
                     {"byteLength", buffer.size() - begin},
                     {"target", kArrayBuffer}});
  }
};

void add_positions(const SplatRows& splats, Attributes& to) {
  to.add("POSITION", "VEC3", kFloat, splats.size(), [&](Bytes& out) {
    for (std::size_t p = 0; p < splats.size(); ++p)
      for (const float x : splats.position(p)) put(out, x);
  });
  auto low = splats.position(0), high = low;  // glTF asks for them
  for (std::size_t p = 0; p < splats.size(); ++p) {
    const auto at = splats.position(p);
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], at[k]);
      high[k] = std::max(high[k], at[k]);
    }
  }
  to.accessors.back()["min"] = low;
  to.accessors.back()["max"] = high;
}

/// Linear light of 16 bits, which degree 0 says in display values.
void add_point_colours(const SplatRows& splats, Attributes& to) {
  to.add("COLOR_0", "VEC4", kUnsignedShort, splats.size(), [&](Bytes& out) {
    for (std::size_t p = 0; p < splats.size(); ++p) {
      std::array<std::uint32_t, 4> rgba{
          0, 0, 0, static_cast<std::uint32_t>(std::lround(65535 * splats.point_opacity(p)))};
      for (std::size_t c = 0; c < 3; ++c) {
        const double display = 0.5 + kDegreeZero * double{splats.harmonics(p)[c]};
        rgba[c] = static_cast<std::uint32_t>(
            std::lround(65535 * srgb_to_linear(std::clamp(display, 0.0, 1.0))));
      }
      put(out, rgba[0] | rgba[1] << 16);
      put(out, rgba[2] | rgba[3] << 16);
    }
  });
}

void add_shapes(const SplatRows& splats, Attributes& to) {
  const auto add = [&](const char* name, const char* type, auto&& put_one) {
    to.add(kExtension + name, type, kFloat, splats.size(), [&](Bytes& out) {
      for (std::size_t p = 0; p < splats.size(); ++p) put_one(p, out);
    });
  };
  add(":ROTATION", "VEC4", [&](std::size_t p, Bytes& out) {
    const auto q = splats.rotation(p);
    for (const std::size_t k : {1u, 2u, 3u, 0u}) put(out, q[k]);
  });
  add(":SCALE", "VEC3", [&](std::size_t p, Bytes& out) {
    for (const float scale : splats.deviations(p)) put(out, scale);
  });
  add(":OPACITY", "SCALAR", [&](std::size_t p, Bytes& out) { put(out, splats.opacity(p)); });
}

void add_harmonics(const SplatRows& splats, int degree, Attributes& to) {
  const std::size_t count = functions_of(degree);
  for (std::size_t l = 0, k = 0; k < count; ++l)
    for (std::size_t m = 0; m < 2 * l + 1; ++m, ++k)
      to.add(kExtension + ":SH_DEGREE_" + std::to_string(l) + "_COEF_" + std::to_string(m), "VEC3",
             kFloat, splats.size(), [&](Bytes& out) {
               for (std::size_t p = 0; p < splats.size(); ++p)
                 for (std::size_t c = 0; c < 3; ++c) put(out, splats.harmonics(p)[3 * k + c]);
             });
}

Json document(const SplatRows& splats, const Attributes& from) {
  Json node{{"mesh", 0}};
  if (splats.origin() != Vec3{0, 0, 0}) node["translation"] = splats.origin();
  const Json splatting{{"kernel", "ellipse"},
                       {"colorSpace", "srgb_rec709_display"},
                       {"projection", "perspective"},
                       {"sortingMethod", "cameraDistance"}};
  return {{"asset", {{"version", "2.0"}, {"generator", "slf"}}},
          {"extensionsUsed", {kExtension}},
          {"scene", 0},
          {"scenes", {{{"nodes", {0}}}}},
          {"nodes", {node}},
          {"meshes",
           {{{"primitives",
              {{{"mode", kPoints},
                {"attributes", from.names},
                {"extensions", {{kExtension, splatting}}}}}}}}},
          {"accessors", from.accessors},
          {"bufferViews", from.views},
          {"buffers", {{{"byteLength", from.buffer.size()}}}}};
}

}  // namespace

Result<std::uint32_t, InputError> glb_buffer_bytes(std::uint64_t splats,
                                                   std::uint64_t num_harmonics) {
  // Position, colour, rotation, scale and opacity, and three floats for every harmonic.
  const std::uint64_t splat = 12 + 8 + 16 + 12 + 4 + 12 * num_harmonics;
  const std::uint64_t most = (~std::uint32_t{0} - kBesideBuffer) / splat;
  if (splats > most)
    return InputError{Errc::kInvalidInput, "GLB holds 4 GiB: " + std::to_string(most) +
                                               " points of this degree, and here are " +
                                               std::to_string(splats)};
  return static_cast<std::uint32_t>(splats * splat);
}

Result<Bytes, InputError> write_splat_glb(const SplatRows& splats) {
  const int degree = std::min(splats.degree(), kGlbDegree);
  SLF_TRY(const std::uint32_t buffer_bytes, glb_buffer_bytes(splats.size(), functions_of(degree)));
  Attributes attributes;
  attributes.buffer.reserve(buffer_bytes);
  add_positions(splats, attributes);
  add_point_colours(splats, attributes);
  add_shapes(splats, attributes);
  add_harmonics(splats, degree, attributes);
  std::string json = document(splats, attributes).dump();
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const auto json_bytes = static_cast<std::uint32_t>(json.size());
  const std::uint32_t file_bytes = 28 + json_bytes + buffer_bytes;
  Bytes out;
  out.reserve(file_bytes);
  put(out, kGlb);
  put(out, std::uint32_t{2});
  put(out, file_bytes);
  put(out, json_bytes);
  put(out, kJsonChunk);
  put(out, json);
  put(out, buffer_bytes);  // whole words: every attribute is
  put(out, kBinaryChunk);
  out.insert(out.end(), attributes.buffer.begin(), attributes.buffer.end());
  return out;
}

}  // namespace slf
