// SPDX-License-Identifier: Apache-2.0
// PLY to a point cloud or mesh, properties by name.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "capture/exact_positions.h"
#include "capture/mend_normals.h"
#include "capture/ply_body.h"
#include "capture/ply_colours.h"
#include "capture/ply_columns.h"
#include "capture/ply_faces.h"
#include "capture/ply_reader.h"
#include "slf/capture.h"

namespace slf {

namespace {

constexpr std::size_t kMostHeader = std::size_t{1} << 20;
using Row = std::array<double, kPlyWanted.size()>;

class VertexReader {
 public:
  VertexReader(const std::string& name, const PlyElement& vertex)
      : name_(name),
        vertex_(vertex),
        columns_(ply_columns(vertex)),
        colours_(std::span<const PlyType, 3>(&columns_.type[kPlyColour], 3)) {}

  Result<Done, InputError> read(PlyBody& body) {
    if (!columns_.present[0] || !columns_.present[1] || !columns_.present[2])
      return invalid("PLY vertex without x, y and z: rename the properties of its positions");
    const auto count = static_cast<std::size_t>(vertex_.count);  // bounded by the file's size
    if (columns_.exact)
      exact_.reserve(count);
    else
      cloud.positions.reserve(count);
    if (columns_.normals) cloud.normals.reserve(count);
    if (columns_.colours) colours_.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
      SLF_TRY(const Row row, read_row(i, body));
      if (is_point(row)) {
        SLF_CHECK(add(i, row));
      } else {
        leave_out(i);
      }
    }
    if (left_out_ == count) return invalid("no points: none of its vertices is finite");
    if (const std::string problem = colours_.problem(); !problem.empty()) return invalid(problem);
    cloud.colours = colours_.take();
    if (columns_.exact) set_positions(exact_, cloud);
    return Done{};
  }

  void warn(std::vector<std::string>& warnings) {
    for (const std::string& warning : columns_.warnings) warnings.push_back(name_ + ": " + warning);
    if (const std::string warning = colours_.warning(); !warning.empty())
      warnings.push_back(name_ + ": " + warning);
    if (left_out_ > 0)
      warnings.push_back(name_ + ": " + std::to_string(left_out_) + " of " +
                         std::to_string(vertex_.count) + " points are not finite: left out");
    if (other_normals_ > 0)
      warnings.push_back(name_ + ": " + std::to_string(other_normals_) +
                         " normals are not of unit length: normalised");
  }

  /// Faces of the file to those of the cloud, which has fewer vertices where some were left out.
  void renumber(std::vector<std::array<std::uint32_t, 3>>& triangles) const {
    if (left_out_ == 0) return;
    std::erase_if(triangles, [&](const auto& t) {
      return std::any_of(t.begin(), t.end(),
                         [&](auto v) { return v < place_.size() && place_[v] == kLeftOut; });
    });
    for (auto& t : triangles)
      for (auto& v : t)  // what is no vertex stays none
        if (v < place_.size()) v = place_[v];
  }

  PointCloud cloud;

 private:
  static constexpr std::uint32_t kLeftOut = std::numeric_limits<std::uint32_t>::max();

  Result<Row, InputError> read_row(std::size_t i, PlyBody& body) {
    Row row{};
    for (std::size_t p = 0; p < vertex_.properties.size(); ++p) {
      const auto& property = vertex_.properties[p];
      double value = 0;
      if (!(property.is_list ? body.skip_list(property) : body.value(property.type, value)))
        return invalid(at(i, property.name) + " is missing or damaged");
      if (!columns_.wanted[p]) continue;
      if (!std::isfinite(value) && *columns_.wanted[p] >= kPlyColour)
        return invalid(at(i, property.name) + " is not finite");
      row[*columns_.wanted[p]] = value;
    }
    return row;
  }

  // Organised clouds of depth cameras have NaN where nothing was measured.
  static bool is_point(const Row& row) {
    return std::isfinite(row[0]) && std::isfinite(row[1]) && std::isfinite(row[2]);
  }

  void leave_out(std::size_t i) {
    if (left_out_++ == 0) {
      place_.resize(static_cast<std::size_t>(vertex_.count));
      for (std::size_t v = 0; v < i; ++v) place_[v] = static_cast<std::uint32_t>(v);
    }
    place_[i] = kLeftOut;
  }

  Result<Done, InputError> add(std::size_t i, const Row& row) {
    std::array<float, 3> position{};
    for (std::size_t k = 0; k < 3; ++k) {
      position[k] = static_cast<float>(row[k]);
      if (!std::isfinite(position[k])) return invalid(at(i, kPlyWanted[k]) + " is beyond 3.4e38");
    }
    if (columns_.exact)
      exact_.push_back({row[0], row[1], row[2]});
    else
      cloud.positions.push_back(position);
    if (columns_.normals) add_normal(row);
    if (left_out_ > 0) place_[i] = static_cast<std::uint32_t>(i - left_out_);
    if (!columns_.colours) return Done{};
    const auto wrong = colours_.add(std::span<const double, 3>(&row[kPlyColour], 3));
    if (wrong)
      return invalid(at(i, kPlyWanted[kPlyColour + *wrong]) +
                     " is out of range (0 to 255; 16 bits to 65535; floats 0 to 1 or 0 to 255)");
    return Done{};
  }

  void add_normal(const Row& row) {
    const double x = row[kPlyNormal], y = row[kPlyNormal + 1], z = row[kPlyNormal + 2];
    const double length = std::hypot(x, y, z);
    if (!(length > 0) || !std::isfinite(length)) {
      cloud.normals.push_back({0, 0, 0});  // mend_normals sees to it
      return;
    }
    if (std::abs(length - 1) > 1e-3) ++other_normals_;
    cloud.normals.push_back({static_cast<float>(x / length), static_cast<float>(y / length),
                             static_cast<float>(z / length)});
  }

  InputError invalid(const std::string& cause) const {
    return {Errc::kInvalidInput, name_ + ": " + cause};
  }
  static std::string at(std::size_t i, const std::string& property) {
    return "vertex " + std::to_string(i) + ", property " + property;
  }

  const std::string& name_;
  const PlyElement& vertex_;
  PlyColumns columns_;
  PlyColours colours_;
  std::vector<Vec3> exact_;           // [P] positions until all are known, where columns_.exact
  std::vector<std::uint32_t> place_;  // [vertices] in the cloud; empty: where they are in the file
  std::size_t left_out_ = 0;
  std::size_t other_normals_ = 0;
};

}  // namespace

Result<Mesh, InputError> read_ply_mesh(const std::filesystem::path& file, bool with_faces,
                                       std::vector<std::string>* warnings) {
  const std::string name = file == "-" ? "standard input" : file.string();
  SLF_TRY(InputFile input, InputFile::open(file));
  std::vector<std::uint8_t> head(kMostHeader);
  SLF_TRY(const std::size_t count, input.read(head));
  head.resize(count);
  SLF_TRY(const auto header, parse_ply_header(name, head, input.size()));
  PlyBody body(input, std::move(head), header.body, header.format);
  std::optional<VertexReader> vertices;
  Mesh mesh;
  for (const auto& element : header.elements) {
    if (element.name == "vertex") {
      if (element.count == 0) return InputError{Errc::kInvalidInput, name + ": no points"};
      vertices.emplace(name, element);
      SLF_CHECK(vertices->read(body));
      if (warnings != nullptr) vertices->warn(*warnings);
    } else if (with_faces && (element.name == "face" || element.name == "tristrips")) {
      SLF_TRY(const auto triangles, element.name == "face" ? read_ply_faces(name, element, body)
                                                           : read_ply_strips(name, element, body));
      mesh.triangles.insert(mesh.triangles.end(), triangles.begin(), triangles.end());
    } else if (!body.skip_element(element)) {
      return InputError{Errc::kInvalidInput,
                        name + ": PLY element '" + element.name + "' is cut off or damaged"};
    }
  }
  if (!vertices) return InputError{Errc::kInvalidInput, name + ": PLY without vertices"};
  vertices->renumber(mesh.triangles);
  mesh.vertices = std::move(vertices->cloud);
  const std::size_t normals = mesh.vertices.normals.size(), mended = mend_normals(mesh);
  if (mended > 0 && warnings != nullptr)
    warnings->push_back(
        name + ": " + std::to_string(mended) + " normals have length 0 or are not finite, of " +
        std::to_string(normals) +
        (mesh.vertices.normals.empty() ? ": normals ignored" : ": taken from their neighbours"));
  return mesh;
}

Result<std::uint64_t, InputError> ply_vertices(const std::filesystem::path& file) {
  SLF_TRY(InputFile input, InputFile::open(file));
  std::vector<std::uint8_t> head(kMostHeader);
  SLF_TRY(const std::size_t count, input.read(head));
  head.resize(count);
  SLF_TRY(const auto header, parse_ply_header(file.string(), head, input.size()));
  for (const PlyElement& element : header.elements)
    if (element.name == "vertex") return element.count;
  return InputError{Errc::kInvalidInput, file.string() + ": a PLY without vertices"};
}

Result<PointCloud, InputError> read_ply(const std::filesystem::path& file,
                                        std::vector<std::string>* warnings) {
  SLF_TRY(Mesh mesh, read_ply_mesh(file, false, warnings));
  return std::move(mesh.vertices);
}

}  // namespace slf
