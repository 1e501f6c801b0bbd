// SPDX-License-Identifier: Apache-2.0
#include "tools/describe.h"

#include <algorithm>

#include "slf/view_map.h"
#include "tools/text.h"

namespace slf::tools {
namespace {

const char* name_of(Directions directions) {
  return directions == Directions::kReflected ? "reflected" : "world";
}

const char* name_of(UpAxis up) {
  switch (up) {
    case UpAxis::kPlusX:
      return "+x";
    case UpAxis::kMinusX:
      return "-x";
    case UpAxis::kPlusY:
      return "+y";
    case UpAxis::kMinusY:
      return "-y";
    case UpAxis::kPlusZ:
      return "+z";
    case UpAxis::kMinusZ:
      return "-z";
    case UpAxis::kUnknown:
      break;
  }
  return "unknown";
}

const char* name_of(AttributeId id) {
  return id == AttributeId::kOpacity ? "opacity"
         : id == AttributeId::kShape ? "shape"
                                     : "without a meaning";
}

const char* name_of(Transfer transfer) {
  return transfer == Transfer::kLinear ? "linear" : "display";
}

const char* name_of(ColourTransform colour) {
  return colour == ColourTransform::kOpponent ? "opponent" : "none";
}

struct TypeTotal {
  std::string type;
  std::uint64_t units = 0, bytes = 0;
};

/// In the order in which types first appear in the stream.
std::vector<TypeTotal> totals(const StreamInfo& info) {
  std::vector<TypeTotal> list;
  for (const UnitInfo& unit : info.units) {
    auto found = std::find_if(list.begin(), list.end(),
                              [&](const TypeTotal& t) { return t.type == unit.type; });
    if (found == list.end()) found = list.insert(list.end(), {unit.type, 0, 0});
    ++found->units;
    found->bytes += unit.bytes;
  }
  return list;
}

}  // namespace

nlohmann::ordered_json attributes_json(const LightFieldHeader& h) {
  auto list = nlohmann::ordered_json::array();
  for (const Attribute& a : h.attributes)
    list.push_back({{"id", static_cast<int>(a.id)}, {"functions", a.num_functions}});
  return list;
}

nlohmann::ordered_json header_json(const LightFieldHeader& h) {
  nlohmann::ordered_json json;
  json["grid"] = {{"origin", h.grid.origin}, {"step", h.grid.step}, {"bits", h.grid.bits}};
  json["up"] = name_of(h.up);
  json["right_handed"] = h.right_handed;
  json["metres_per_unit"] = h.metres_per_unit;
  json["num_functions"] = h.num_functions;
  json["shift"] = h.shift;
  json["num_components"] = h.num_components();
  json["has_basis"] = h.has_basis && h.num_functions > 0;
  if (!h.attributes.empty()) json["attributes"] = attributes_json(h);
  if (!h.has_basis || h.num_functions == 0) return json;
  if (h.basis.id == BasisId::kHarmonics) {
    json["basis"] = {{"id", "harmonics"}, {"degree", h.basis.degree}};
  } else {
    json["basis"] = {{"id", "bspline"},
                     {"order", h.basis.order},
                     {"scales_theta", h.basis.scales_theta},
                     {"scales_gamma", h.basis.scales_gamma}};
  }
  json["directions"] = name_of(h.directions);
  if (h.directions == Directions::kReflected) json["normal_cell"] = 1 << h.normal_cell_log2;
  json["colour"] = {{"transform", name_of(h.colour)}, {"to_rgb", colour_matrix(h.colour)}};
  json["transfer"] = name_of(h.transfer);
  json["gamma_range"] = {h.gamma_min_q7 / 127.0, h.gamma_max_q7 / 127.0};
  return json;
}

std::string header_text(const LightFieldHeader& h) {
  std::string out = text(
      "  grid          %d bits per axis, step %g, origin %.10g %.10g %.10g, up %s, "
      "%s-handed\n",
      h.grid.bits, h.grid.step, h.grid.origin[0], h.grid.origin[1], h.grid.origin[2], name_of(h.up),
      h.right_handed ? "right" : "left");
  if (h.metres_per_unit > 0) out += text("  unit          %g metres\n", h.metres_per_unit);
  if (h.num_functions == 0) return out + "  planes        none: geometry alone\n";
  if (!h.has_basis)
    return out + text("  planes        %d x 3 integers without a basis\n", h.num_functions);
  const auto [low, high] = std::minmax_element(h.shift.begin(), h.shift.end());
  if (h.basis.id == BasisId::kHarmonics) {
    out += text("  basis         spherical harmonics of degree %d, %d functions, %s directions\n",
                h.basis.degree, h.num_view_functions(), name_of(h.directions));
  } else {
    out += text(
        "  basis         B-spline wavelets of order %d, %d x %d = %d functions, %s directions\n",
        h.basis.order, 1 << h.basis.scales_theta, 1 << h.basis.scales_gamma, h.num_view_functions(),
        name_of(h.directions));
  }
  for (const Attribute& a : h.attributes)
    out += text("  attribute     %s, %d function%s\n", name_of(a.id), a.num_functions,
                a.num_functions == 1 ? "" : "s");
  if (!h.shift.empty()) out += text("  shifts        %d to %d\n", *low, *high);
  out += text("  colour        transform %s, %s values; gamma %.3f to %.3f\n", name_of(h.colour),
              name_of(h.transfer), h.gamma_min_q7 / 127.0, h.gamma_max_q7 / 127.0);
  return out;
}

nlohmann::ordered_json metadata_json(const Metadata& metadata) {
  auto list = nlohmann::ordered_json::array();
  for (const auto& [key, value] : metadata) list.push_back({{"key", key}, {"value", value}});
  return list;
}

nlohmann::ordered_json settings_json(const StreamInfo& info) {
  nlohmann::ordered_json json = {{"grid_bits", info.header.grid.bits},
                                 {"geometry_coder", info.geometry_coder},
                                 {"coefficient_coder", info.coefficient_coder},
                                 {"colour", name_of(info.header.colour)}};
  for (const auto& [key, value] : info.metadata) json[key] = value;
  return json;
}

nlohmann::ordered_json density_json(const Grid& grid, const Density& density) {
  nlohmann::ordered_json json = {{"bits", grid.bits}, {"voxel_size", grid.step}};
  if (density.pixel > 0) {
    json["pixel_size"] = density.pixel;
    json["voxel_pixels"] = grid.step / density.pixel;
  }
  if (density.spacing > 0) json["cloud_spacing"] = density.spacing;
  json["limited_by_cloud"] = density.limited_by_cloud;
  json["densified"] = density.densified;
  return json;
}

std::string density_text(const Grid& grid, const Density& density) {
  std::string out = text("grid          %d bits per axis, voxels of %g", grid.bits, grid.step);
  if (density.pixel > 0) out += text(", %.2f pixels", grid.step / density.pixel);
  return out + (density.densified          ? ": points made up between the cloud's\n"
                : density.limited_by_cloud ? ": the cloud's spacing\n"
                                           : "\n");
}

constexpr std::uint64_t kSignatureBytes = 8;  // spec 7

nlohmann::ordered_json bytes_by_type_json(const StreamInfo& info, std::uint64_t file_bytes) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  std::uint64_t rest = file_bytes;
  for (const TypeTotal& total : totals(info)) {
    json[total.type] = total.bytes;
    rest -= std::min(rest, std::uint64_t{total.bytes});
  }
  if (rest > 0) json["signature"] = std::min(rest, kSignatureBytes);  // more are other frames'
  return json;
}

std::string bytes_by_type_text(const StreamInfo& info, std::uint64_t file_bytes) {
  std::string out = "bytes by unit type\n";
  std::uint64_t rest = file_bytes;
  const auto row = [&](const std::string& type, std::uint64_t units, std::uint64_t bytes) {
    const double share = 100.0 * static_cast<double>(bytes) /
                         static_cast<double>(std::max<std::uint64_t>(file_bytes, 1));
    out += text("  %-14s %12s  %6.2f %%  in %llu\n", type.c_str(), grouped(bytes).c_str(), share,
                static_cast<unsigned long long>(units));
    rest -= std::min(rest, bytes);
  };
  for (const TypeTotal& total : totals(info)) row(total.type, total.units, total.bytes);
  if (rest > 0) row("signature", 1, rest);
  return out;
}

double bits_per_point(std::uint64_t bytes, std::uint64_t points) {
  return points == 0 ? 0 : 8.0 * static_cast<double>(bytes) / static_cast<double>(points);
}

}  // namespace slf::tools
