// SPDX-License-Identifier: Apache-2.0
// Cameras as Metashape exports them (XML): a pose is camera to chunk, x right, y down, z forward;
// the chunk or its component is put into the world by a similarity. Source: Metashape manual,
// appendix "Camera models"; its scripting reference for Chunk.transform.
#include <charconv>
#include <cmath>
#include <map>
#include <string_view>

#include "capture/importer.h"
#include "capture/photograph_names.h"
#include "capture/ply_header.h"
#include "capture/radial_distortion.h"
#include "capture/xml.h"

namespace slf {

namespace {

namespace fs = std::filesystem;

constexpr double kMostSkew = 0.25;   // pixels at an edge that b2 may shift and nobody sees
constexpr double kGeocentric = 1e6;  // metres: further from the origin a chunk is on the globe

/// x_world = scale rotation x_chunk + translation
struct Similarity {
  std::array<double, 9> rotation{1, 0, 0, 0, 1, 0, 0, 0, 1};
  std::array<double, 3> translation{};
  double scale = 1;
};

/// Reads one document; what it says of an element is said with the file and the line.
class MetashapeReader {
 public:
  explicit MetashapeReader(const fs::path& file) : file_(file) {}

  Result<Import, InputError> read(const XmlElement& root) {
    const XmlElement* chunk = root.child("chunk");
    if (root.name != "document" || chunk == nullptr)
      return invalid(root, "no document with a chunk of Metashape's cameras");
    const XmlElement* cameras = chunk->child("cameras");
    if (cameras == nullptr) return invalid(*chunk, "the chunk has no cameras");
    import_.capture.root = file_.parent_path();
    SLF_CHECK(read_sensors(*chunk));
    SLF_CHECK(read_placements(*chunk));
    SLF_CHECK(add_cameras(*cameras, 0));
    auto& warnings = import_.capture.warnings;
    if (std::count_if(root.children.begin(), root.children.end(),
                      [](const auto& child) { return child.name == "chunk"; }) > 1)
      warnings.push_back(file_.string() + ": several chunks: the first is taken");
    if (auto warning = radial_warning(file_.string(), worst_); !warning.empty())
      warnings.push_back(std::move(warning));
    if (geocentric_)
      warnings.push_back(file_.string() +
                         ": the chunk is georeferenced, cameras are given from the centre of the "
                         "earth: export cloud or mesh in these coordinates too");
    warn_of_left_out(file_.string(), seen_ - import_.capture.cameras.size(), seen_, import_);
    return std::move(import_);
  }

 private:
  InputError invalid(const XmlElement& at, const std::string& cause) const {
    return {Errc::kInvalidInput,
            file_.string() + ": line " + std::to_string(at.line) + ": " + cause};
  }

  /// Numbers with white space between them.
  template <std::size_t N>
  Result<std::array<double, N>, InputError> numbers(const XmlElement& in) const {
    const auto words = words_of(in.text);
    std::array<double, N> values{};
    if (words.size() != N)
      return invalid(in, "<" + in.name + "> has to hold " + std::to_string(N) + " numbers");
    for (std::size_t i = 0; i < N; ++i) {
      const auto [stop, error] =
          std::from_chars(words[i].data(), words[i].data() + words[i].size(), values[i]);
      if (error != std::errc() || stop != words[i].data() + words[i].size() ||
          !std::isfinite(values[i]))
        return invalid(in, "<" + in.name + "> holds what is no number");
    }
    return values;
  }

  /// A number of a calibration: what is not there is 0.
  Result<double, InputError> term(const XmlElement& calibration, const char* name) const {
    const XmlElement* found = calibration.child(name);
    if (found == nullptr) return 0.0;
    SLF_TRY(const auto value, numbers<1>(*found));
    return value[0];
  }

  Result<int, InputError> side(const XmlElement& resolution, const char* name) const {
    const std::string* text = resolution.attribute(name);
    int value = 0;
    const char* end = text == nullptr ? nullptr : text->data() + text->size();
    if (text == nullptr || std::from_chars(text->data(), end, value).ptr != end || value < 1 ||
        value > 65535)
      return invalid(resolution, std::string(name) + " of 1 to 65535 pixels is expected");
    return value;
  }

  Result<Done, InputError> read_sensors(const XmlElement& chunk) {
    const XmlElement* sensors = chunk.child("sensors");
    if (sensors == nullptr) return invalid(chunk, "the chunk has no sensors");
    for (const XmlElement& sensor : sensors->children)
      if (const std::string* id = sensor.attribute("id")) sensors_.emplace(*id, &sensor);
    return Done{};
  }

  /// Where the chunk and its components are; they may say nothing.
  Result<Done, InputError> read_placements(const XmlElement& chunk) {
    SLF_TRY(chunk_, placement(chunk));
    const XmlElement* components = chunk.child("components");
    if (components == nullptr) return Done{};
    for (const XmlElement& component : components->children)
      if (const std::string* id = component.attribute("id");
          id != nullptr && component.child("transform") != nullptr) {
        SLF_TRY(components_[*id], placement(component));
      }
    return Done{};
  }

  Result<Similarity, InputError> placement(const XmlElement& of) {
    Similarity result;
    const XmlElement* transform = of.child("transform");
    if (transform == nullptr) return result;
    if (const XmlElement* rotation = transform->child("rotation")) {
      SLF_TRY(result.rotation, numbers<9>(*rotation));
    }
    if (const XmlElement* translation = transform->child("translation")) {
      SLF_TRY(result.translation, numbers<3>(*translation));
    }
    if (const XmlElement* scale = transform->child("scale")) {
      SLF_TRY(const auto value, numbers<1>(*scale));
      result.scale = value[0];
      if (!(result.scale > 0)) return invalid(*scale, "the scale is not positive");
    }
    return result;
  }

  /// Cameras stand in groups too.
  Result<Done, InputError> add_cameras(const XmlElement& list, int depth) {
    for (const XmlElement& item : list.children) {
      if (item.name == "group" && depth < 8) SLF_CHECK(add_cameras(item, depth + 1));
      if (item.name == "camera") SLF_CHECK(add_camera(item));
    }
    return Done{};
  }

  Result<Done, InputError> add_camera(const XmlElement& item) {
    ++seen_;
    const XmlElement* transform = item.child("transform");
    const std::string* label = item.attribute("label");
    if (transform == nullptr || words_of(transform->text).empty()) return Done{};
    if (label == nullptr) return invalid(item, "a camera without a label");
    Camera camera;
    camera.name = *label;
    SLF_CHECK(read_calibration(item, camera));
    SLF_CHECK(read_metashape_pose(item, *transform, camera));
    import_.images.push_back(find_photograph(import_.capture.root, *label));
    import_.labels.push_back(file_.string() + ": line " + std::to_string(item.line) + ": camera '" +
                             label->substr(0, 80) + "'");
    import_.capture.cameras.push_back(std::move(camera));
    return Done{};
  }

  Result<Done, InputError> read_calibration(const XmlElement& item, Camera& camera) {
    const std::string* id = item.attribute("sensor_id");
    const auto sensor = id == nullptr ? sensors_.end() : sensors_.find(*id);
    if (sensor == sensors_.end()) return invalid(item, "there is no such sensor");
    const XmlElement& its = *sensor->second;
    const std::string* type = its.attribute("type");
    if (type != nullptr && *type != "frame")
      return invalid(its, "a sensor of type " + type->substr(0, 40) +
                              ": frame cameras alone are read; export undistorted photographs");
    // The adjusted one stands before or behind the one that it began with.
    const XmlElement* calibration = nullptr;
    for (const XmlElement& each : its.children)
      if (const std::string* kind = each.attribute("class");
          each.name == "calibration" &&
          (calibration == nullptr || (kind != nullptr && *kind == "adjusted")))
        calibration = &each;
    if (calibration == nullptr) return invalid(its, "a sensor without a calibration");
    const XmlElement* resolution = calibration->child("resolution");
    if (resolution == nullptr) resolution = its.child("resolution");
    if (resolution == nullptr) return invalid(its, "a sensor without a resolution");
    SLF_TRY(camera.width, side(*resolution, "width"));
    SLF_TRY(camera.height, side(*resolution, "height"));
    return read_lens(*calibration, camera);
  }

  /// u = width / 2 + cx + x (f + b1) + y b2, v = height / 2 + cy + y f
  Result<Done, InputError> read_lens(const XmlElement& calibration, Camera& camera) {
    SLF_TRY(const double f, term(calibration, "f"));
    SLF_TRY(const double b1, term(calibration, "b1"));
    SLF_TRY(const double b2, term(calibration, "b2"));
    SLF_TRY(const double cx, term(calibration, "cx"));
    SLF_TRY(const double cy, term(calibration, "cy"));
    camera.fx = f + b1;
    camera.fy = f;
    if (!(camera.fx > 0 && camera.fy > 0))
      return invalid(calibration, "the calibration has no f above 0");
    camera.cx = 0.5 * camera.width + cx;
    camera.cy = 0.5 * camera.height + cy;
    if (std::abs(b2) * 0.5 * camera.height / f > kMostSkew)
      return invalid(calibration, "skew (b2) is not supported: optimise the cameras without it");
    RadialTerms radial{};
    constexpr std::array kNames{"k1", "k2", "k3", "k4"};
    for (std::size_t i = 0; i < kNames.size(); ++i) {
      SLF_TRY(radial[i], term(calibration, kNames[i]));
    }
    // Its p1 is the p2 of OpenCV, and the other way round.
    SLF_TRY(camera.distortion[3], term(calibration, "p1"));
    SLF_TRY(camera.distortion[2], term(calibration, "p2"));
    return set_radial(radial, invalid(calibration, "calibration").message, camera, worst_);
  }

  Result<Done, InputError> read_metashape_pose(const XmlElement& item, const XmlElement& transform,
                                               Camera& camera) {
    SLF_TRY(const auto m, numbers<16>(transform));
    if (m[12] != 0 || m[13] != 0 || m[14] != 0 || m[15] != 1)
      return invalid(transform, "the last row is not 0 0 0 1");
    const std::string* component = item.attribute("component_id");
    const auto own = component == nullptr ? components_.end() : components_.find(*component);
    const Similarity& at = own == components_.end() ? chunk_ : own->second;
    Vec3 centre = at.translation;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) {
        centre[i] += at.scale * at.rotation[3 * i + j] * m[4 * j + 3];
        camera.rotation[j][i] = 0;  // world to camera: the transpose
        for (std::size_t k = 0; k < 3; ++k)
          camera.rotation[j][i] += at.rotation[3 * i + k] * m[4 * k + j];
      }
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t k = 0; k < 3; ++k)
        camera.translation[i] -= camera.rotation[i][k] * centre[k];
    geocentric_ = geocentric_ || std::hypot(centre[0], centre[1], centre[2]) > kGeocentric;
    return Done{};
  }

  fs::path file_;
  std::map<std::string, const XmlElement*> sensors_;  // by id
  std::map<std::string, Similarity> components_;      // by id
  Similarity chunk_;
  std::size_t seen_ = 0;
  double worst_ = 0;
  bool geocentric_ = false;
  Import import_;
};

}  // namespace

Result<Import, InputError> import_metashape(const fs::path& file) {
  SLF_TRY(const auto bytes, read_file(file, kMaxXmlBytes));
  SLF_TRY(const XmlElement root, parse_xml(file.string(), bytes));
  return MetashapeReader(file).read(root);
}

}  // namespace slf
