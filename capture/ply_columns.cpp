// SPDX-License-Identifier: Apache-2.0
#include "capture/ply_columns.h"

#include <algorithm>

namespace slf {

namespace {

using Names = std::array<const char*, 3>;
struct Alias {
  std::size_t first;  // in kPlyWanted
  Names names;        // in small letters
};
// normalx: PDAL; diffuse_red: MeshLab and OpenSfM.
constexpr std::array<Alias, 7> kAliases{
    {{kPlyNormal, {"normalx", "normaly", "normalz"}},
     {0, {"x", "y", "z"}},
     {kPlyNormal, {"nx", "ny", "nz"}},
     {kPlyNormal, {"normal_x", "normal_y", "normal_z"}},
     {kPlyColour, {"red", "green", "blue"}},
     {kPlyColour, {"diffuse_red", "diffuse_green", "diffuse_blue"}},
     {kPlyColour, {"r", "g", "b"}}}};
constexpr std::size_t kMostListed = 200;  // characters of skipped names

std::string in_small_letters(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

void take(const PlyElement& vertex, std::size_t property, std::size_t place, PlyColumns& columns) {
  columns.wanted[property] = place;
  columns.present[place] = true;
  columns.type[place] = vertex.properties[property].type;
}

void take_alias(const PlyElement& vertex, const Alias& alias, PlyColumns& columns) {
  for (std::size_t k = 0; k < 3; ++k)
    if (columns.present[alias.first + k]) return;
  std::array<std::size_t, 3> found{};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto at =
        std::find_if(vertex.properties.begin(), vertex.properties.end(), [&](const PlyProperty& p) {
          return !p.is_list && in_small_letters(p.name) == alias.names[k];
        });
    if (at == vertex.properties.end()) return;
    found[k] = static_cast<std::size_t>(at - vertex.properties.begin());
    if (columns.wanted[found[k]]) return;
  }
  for (std::size_t k = 0; k < 3; ++k) take(vertex, found[k], alias.first + k, columns);
}

void warn_of_skipped(const PlyElement& vertex, PlyColumns& columns) {
  std::string names;
  std::vector<const PlyProperty*> bytes;
  bool splats = false;
  for (std::size_t p = 0; p < vertex.properties.size(); ++p) {
    const PlyProperty& property = vertex.properties[p];
    if (columns.wanted[p]) continue;
    if (names.size() < kMostListed)
      names += (names.empty() ? "" : ", ") + property.name;
    else if (!names.ends_with("..."))
      names += ", ...";
    if (!property.is_list && property.type == PlyType::kUint8) bytes.push_back(&property);
    splats = splats || property.name == "f_dc_0";
  }
  if (splats)
    columns.warnings.emplace_back(
        "Gaussian splats: their centres are taken for points, and nothing else of them is read");
  else if (bytes.size() >= 6 && bytes.size() % 3 == 0)
    columns.warnings.push_back(
        std::to_string(bytes.size() / 3) + " more colours of each point (" + bytes.front()->name +
        " ... " + bytes.back()->name +
        "): a plenoptic cloud, of which red, green, blue alone are read (slf encode CLOUD.ply, "
        "without cameras, codes all of them)");
  else if (!names.empty())
    columns.warnings.push_back("properties skipped: " + names);
}

}  // namespace

PlyColumns ply_columns(const PlyElement& vertex) {
  PlyColumns columns;
  columns.wanted.resize(vertex.properties.size());
  for (std::size_t p = 0; p < vertex.properties.size(); ++p)
    for (std::size_t i = 0; i < kPlyWanted.size() && !vertex.properties[p].is_list; ++i)
      if (vertex.properties[p].name == kPlyWanted[i]) take(vertex, p, i, columns);
  for (const Alias& alias : kAliases) take_alias(vertex, alias, columns);
  const auto all = [&](std::size_t first) {
    return columns.present[first] && columns.present[first + 1] && columns.present[first + 2];
  };
  const auto some = [&](std::size_t first) {
    return columns.present[first] || columns.present[first + 1] || columns.present[first + 2];
  };
  for (std::size_t k = 0; k < 3; ++k) {
    const PlyType type = columns.type[k];
    columns.exact = columns.exact || type == PlyType::kDouble || type == PlyType::kInt32 ||
                    type == PlyType::kUint32;
  }
  columns.normals = all(kPlyNormal);
  columns.colours = all(kPlyColour);
  warn_of_skipped(vertex, columns);
  if (some(kPlyNormal) && !columns.normals)
    columns.warnings.emplace_back("not all of nx, ny, nz are there: normals ignored");
  if (some(kPlyColour) && !columns.colours)
    columns.warnings.emplace_back("not all of red, green, blue are there: colours ignored");
  return columns;
}

}  // namespace slf
