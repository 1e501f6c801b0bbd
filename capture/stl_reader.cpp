// SPDX-License-Identifier: Apache-2.0
// STL, binary and ASCII: triangles with corners of their own, which are made one where they agree.
// Normals of the file are those of its faces. Source: 3D Systems, StereoLithography Interface
// Specification, 1988.
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <string_view>
#include <unordered_map>

#include "capture/exact_positions.h"
#include "capture/little_endian.h"
#include "capture/mesh_formats.h"

namespace slf {

namespace {

constexpr std::size_t kStlHeader = 84, kStlFacet = 50;  // bytes
constexpr std::size_t kMostStlTriangles = std::size_t{1} << 25;

struct CornerHash {
  std::size_t operator()(const Vec3& p) const {
    std::uint64_t hash = 0;
    for (const double x : p) {
      hash = (hash ^ std::bit_cast<std::uint64_t>(x)) * 0x9E3779B97F4A7C15u;
      hash ^= hash >> 29;
    }
    return static_cast<std::size_t>(hash);
  }
};

/// Corners in the order of the file, three a triangle.
class StlCorners {
 public:
  void add(Vec3 corner) {
    for (double& x : corner) x += 0.0;  // -0 is 0
    const auto next = static_cast<std::uint32_t>(positions_.size());
    const auto [found, is_new] = vertex_of_.emplace(corner, next);
    if (is_new) positions_.push_back(corner);
    if (corners_++ % 3 == 0) mesh_.triangles.emplace_back();
    mesh_.triangles.back()[(corners_ - 1) % 3] = found->second;
  }
  std::size_t count() const { return corners_; }

  Mesh take() {
    set_positions(positions_, mesh_.vertices);
    return std::move(mesh_);
  }

 private:
  std::unordered_map<Vec3, std::uint32_t, CornerHash> vertex_of_;
  std::vector<Vec3> positions_;
  std::size_t corners_ = 0;
  Mesh mesh_;
};

/// The number of facets, where the file is as long as that.
bool is_binary_stl(std::span<const std::uint8_t> file) {
  return file.size() >= kStlHeader &&
         (file.size() - kStlHeader) / kStlFacet == little<std::uint32_t>(file, kStlHeader - 4) &&
         (file.size() - kStlHeader) % kStlFacet == 0;
}

Result<Mesh, InputError> parse_binary_stl(const std::string& name,
                                          std::span<const std::uint8_t> file) {
  const std::size_t facets = (file.size() - kStlHeader) / kStlFacet;
  StlCorners corners;
  for (std::size_t f = 0; f < facets; ++f)
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t at = kStlHeader + f * kStlFacet + 12 * (c + 1);  // behind the normal
      Vec3 corner{};
      for (std::size_t k = 0; k < 3; ++k) corner[k] = double{little_float(file, at + 4 * k)};
      for (const double x : corner)
        if (!std::isfinite(x))
          return InputError{Errc::kInvalidInput,
                            name + ": facet " + std::to_string(f) + ": a corner is not finite"};
      corners.add(corner);
    }
  return corners.take();
}

/// Words of a text, and the line of the last.
class StlWords {
 public:
  explicit StlWords(std::string_view text) : text_(text) {}

  /// Empty at the end.
  std::string_view next() {
    while (at_ < text_.size() && is_blank(text_[at_])) line_ += text_[at_++] == '\n';
    const std::size_t begin = at_;
    while (at_ < text_.size() && !is_blank(text_[at_])) ++at_;
    return text_.substr(begin, at_ - begin);
  }
  std::size_t line() const { return line_; }

 private:
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

  std::string_view text_;
  std::size_t at_ = 0, line_ = 1;
};

Result<Mesh, InputError> parse_ascii_stl(const std::string& name, std::string_view text) {
  StlWords words(text);
  const auto invalid = [&](const char* cause) {
    return InputError{Errc::kInvalidInput,
                      name + ": line " + std::to_string(words.line()) + ": " + cause};
  };
  StlCorners corners;
  for (auto word = words.next(); !word.empty(); word = words.next()) {
    if (word == "endloop" && corners.count() % 3 != 0) return invalid("a facet has three vertices");
    if (word != "vertex") continue;
    Vec3 corner{};
    for (double& x : corner) {
      word = words.next();
      if (word.starts_with('+')) word.remove_prefix(1);
      const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), x);
      if (error != std::errc() || stop != word.data() + word.size() ||
          !std::isfinite(static_cast<float>(x)))
        return invalid("a vertex is three numbers");
    }
    if (corners.count() >= 3 * kMostStlTriangles) return invalid("more than 2^25 facets");
    corners.add(corner);
  }
  if (corners.count() % 3 != 0) return invalid("a facet has three vertices");
  return corners.take();
}

}  // namespace

Result<Mesh, InputError> parse_stl(const std::string& name, std::span<const std::uint8_t> file) {
  if (is_binary_stl(file)) return parse_binary_stl(name, file);  // some of these begin with "solid"
  const std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
  if (text.starts_with("solid")) return parse_ascii_stl(name, text);
  return InputError{Errc::kInvalidInput,
                    name +
                        ": no STL: it does not begin with \"solid\", and its length is not that "
                        "of the facets that it says"};
}

}  // namespace slf
