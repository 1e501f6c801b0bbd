// SPDX-License-Identifier: Apache-2.0
// A plenoptic cloud as a binary little endian PLY, with the properties that it came with.
#include <bit>
#include <cmath>

#include "base/shortest.h"
#include "capture/plenoptic_columns.h"
#include "slf/plenoptic.h"

namespace slf {

namespace {

void put_bytes(std::vector<std::uint8_t>& out, std::uint64_t bits, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) out.push_back(static_cast<std::uint8_t>(bits >> 8 * i));
}

void put_coordinate(std::vector<std::uint8_t>& out, PlyType type, double value) {
  switch (type) {
    case PlyType::kFloat:
      return put_bytes(out, std::bit_cast<std::uint32_t>(static_cast<float>(value)), 4);
    case PlyType::kDouble:
      return put_bytes(out, std::bit_cast<std::uint64_t>(value), 8);
    default:
      return put_bytes(out,
                       static_cast<std::uint64_t>(static_cast<std::int64_t>(std::round(value))),
                       size_of(type));
  }
}

std::string header_of_cloud(const PlenopticCloud& cloud) {
  std::string header = "ply\nformat binary_little_endian 1.0\n";
  for (std::size_t v = 0; v < cloud.view_positions.size(); ++v) {
    header += "comment view " + std::to_string(v);
    for (const double x : cloud.view_positions[v]) header.append(" ").append(shortest(x));
    header.append("\n");
  }
  header += "element vertex " + std::to_string(cloud.num_points()) + "\n";
  for (const PlenopticProperty& p : cloud.properties)
    header.append("property ").append(p.type).append(" ").append(p.name).append("\n");
  return header + "end_header\n";
}

}  // namespace

Result<Done, InputError> write_plenoptic(const std::filesystem::path& file,
                                         const PlenopticCloud& cloud) {
  PlyElement vertex{"vertex", cloud.num_points(), {}};
  for (const PlenopticProperty& p : cloud.properties) {
    const auto type = ply_type_named(p.type);
    if (!type) return InputError{Errc::kInvalidArgument, "property type " + p.type};
    vertex.properties.push_back({p.name, *type});
  }
  const auto columns = plenoptic_columns(vertex);
  if (!columns || columns->views != cloud.views || columns->own_colour != cloud.own_colour ||
      cloud.colours.size() != cloud.num_points() * 3 * cloud.num_colours())
    return InputError{Errc::kInvalidArgument, "properties are not those of the cloud's views"};
  const std::string header = header_of_cloud(cloud);
  const std::size_t row_bytes =
      static_cast<std::size_t>(vertex.min_row_bytes(PlyFormat::kLittleEndian));
  std::vector<std::uint8_t> out;
  out.reserve(header.size() + cloud.num_points() * row_bytes);
  out.assign(header.begin(), header.end());
  for (std::size_t i = 0; i < cloud.num_points(); ++i) {
    const Vec3 at = cloud.grid.world(cloud.positions[i]);
    const std::uint8_t* colours = &cloud.colours[i * 3 * cloud.num_colours()];
    for (std::size_t p = 0; p < vertex.properties.size(); ++p) {
      const auto place = columns->place[p];
      if (!place) continue;  // there is none: all are kept
      if (*place < 3)
        put_coordinate(out, vertex.properties[p].type, at[*place]);
      else
        out.push_back(colours[*place - 3]);
    }
  }
  return write_file(file, out.data(), out.size());
}

}  // namespace slf
