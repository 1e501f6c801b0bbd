// SPDX-License-Identifier: Apache-2.0
#include "capture/ply_faces.h"

#include <cmath>
#include <optional>
#include <utility>

namespace slf {

namespace {

std::optional<std::size_t> indices_of(const PlyElement& face) {
  for (std::size_t p = 0; p < face.properties.size(); ++p) {
    const auto& property = face.properties[p];
    if (property.name == "vertex_indices" || property.name == "vertex_index")
      return property.is_list && property.type < PlyType::kFloat ? std::optional(p) : std::nullopt;
  }
  return std::nullopt;
}

bool skip_property(const PlyProperty& property, PlyBody& body) {
  double ignored = 0;
  return property.is_list ? body.skip_list(property) : body.value(property.type, ignored);
}

}  // namespace

Result<std::vector<std::array<std::uint32_t, 3>>, InputError> read_ply_faces(
    const std::string& name, const PlyElement& face, PlyBody& body) {
  const auto invalid = [&](const std::string& cause) {
    return InputError{Errc::kInvalidInput, name + ": " + cause};
  };
  std::vector<std::array<std::uint32_t, 3>> triangles;
  if (face.count == 0) return triangles;
  const auto indices = indices_of(face);
  if (!indices) return invalid("PLY face without a list vertex_indices of whole numbers");
  for (std::uint64_t f = 0; f < face.count; ++f)
    for (std::size_t p = 0; p < face.properties.size(); ++p) {
      const auto& property = face.properties[p];
      const auto damaged = [&] {
        return invalid("face " + std::to_string(f) + ", property " + property.name +
                       " is missing or damaged");
      };
      if (p != *indices) {
        if (!skip_property(property, body)) return damaged();
        continue;
      }
      std::uint64_t corners = 0;
      if (!body.list_length(property, corners)) return damaged();
      std::array<std::uint32_t, 3> triangle{};
      for (std::uint64_t i = 0; i < corners; ++i) {
        double index = 0;
        if (!body.value(property.type, index)) return damaged();
        if (!(index >= 0 && index < 4294967295.0) || index != std::floor(index))
          return invalid("face " + std::to_string(f) + " has an index that is no vertex");
        triangle[i < 2 ? i : 2] = static_cast<std::uint32_t>(index);
        if (i < 2) continue;
        triangles.push_back(triangle);
        triangle[1] = triangle[2];
      }
    }
  return triangles;
}

Result<std::vector<std::array<std::uint32_t, 3>>, InputError> read_ply_strips(
    const std::string& name, const PlyElement& strips, PlyBody& body) {
  const auto invalid = [&](std::uint64_t row, const std::string& cause) {
    return InputError{Errc::kInvalidInput,
                      name + ": tristrips " + std::to_string(row) + ": " + cause};
  };
  std::vector<std::array<std::uint32_t, 3>> triangles;
  if (strips.count == 0) return triangles;
  const auto indices = indices_of(strips);
  if (!indices) return invalid(0, "no list vertex_indices of whole numbers");
  for (std::uint64_t row = 0; row < strips.count; ++row)
    for (std::size_t p = 0; p < strips.properties.size(); ++p) {
      const auto& property = strips.properties[p];
      std::uint64_t corners = 0;
      if (p != *indices ? !skip_property(property, body) : !body.list_length(property, corners))
        return invalid(row, property.name + " is missing or damaged");
      std::array<std::uint32_t, 3> last{};
      std::uint64_t length = 0;  // of this strip
      for (std::uint64_t i = 0; i < corners; ++i) {
        double index = 0;
        if (!body.value(property.type, index))
          return invalid(row, property.name + " is missing or damaged");
        if (index == -1) {  // the next strip
          length = 0;
          continue;
        }
        if (!(index >= 0 && index < 4294967295.0) || index != std::floor(index))
          return invalid(row, "an index that is no vertex");
        last = {last[1], last[2], static_cast<std::uint32_t>(index)};
        if (++length < 3) continue;
        triangles.push_back(last);
        if (length % 2 == 0) std::swap(triangles.back()[0], triangles.back()[1]);  // turns about
      }
    }
  return triangles;
}

}  // namespace slf
