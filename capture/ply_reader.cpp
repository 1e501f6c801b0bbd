// PLY to a point cloud or mesh, properties by name.
#include <array>
#include <cmath>
#include <optional>
#include <string_view>

#include "capture/exact_positions.h"
#include "capture/ply_body.h"
#include "capture/ply_faces.h"
#include "capture/ply_reader.h"
#include "slf/capture.h"

namespace slf {

namespace {

constexpr std::array<const char*, 9> kWanted{"x",  "y",   "z",     "nx",  "ny",
                                             "nz", "red", "green", "blue"};
constexpr std::array<const char*, 3> kNormalOfPdal{"normalx", "normaly", "normalz"};
constexpr std::size_t kNormal = 3, kColour = 6;  // where they begin in kWanted
constexpr std::size_t kMostHeader = std::size_t{1} << 20;
using Row = std::array<double, kWanted.size()>;

// Where each property of the vertex goes; which of the optional groups are there in full.
struct Columns {
  std::vector<std::optional<std::size_t>> wanted;  // [properties] index into kWanted
  std::array<PlyType, kWanted.size()> type{};
  std::array<bool, kWanted.size()> present{};
  bool normals = false, colours = false;
  bool exact = false;   // of x, y, z one may have more digits than a float
  std::string skipped;  // names, for the warning
};

std::optional<std::size_t> index_of(const std::string& name) {
  for (std::size_t i = 0; i < kWanted.size(); ++i)
    if (name == kWanted[i]) return i;
  for (std::size_t i = 0; i < kNormalOfPdal.size(); ++i)
    if (name == kNormalOfPdal[i]) return kNormal + i;
  return std::nullopt;
}

Columns columns_of(const PlyElement& vertex) {
  Columns columns;
  for (const auto& property : vertex.properties) {
    const auto found = property.is_list ? std::nullopt : index_of(property.name);
    if (found) {
      columns.present[*found] = true;
      columns.type[*found] = property.type;
    } else {
      columns.skipped += (columns.skipped.empty() ? "" : ", ") + property.name;
    }
    columns.wanted.push_back(found);
  }
  const auto all = [&](std::size_t first) {
    return columns.present[first] && columns.present[first + 1] && columns.present[first + 2];
  };
  for (std::size_t k = 0; k < 3; ++k) {
    const PlyType type = columns.type[k];
    columns.exact = columns.exact || type == PlyType::kDouble || type == PlyType::kInt32 ||
                    type == PlyType::kUint32;
  }
  columns.normals = all(kNormal);
  columns.colours = all(kColour);
  return columns;
}

// 0 .. 255 of a colour sample, whatever it is stored as; nothing if it is out of range.
std::optional<std::uint8_t> colour_of(PlyType type, double value) {
  double scale = 1;
  if (type == PlyType::kUint16) scale = 1.0 / 257;
  if (type == PlyType::kFloat || type == PlyType::kDouble) scale = 255;
  const double scaled = std::floor(value * scale + 0.5);
  if (!(value >= 0 && scaled <= 255)) return std::nullopt;
  return static_cast<std::uint8_t>(scaled);
}

class VertexReader {
 public:
  VertexReader(const std::string& name, const PlyElement& vertex)
      : name_(name), vertex_(vertex), columns_(columns_of(vertex)) {}

  Result<Done, InputError> read(PlyBody& body) {
    if (!columns_.present[0] || !columns_.present[1] || !columns_.present[2])
      return invalid("PLY vertex without x, y and z");
    const auto count = static_cast<std::size_t>(vertex_.count);  // bounded by the file's size
    if (columns_.exact)
      exact_.reserve(count);
    else
      cloud.positions.reserve(count);
    if (columns_.normals) cloud.normals.reserve(count);
    if (columns_.colours) cloud.colours.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
      Row row{};
      for (std::size_t p = 0; p < vertex_.properties.size(); ++p) {
        const auto& property = vertex_.properties[p];
        double value = 0;
        if (!(property.is_list ? body.skip_list(property) : body.value(property.type, value)))
          return invalid(at(i, property.name) + " is missing or damaged");
        if (!columns_.wanted[p]) continue;
        if (!std::isfinite(value)) return invalid(at(i, property.name) + " is not finite");
        row[*columns_.wanted[p]] = value;
      }
      SLF_CHECK(add(i, row));
    }
    if (columns_.exact) set_positions(exact_, cloud);
    return Done{};
  }

  void warn(std::vector<std::string>& warnings) {
    if (!columns_.skipped.empty())
      warnings.push_back(name_ + ": properties skipped: " + columns_.skipped);
    const auto some = [&](std::size_t first) {
      return columns_.present[first] || columns_.present[first + 1] || columns_.present[first + 2];
    };
    if (some(kNormal) && !columns_.normals)
      warnings.push_back(name_ + ": not all of nx, ny, nz are there: normals ignored");
    if (some(kColour) && !columns_.colours)
      warnings.push_back(name_ + ": not all of red, green, blue are there: colours ignored");
    if (zero_normals_ > 0)
      warnings.push_back(name_ + ": " + std::to_string(zero_normals_) +
                         " normals have length 0: normals ignored");
    else if (other_normals_ > 0)
      warnings.push_back(name_ + ": " + std::to_string(other_normals_) +
                         " normals are not of unit length: normalised");
  }

  // Normals are usable as a whole or not at all.
  void drop_unusable_normals() {
    if (zero_normals_ > 0) cloud.normals.clear();
  }

  PointCloud cloud;

 private:
  Result<Done, InputError> add(std::size_t i, const Row& row) {
    std::array<float, 3> position{};
    for (std::size_t k = 0; k < 3; ++k) {
      position[k] = static_cast<float>(row[k]);
      if (!std::isfinite(position[k]))
        return invalid(at(i, kWanted[k]) + " is not finite as a float");
    }
    if (columns_.exact)
      exact_.push_back({row[0], row[1], row[2]});
    else
      cloud.positions.push_back(position);
    if (columns_.normals) add_normal(row);
    if (!columns_.colours) return Done{};
    std::array<std::uint8_t, 3> colour{};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto sample = colour_of(columns_.type[kColour + k], row[kColour + k]);
      if (!sample) return invalid(at(i, kWanted[kColour + k]) + " is out of range");
      colour[k] = *sample;
    }
    cloud.colours.push_back(colour);
    return Done{};
  }

  void add_normal(const Row& row) {
    const double x = row[kNormal], y = row[kNormal + 1], z = row[kNormal + 2];
    const double length = std::hypot(x, y, z);
    if (!(length > 0) || !std::isfinite(length)) {
      ++zero_normals_;
      cloud.normals.push_back({0, 0, 1});
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
  Columns columns_;
  std::vector<Vec3> exact_;  // [P] positions until all are known, where columns_.exact
  std::size_t zero_normals_ = 0, other_normals_ = 0;
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
  std::optional<PointCloud> cloud;
  Mesh mesh;
  for (const auto& element : header.elements) {
    if (element.name == "vertex") {
      if (element.count == 0) return InputError{Errc::kInvalidInput, name + ": no points"};
      VertexReader reader(name, element);
      SLF_CHECK(reader.read(body));
      if (warnings != nullptr) reader.warn(*warnings);
      reader.drop_unusable_normals();
      cloud = std::move(reader.cloud);
    } else if (with_faces && element.name == "face") {
      SLF_TRY(mesh.triangles, read_ply_faces(name, element, body));
    } else if (!body.skip_element(element)) {
      return InputError{Errc::kInvalidInput,
                        name + ": PLY element '" + element.name + "' is cut off or damaged"};
    }
  }
  if (!cloud) return InputError{Errc::kInvalidInput, name + ": PLY without vertices"};
  mesh.vertices = *std::move(cloud);
  return mesh;
}

Result<PointCloud, InputError> read_ply(const std::filesystem::path& file,
                                        std::vector<std::string>* warnings) {
  SLF_TRY(Mesh mesh, read_ply_mesh(file, false, warnings));
  return std::move(mesh.vertices);
}

}  // namespace slf
