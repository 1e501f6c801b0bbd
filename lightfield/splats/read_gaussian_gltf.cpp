// SPDX-License-Identifier: Apache-2.0
// glTF 2.0 with KHR_gaussian_splatting, as text or as GLB: points with turns, sizes, opacities and
// an accessor for every harmonic, moved and turned by the nodes above them.
#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "base/vec3.h"
#include "capture/glb_accessor.h"
#include "capture/gltf_transform.h"
#include "capture/json_numbers.h"
#include "lightfield/splats/gaussian_readers.h"
#include "lightfield/splats/turn_gaussians.h"

namespace slf {
namespace {

constexpr std::size_t kMostSplatNumbers = std::size_t{1}
                                          << 31;  // nodes can share what is there once
constexpr int kMostNodeDepth = 64;
constexpr std::uint32_t kGlbMagic = 0x46546C67, kGlbJson = 0x4E4F534A, kGlbBinary = 0x004E4942;
const std::string kSplatting = "KHR_gaussian_splatting";

/// A node's transform as a turn, a scale and an offset.
struct Similarity {
  AxisRows rows;
  double scale;
  Vec3 offset;
};

/// Nothing where it is another: with unequal scales, a shear or a mirror.
std::optional<Similarity> similarity_of(const NodeMatrix& m) {
  constexpr double kTolerance = 1e-3;
  Similarity out{};
  double square = 0;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) square += m[i][j] * m[i][j];
  out.scale = std::sqrt(square / 3);
  if (!(out.scale > 0 && std::isfinite(out.scale)) || mirrors(m)) return std::nullopt;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) out.rows[i][j] = m[i][j] / out.scale;
    out.offset[i] = m[i][3];
  }
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      double product = 0;
      for (std::size_t k = 0; k < 3; ++k) product += out.rows[i][k] * out.rows[j][k];
      if (!(std::abs(product - (i == j ? 1 : 0)) < kTolerance)) return std::nullopt;
    }
  return out;
}

/// A list of an object, which may be absent.
Result<JsonItems, InputError> list_in(const JsonView& json, const char* key) {
  const auto found = json.find(key);
  if (!found) return JsonItems{};
  return found->items();
}

/// Columns of a primitive, [splats][components] each.
struct SplatColumns {
  std::vector<float> positions, rotations, sizes, opacities;
  std::vector<std::vector<float>> harmonics;  // [functions]
};

class SplatScene {
 public:
  SplatScene(const JsonView& json, FileBytes binary, std::filesystem::path folder)
      : json_(json), binary_(binary), folder_(std::move(folder)) {}

  /// Every splat of the scene, with the highest degree that a primitive has.
  Result<GaussianFile, InputError> read(const std::string& name) {
    SLF_TRY(data_.accessors, list_in(json_, "accessors"));
    SLF_TRY(data_.buffer_views, list_in(json_, "bufferViews"));
    SLF_TRY(data_.buffers, list_in(json_, "buffers"));
    SLF_TRY(data_.contents, GltfBuffers::load(data_.buffers, binary_, folder_));
    SLF_TRY(meshes_, list_in(json_, "meshes"));
    SLF_TRY(nodes_, list_in(json_, "nodes"));
    SLF_TRY(const auto scenes, list_in(json_, "scenes"));
    reached_.resize(nodes_.size());
    SLF_TRY(const auto number, glb_number(json_, "scene", 0, UINT32_MAX));
    if (number >= scenes.size()) return json_.error("there is no such scene");
    SLF_TRY(const auto roots, list_in(scenes[static_cast<std::size_t>(number)], "nodes"));
    for (const JsonView& root : roots)
      SLF_CHECK(add_node(root, {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}}, 0));
    return joined(name);
  }

 private:
  Result<Done, InputError> add_node(const JsonView& index, const NodeMatrix& above, int depth) {
    SLF_TRY(const JsonView node, glb_item(index, nodes_, "node"));
    SLF_TRY(const double number, index.number());
    auto&& reached = reached_[static_cast<std::size_t>(number)];
    if (reached || depth >= kMostNodeDepth) return node.error("is reached twice, or too deep");
    reached = true;
    SLF_TRY(const NodeMatrix own, transform_of(node));
    const NodeMatrix matrix = product(above, own);
    if (const auto mesh = node.find("mesh")) {
      SLF_TRY(const JsonView item, glb_item(*mesh, meshes_, "mesh"));
      SLF_TRY(const auto primitives, list_in(item, "primitives"));
      for (const JsonView& primitive : primitives) {
        const auto extensions = primitive.find("extensions");
        const auto splatting = extensions ? extensions->find(kSplatting) : std::nullopt;
        if (!splatting) continue;
        const auto place = similarity_of(matrix);
        if (!place)
          return node.error(
              "splats are turned, moved and scaled alike along all axes; this node "
              "does something else");
        SLF_CHECK(add_primitive(primitive, *splatting, *place));
      }
    }
    SLF_TRY(const auto children, list_in(node, "children"));
    for (const JsonView& child : children) SLF_CHECK(add_node(child, matrix, depth + 1));
    return Done{};
  }

  /// What would make another picture of the same numbers.
  Result<Done, InputError> check(const JsonView& splatting) const {
    const auto unsupported = [&](const JsonView& where, const std::string& cause) {
      return InputError{Errc::kUnsupported, where.error(cause).message};
    };
    if (const auto extensions = splatting.find("extensions"))
      for (const auto& [key, value] : extensions->members())
        return unsupported(
            value, key.substr(0, 60) + " is not read: export the splats without compression");
    for (const auto& [key, known] : {std::pair{"kernel", "ellipse"},
                                     {"colorSpace", "srgb_rec709_display"},
                                     {"projection", "perspective"}}) {
      const auto found = splatting.find(key);
      if (!found) continue;
      SLF_TRY(const std::string given, found->string());
      if (given != known) return unsupported(*found, std::string(known) + " alone is read");
    }
    return Done{};
  }

  Result<std::vector<float>, InputError> column(const JsonView& attributes, const std::string& key,
                                                const char* type, std::size_t components) {
    SLF_TRY(const JsonView index, attributes.at(key));
    SLF_TRY(const JsonView accessor, glb_item(index, data_.accessors, "accessor"));
    SLF_TRY(const auto numbers, read_accessor(data_, accessor, type, components));
    numbers_read_ += numbers.size();
    if (numbers_read_ > kMostSplatNumbers) return accessor.error("is used too often");
    std::vector<float> floats(numbers.size());
    std::transform(numbers.begin(), numbers.end(), floats.begin(),
                   [](double x) { return static_cast<float>(x); });
    return floats;
  }

  Result<SplatColumns, InputError> columns(const JsonView& attributes) {
    SplatColumns out;
    SLF_TRY(out.positions, column(attributes, "POSITION", "VEC3", 3));
    SLF_TRY(out.rotations, column(attributes, kSplatting + ":ROTATION", "VEC4", 4));
    SLF_TRY(out.sizes, column(attributes, kSplatting + ":SCALE", "VEC3", 3));
    SLF_TRY(out.opacities, column(attributes, kSplatting + ":OPACITY", "SCALAR", 1));
    for (int l = 0; l <= 4; ++l)
      for (int m = 0; m < 2 * l + 1; ++m) {
        const std::string key =
            kSplatting + ":SH_DEGREE_" + std::to_string(l) + "_COEF_" + std::to_string(m);
        if (l > 0 && m == 0 && !attributes.find(key)) return out;
        SLF_TRY(out.harmonics.emplace_back(), column(attributes, key, "VEC3", 3));
      }
    return out;
  }

  Result<Done, InputError> add_primitive(const JsonView& primitive, const JsonView& splatting,
                                         const Similarity& place) {
    SLF_CHECK(check(splatting));
    SLF_TRY(const JsonView attributes, primitive.at("attributes"));
    SLF_TRY(const SplatColumns own, columns(attributes));
    const std::size_t count = own.opacities.size();
    bool same = own.positions.size() == 3 * count && own.rotations.size() == 4 * count &&
                own.sizes.size() == 3 * count;
    for (const auto& values : own.harmonics) same = same && values.size() == 3 * count;
    if (!same) return attributes.error("accessors have unlike counts");
    GaussianCollector collector(degree_of_rest(own.harmonics.size() - 1), UpAxis::kPlusY, count);
    std::vector<float> harmonics(3 * own.harmonics.size());
    for (std::size_t p = 0; p < count; ++p) {
      RawGaussian raw;
      for (std::size_t k = 0; k < 3; ++k) {
        raw.position[k] = own.positions[3 * p + k];
        raw.log_deviations[k] = log_deviation_of(own.sizes[3 * p + k]);
      }
      for (std::size_t k = 0; k < 4; ++k)  // w is last in the file
        raw.rotation[k] = own.rotations[4 * p + (k + 3) % 4];
      raw.logit = logit_of(own.opacities[p]);
      for (std::size_t i = 0; i < harmonics.size(); ++i)
        harmonics[i] = own.harmonics[i / 3][3 * p + i % 3];
      collector.add(raw, harmonics);
    }
    return keep(std::move(collector), place, attributes);
  }

  /// Splats in the axes of the scene.
  Result<Done, InputError> keep(GaussianCollector collector, const Similarity& place,
                                const JsonView& attributes) {
    auto part = std::move(collector).take("", "glTF");
    if (!part) return Done{};  // of a primitive without splats; the scene may have others
    move_gaussians(part->gaussians, place.rows, place.scale);
    shift_gaussians(part->gaussians, place.offset);
    Gaussians& own = part->gaussians;
    for (std::size_t p = 0; p < own.size(); ++p)
      for (std::size_t k = 0; k < 3; ++k) {
        float& size = own.log_deviations[p][k];
        if (!std::isfinite(own.positions[p][k]) || size > kMostLogDeviation)
          return attributes.error("the node puts splats beyond all numbers");
        size = std::max(size, -kMostLogDeviation);
      }
    parts_.push_back(*std::move(part));
    return Done{};
  }

  /// All parts with the harmonics of the greatest degree.
  Result<GaussianFile, InputError> joined(const std::string& name) {
    if (parts_.size() == 1) return std::move(parts_[0]);
    int degree = 0;
    std::size_t count = 0, left_out = 0, mended = 0;
    for (const GaussianFile& part : parts_) {
      degree = std::max(degree, part.gaussians.degree);
      count += part.gaussians.size();
      left_out += part.left_out;
      mended += part.mended;
    }
    GaussianCollector collector(degree, UpAxis::kPlusY, count);
    std::vector<float> harmonics;
    const Vec3 origin = parts_.empty() ? Vec3{0, 0, 0} : parts_[0].gaussians.origin;
    for (const GaussianFile& part : parts_) {
      const Gaussians& from = part.gaussians;
      const Vec3 shift = minus(from.origin, origin);
      const std::size_t row = 3 * from.num_harmonics();
      for (std::size_t p = 0; p < from.size(); ++p) {
        harmonics.assign(3 * std::size_t(degree + 1) * std::size_t(degree + 1), 0);
        std::copy_n(from.harmonics.begin() + static_cast<std::ptrdiff_t>(p * row), row,
                    harmonics.begin());
        collector.add({to_float(plus(to_double(from.positions[p]), shift)), from.log_deviations[p],
                       from.rotations[p], from.logits[p]},
                      harmonics);
      }
    }
    SLF_TRY(GaussianFile file, std::move(collector).take(name, "glTF"));
    file.gaussians.origin = origin;
    file.left_out += left_out;
    file.mended += mended;
    return file;
  }

  const JsonView& json_;
  FileBytes binary_;
  std::filesystem::path folder_;
  GlbData data_;
  JsonItems meshes_, nodes_;
  std::vector<bool> reached_;
  std::size_t numbers_read_ = 0;
  std::vector<GaussianFile> parts_;
};

bool contains(FileBytes bytes, std::string_view text) {
  return std::search(bytes.begin(), bytes.end(), text.begin(), text.end()) != bytes.end();
}

bool is_glb(FileBytes head) { return head.size() >= 20 && word_at(head, 0, 4) == kGlbMagic; }

}  // namespace

bool is_gaussian_gltf(FileBytes head) {
  if (is_glb(head)) {
    const std::size_t json = std::min<std::size_t>(word_at(head, 12, 4), head.size() - 20);
    return contains(head.subspan(20, json), kSplatting);
  }
  const auto first = std::find_if(head.begin(), head.end(), [](std::uint8_t c) { return c > ' '; });
  return first != head.end() && *first == '{' && contains(head, "\"" + kSplatting);
}

Result<GaussianFile, InputError> read_gaussian_gltf(const std::string& name, FileBytes bytes,
                                                    const std::filesystem::path& folder) {
  FileBytes json = bytes, binary;
  if (is_glb(bytes)) {
    const auto invalid = [&](const char* cause) {
      return InputError{Errc::kInvalidInput, name + ": " + cause};
    };
    if (word_at(bytes, 4, 4) != 2) return invalid("GLB of another version than 2");
    if (word_at(bytes, 8, 4) != bytes.size()) return invalid("GLB of another length than it says");
    const std::size_t json_bytes = word_at(bytes, 12, 4);
    if (word_at(bytes, 16, 4) != kGlbJson || json_bytes > bytes.size() - 20 ||
        json_bytes > kMaxJsonBytes)
      return invalid("GLB without a whole JSON chunk");
    json = bytes.subspan(20, json_bytes);
    const FileBytes rest = bytes.subspan(20 + json_bytes);
    if (rest.size() >= 8 && word_at(rest, 4, 4) == kGlbBinary) {
      if (word_at(rest, 0, 4) > rest.size() - 8) return invalid("GLB: the binary chunk is cut off");
      binary = rest.subspan(8, word_at(rest, 0, 4));
    }
  }
  SLF_TRY(const JsonValue document, parse_json(name, json));
  return SplatScene(JsonView(document, name), binary, folder).read(name);
}

}  // namespace slf
