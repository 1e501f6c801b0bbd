// SPDX-License-Identifier: Apache-2.0
// Source: ASTM E2807-11, 8.4; names of normals: the extension "nor" of libE57.
#include "capture/e57_reader.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include "base/quaternion.h"
#include "capture/e57_file.h"
#include "capture/exact_positions.h"
#include "capture/wkt.h"
#include "capture/xml.h"

namespace slf {

namespace {

constexpr std::uint64_t kMostRows = std::uint64_t{1} << 32;

/// A number as XML has it; what stands in its place where there is none.
template <class T>
std::optional<T> xml_number(std::string_view text, T otherwise) {
  const std::size_t first = text.find_first_not_of(" \t\r\n+");
  if (first == text.npos) return otherwise;
  text = text.substr(first, text.find_last_not_of(" \t\r\n") + 1 - first);
  T value{};
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || stop != text.data() + text.size()) return std::nullopt;
  return value;
}

template <class T>
std::optional<T> attribute_of(const XmlElement& element, const char* name, T otherwise) {
  const std::string* text = element.attribute(name);
  return text == nullptr ? std::optional(otherwise) : xml_number(*text, otherwise);
}

/// The number in a child; `otherwise` where there is no such child.
double child_number(const XmlElement& element, const char* name, double otherwise) {
  const XmlElement* child = element.child(name);
  if (child == nullptr) return otherwise;
  return xml_number(child->text, 0.0).value_or(std::numeric_limits<double>::quiet_NaN());
}

std::optional<E57Column> column_of(const XmlElement& field) {
  const std::string* type = field.attribute("type");
  E57Column column;
  column.name = field.name;
  if (type != nullptr && *type == "Float") {
    const std::string* precision = field.attribute("precision");
    column.kind = precision != nullptr && *precision == "single" ? E57Column::Kind::kSingle
                                                                 : E57Column::Kind::kDouble;
    return column;
  }
  if (type == nullptr || (*type != "Integer" && *type != "ScaledInteger")) return std::nullopt;
  using Limits = std::numeric_limits<std::int64_t>;
  const auto minimum = attribute_of(field, "minimum", Limits::min()),
             maximum = attribute_of(field, "maximum", Limits::max());
  const auto scale = attribute_of(field, "scale", 1.0), offset = attribute_of(field, "offset", 0.0);
  if (!minimum || !maximum || !scale || !offset || *minimum > *maximum) return std::nullopt;
  column.minimum = *minimum;
  column.maximum = *maximum;
  if (*type == "ScaledInteger") {
    column.scale = *scale;
    column.offset = *offset;
  }
  return column;
}

using Three = std::array<std::size_t, 3>;  // columns

/// Adds the points of one cloud after the other.
class E57Points {
 public:
  Result<Done, InputError> add(E57File& file, const XmlElement& cloud, std::string label) {
    label_ = std::move(label);
    const XmlElement* points = cloud.child("points");
    const XmlElement* prototype = points == nullptr ? nullptr : points->child("prototype");
    if (prototype == nullptr) return invalid("has no points with a prototype");
    const auto offset = attribute_of<std::uint64_t>(*points, "fileOffset", 0),
               rows = attribute_of<std::uint64_t>(*points, "recordCount", 0);
    if (!offset || !rows || *rows > kMostRows)
      return invalid("fileOffset or recordCount is damaged");
    std::vector<E57Column> columns;
    for (const XmlElement& field : prototype->children) {
      auto column = column_of(field);
      if (!column)
        return invalid(field.name.substr(0, 80) + " is of a type that points do not have");
      columns.push_back(*std::move(column));
    }
    columns_ = columns;
    if (*rows == 0) return Done{};
    SLF_CHECK(read_pose(cloud));
    SLF_TRY(const E57Columns values, file.read(*offset, *rows, std::move(columns)));
    return take(values, cloud);
  }

  std::size_t invalid_points() const { return unmeasured_; }
  bool lost_colours() const { return !colours_ && any_colours_; }

  PointCloud cloud() {
    PointCloud out;
    set_positions(positions_, out);
    if (colours_) out.colours = std::move(cloud_.colours);
    if (normals_) out.normals = std::move(cloud_.normals);
    return out;
  }

 private:
  std::optional<std::size_t> column(std::string_view name) const {
    for (std::size_t c = 0; c < columns_.size(); ++c)
      if (columns_[c].name == name) return c;
    return std::nullopt;
  }

  std::optional<Three> three(const std::array<const char*, 3>& names) const {
    Three found{};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto at = column(names[k]);
      if (!at) return std::nullopt;
      found[k] = *at;
    }
    return found;
  }

  /// Rotation and translation to the world of the file.
  Result<Done, InputError> read_pose(const XmlElement& cloud) {
    rotation_ = rotation_of(std::array<double, 4>{1, 0, 0, 0});
    translation_ = {0, 0, 0};
    const XmlElement* pose = cloud.child("pose");
    if (pose == nullptr) return Done{};
    if (const XmlElement* r = pose->child("rotation")) {
      const std::array q{child_number(*r, "w", 1), child_number(*r, "x", 0),
                         child_number(*r, "y", 0), child_number(*r, "z", 0)};
      const double square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
      if (!(square > 1e-12 && square < 1e12)) return invalid("the rotation of its pose is none");
      rotation_ = rotation_of(q);
    }
    if (const XmlElement* t = pose->child("translation"))
      translation_ = {child_number(*t, "x", 0), child_number(*t, "y", 0), child_number(*t, "z", 0)};
    for (const double v : translation_)
      if (!std::isfinite(v)) return invalid("the translation of its pose is not finite");
    return Done{};
  }

  /// Darkest and brightest of a channel: as the cloud says, else as its type has them.
  std::array<double, 2> limits_of(const XmlElement& cloud, std::size_t column,
                                  const std::string& channel) const {
    const E57Column& c = columns_[column];
    const bool whole = c.kind == E57Column::Kind::kInteger;
    std::array<double, 2> limits{whole ? double(c.minimum) * c.scale + c.offset : 0,
                                 whole ? double(c.maximum) * c.scale + c.offset : 1};
    if (const XmlElement* given = cloud.child("colorLimits")) {
      limits[0] = child_number(*given, ("color" + channel + "Minimum").c_str(), limits[0]);
      limits[1] = child_number(*given, ("color" + channel + "Maximum").c_str(), limits[1]);
    }
    return limits[1] > limits[0] ? limits : std::array<double, 2>{0, 255};
  }

  Result<Done, InputError> take(const E57Columns& values, const XmlElement& cloud) {
    const auto cartesian = three({"cartesianX", "cartesianY", "cartesianZ"});
    const auto spherical = three({"sphericalRange", "sphericalAzimuth", "sphericalElevation"});
    if (!cartesian && !spherical) return invalid("has neither cartesian nor spherical coordinates");
    const auto unmeasured = column(cartesian ? "cartesianInvalidState" : "sphericalInvalidState");
    const auto colour = three({"colorRed", "colorGreen", "colorBlue"});
    const auto normal = three({"nor:normalX", "nor:normalY", "nor:normalZ"});
    colours_ = colours_ && colour;
    any_colours_ = any_colours_ || colour;
    normals_ = normals_ && normal;
    std::array<std::array<double, 2>, 3> limits{};
    for (std::size_t k = 0; colour && k < 3; ++k)
      limits[k] = limits_of(cloud, (*colour)[k], std::array{"Red", "Green", "Blue"}[k]);
    for (std::size_t row = 0; row < values.rows(); ++row) {
      Vec3 at{};
      for (std::size_t k = 0; k < 3; ++k)
        at[k] = values.value((cartesian ? *cartesian : *spherical)[k], row);
      if (!cartesian)  // range, azimuth, elevation
        at = {at[0] * std::cos(at[2]) * std::cos(at[1]), at[0] * std::cos(at[2]) * std::sin(at[1]),
              at[0] * std::sin(at[2])};
      if ((unmeasured && values.value(*unmeasured, row) != 0) ||
          !std::isfinite(at[0] + at[1] + at[2])) {
        ++unmeasured_;
        continue;
      }
      positions_.push_back(moved_by_pose(at, translation_));
      if (colours_) add_colour(values, *colour, row, limits);
      if (normals_) add_normal(values, *normal, row);
    }
    return Done{};
  }

  Vec3 moved_by_pose(const Vec3& v, const Vec3& by) const {
    Vec3 out = by;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t k = 0; k < 3; ++k) out[i] += rotation_[i][k] * v[k];
    return out;
  }

  void add_colour(const E57Columns& values, const Three& columns, std::size_t row,
                  const std::array<std::array<double, 2>, 3>& limits) {
    std::array<std::uint8_t, 3> colour{};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& [low, high] = limits[k];
      const double share = (values.value(columns[k], row) - low) / (high - low);
      colour[k] = static_cast<std::uint8_t>(
          std::lround(share >= 0 ? 255 * std::min(share, 1.0) : 0));  // what is not finite: 0
    }
    cloud_.colours.push_back(colour);
  }

  void add_normal(const E57Columns& values, const Three& columns, std::size_t row) {
    Vec3 n{};
    for (std::size_t k = 0; k < 3; ++k) n[k] = values.value(columns[k], row);
    n = moved_by_pose(n, {0, 0, 0});
    cloud_.normals.push_back({float(n[0]), float(n[1]), float(n[2])});
  }

  InputError invalid(const std::string& cause) const {
    return {Errc::kInvalidInput, label_ + ": " + cause};
  }

  std::string label_;
  std::vector<E57Column> columns_;  // of the cloud that is added
  Matrix3x3 rotation_{};
  Vec3 translation_{};
  std::vector<Vec3> positions_;
  PointCloud cloud_;  // colours and normals
  bool colours_ = true, normals_ = true, any_colours_ = false;
  std::size_t unmeasured_ = 0;
};

}  // namespace

Result<Scan, InputError> read_e57(const std::filesystem::path& path,
                                  std::vector<std::string>* warnings) {
  const std::string name = path.string();
  SLF_TRY(E57File file, E57File::open(path));
  if (file.xml().size() > kMaxXmlBytes)
    return InputError{Errc::kLimitExceeded, name + ": its XML is above 32 MiB"};
  SLF_TRY(const XmlElement root, parse_xml(name, file.xml()));
  const XmlElement* clouds = root.child("data3D");
  if (clouds == nullptr || clouds->children.empty())
    return InputError{Errc::kInvalidInput, name + ": data3D has no cloud"};
  E57Points points;
  for (std::size_t i = 0; i < clouds->children.size(); ++i)
    SLF_CHECK(points.add(file, clouds->children[i], name + ": data3D[" + std::to_string(i) + "]"));
  Scan scan;
  scan.points.vertices = points.cloud();
  if (const XmlElement* crs = root.child("coordinateMetadata"); crs != nullptr && is_wkt(crs->text))
    scan.crs = crs->text;
  if (warnings == nullptr) return scan;
  if (points.invalid_points() > 0)
    warnings->push_back(name + ": " + std::to_string(points.invalid_points()) +
                        " points were not measured: left out");
  if (points.lost_colours())
    warnings->push_back(name +
                        ": some of its clouds have no colours: those of the others are left out");
  return scan;
}

}  // namespace slf
