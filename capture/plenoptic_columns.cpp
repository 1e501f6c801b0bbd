// SPDX-License-Identifier: Apache-2.0
#include "capture/plenoptic_columns.h"

#include <algorithm>
#include <array>

#include "base/input_error.h"
#include "capture/ply_columns.h"
#include "slf/plenoptic.h"

namespace slf {

namespace {

constexpr std::size_t kMostNames = 200;  // characters of names that are left out

bool is_alpha(const std::string& name) {
  return name == "alpha" || name == "a" || name == "opacity" || name == "Alpha";
}

/// What scanners measure beside a colour: LAS, E57, drivers of lidar, CloudCompare ("scalar_").
bool is_of_scans(std::string name) {
  constexpr std::array kNames = {"classification",
                                 "class",
                                 "label",
                                 "intensity",
                                 "reflectivity",
                                 "reflectance",
                                 "ambient",
                                 "ring",
                                 "laser_id",
                                 "return_number",
                                 "return_num",
                                 "num_returns",
                                 "number_of_returns",
                                 "numberofreturns",
                                 "returnnumber",
                                 "scan_angle",
                                 "scan_angle_rank",
                                 "scanangle",
                                 "scanner_channel",
                                 "scan_direction_flag",
                                 "edge_of_flight_line",
                                 "synthetic",
                                 "keypoint",
                                 "key_point",
                                 "withheld",
                                 "overlap",
                                 "flag",
                                 "flags",
                                 "user_data",
                                 "userdata",
                                 "point_source_id",
                                 "source_id",
                                 "segment",
                                 "segment_id",
                                 "instance",
                                 "instance_id",
                                 "object_id",
                                 "semantic",
                                 "category",
                                 "confidence",
                                 "quality",
                                 "valid",
                                 "time",
                                 "timestamp",
                                 "gps_time"};
  for (char& c : name)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  if (name.starts_with("scalar_")) name.erase(0, 7);
  return std::find(kNames.begin(), kNames.end(), name) != kNames.end();
}

/// The name without its word for a channel: "_3" of "green_3". Nothing: it has none.
std::optional<std::string> without_channel(const std::string& name, std::size_t channel) {
  constexpr std::array<const char*, 3> kWords{"red", "green", "blue"};
  const std::size_t at = name.find(kWords[channel]);
  if (at == std::string::npos) return std::nullopt;
  return name.substr(0, at) + "|" + name.substr(at + std::string(kWords[channel]).size());
}

bool names_a_channel(const std::string& name) {
  for (std::size_t channel = 0; channel < 3; ++channel)
    if (without_channel(name, channel)) return true;
  return false;
}

/// Names that speak of channels must speak of those of one view.
bool is_one_view(const PlyElement& vertex, const std::size_t* triple) {
  const auto name = [&](std::size_t k) -> const std::string& {
    return vertex.properties[triple[k]].name;
  };
  if (!names_a_channel(name(0)) || !names_a_channel(name(1)) || !names_a_channel(name(2)))
    return true;
  const auto red = without_channel(name(0), 0);
  return red && red == without_channel(name(1), 1) && red == without_channel(name(2), 2);
}

/// Places of bytes that are no part of the own colour, in file order.
std::vector<std::size_t> further_bytes(const PlyElement& vertex, const PlyColumns& columns,
                                       PlenopticNames names) {
  std::vector<std::size_t> bytes;
  for (std::size_t p = 0; p < vertex.properties.size(); ++p) {
    const PlyProperty& property = vertex.properties[p];
    if (!property.is_list && property.type == PlyType::kUint8 && !columns.wanted[p] &&
        !(names == PlenopticNames::kNoneOfScans && is_of_scans(property.name)))
      bytes.push_back(p);
  }
  if (bytes.size() % 3 == 1)
    std::erase_if(bytes, [&](std::size_t p) { return is_alpha(vertex.properties[p].name); });
  return bytes;
}

void describe_columns(const PlyElement& vertex, const std::vector<std::size_t>& bytes,
                      PlenopticColumns& columns) {
  const auto name = [&](std::size_t i) { return vertex.properties[bytes[i]].name; };
  columns.taken = std::to_string(columns.views) + (columns.views == 1 ? " view: " : " views: ") +
                  name(0) + " " + name(1) + " " + name(2);
  if (columns.views > 1) columns.taken += " ... " + name(bytes.size() - 1);
  if (columns.own_colour) columns.taken += ", and red green blue";
  for (std::size_t p = 0; p < vertex.properties.size(); ++p)
    if (!columns.place[p] && columns.left_out.size() < kMostNames)
      columns.left_out += (columns.left_out.empty() ? "" : ", ") + vertex.properties[p].name;
}

}  // namespace

Result<PlenopticColumns, InputError> plenoptic_columns(const PlyElement& vertex,
                                                       PlenopticNames names) {
  const PlyColumns cloud = ply_columns(vertex);
  PlenopticColumns columns;
  columns.place.resize(vertex.properties.size());
  const bool splats =
      std::any_of(vertex.properties.begin(), vertex.properties.end(),
                  [](const PlyProperty& property) { return property.name == "f_dc_0"; });
  const bool positions = cloud.present[0] && cloud.present[1] && cloud.present[2];
  const std::vector<std::size_t> bytes = further_bytes(vertex, cloud, names);
  columns.own_colour = cloud.colours && cloud.type[kPlyColour] == PlyType::kUint8 &&
                       cloud.type[kPlyColour + 1] == PlyType::kUint8 &&
                       cloud.type[kPlyColour + 2] == PlyType::kUint8;
  if (splats || !positions || bytes.size() < (columns.own_colour ? 3u : 6u)) return columns;
  if (bytes.size() % 3 != 0)
    return invalid_input(
        std::to_string(bytes.size()) + " further properties of 8 bits (" +
        vertex.properties[bytes.front()].name + " ... " + vertex.properties[bytes.back()].name +
        ") are no whole triples: a view has three of them, one after the other (--as colour takes "
        "red, green, blue alone)");
  columns.views = bytes.size() / 3;
  for (const PlyProperty& property : vertex.properties)  // names become metadata, which are UTF-8
    if (std::any_of(property.name.begin(), property.name.end(),
                    [](char c) { return c <= ' ' || c > '~'; }))
      return invalid_input("a property's name has characters beyond ASCII: rename it");
  if (columns.views > kMostViews)
    return invalid_input(std::to_string(columns.views) + " views, of which " +
                         std::to_string(kMostViews) + " are the most");
  for (std::size_t view = 0; view < columns.views; ++view)
    if (!is_one_view(vertex, &bytes[3 * view]))
      return invalid_input(
          "view " + std::to_string(view) + " would be " + vertex.properties[bytes[3 * view]].name +
          ", " + vertex.properties[bytes[3 * view + 1]].name + ", " +
          vertex.properties[bytes[3 * view + 2]].name + ": a colour is missing or out of order");
  for (std::size_t p = 0; p < vertex.properties.size(); ++p)
    if (cloud.wanted[p] && *cloud.wanted[p] < 3)
      columns.place[p] = *cloud.wanted[p];
    else if (cloud.wanted[p] && *cloud.wanted[p] >= kPlyColour && columns.own_colour)
      columns.place[p] = 3 + *cloud.wanted[p] - kPlyColour;
  for (std::size_t i = 0; i < bytes.size(); ++i)
    columns.place[bytes[i]] = 3 + i + (columns.own_colour ? 3 : 0);
  describe_columns(vertex, bytes, columns);
  return columns;
}

}  // namespace slf
