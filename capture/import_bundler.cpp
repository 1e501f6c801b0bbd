// SPDX-License-Identifier: Apache-2.0
// Bundler's bundle.out: x right, y up, looking along -z, pixels from the centre of the picture.
// Photographs are named by list.txt. Source: Bundler 0.4, README, "Output format".
#include <charconv>
#include <cmath>
#include <string_view>

#include "capture/exact_positions.h"
#include "capture/file_names.h"
#include "capture/image_formats.h"
#include "capture/importer.h"
#include "capture/photograph_names.h"
#include "capture/ply_header.h"

namespace slf {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kCameraBytes = 30;  // at the least: 15 numbers and what parts them
constexpr std::size_t kPointBytes = 14;

/// The words of a file, one after the other.
class BundleWords {
 public:
  BundleWords(std::string name, std::span<const std::uint8_t> bytes)
      : name_(std::move(name)), text_(reinterpret_cast<const char*>(bytes.data()), bytes.size()) {
    text_.remove_prefix(std::min(text_.find('\n'), text_.size()));  // "# Bundle file v0.3"
  }

  std::size_t bytes_left() const { return text_.size(); }

  /// @param what  for messages: "camera 3: k1"
  template <class T>
  Result<T, InputError> number(const std::string& what) {
    text_.remove_prefix(std::min(text_.find_first_not_of(" \t\r\n"), text_.size()));
    T value{};
    const char* end = text_.data() + text_.size();
    const auto [stop, error] = std::from_chars(text_.data(), end, value);
    const bool whole =
        stop == end || *stop == ' ' || *stop == '\t' || *stop == '\r' || *stop == '\n';
    if (error != std::errc() || !whole) return invalid(what + " is missing or damaged");
    text_.remove_prefix(static_cast<std::size_t>(stop - text_.data()));
    return value;
  }

  template <std::size_t N>
  Result<std::array<double, N>, InputError> numbers(const std::string& what) {
    std::array<double, N> values{};
    for (double& value : values) {
      SLF_TRY(value, number<double>(what));
      if (!std::isfinite(value)) return invalid(what + " is not finite");
    }
    return values;
  }

  InputError invalid(const std::string& cause) const {
    return {Errc::kInvalidInput, name_ + ": " + cause};
  }

 private:
  std::string name_;
  std::string_view text_;
};

struct BundleCamera {
  std::array<double, 3> lens{};   // f, k1, k2; f is 0 where it was not registered
  std::array<double, 12> pose{};  // R by rows, t: world to camera
};

Result<std::vector<BundleCamera>, InputError> read_bundle_cameras(BundleWords& in,
                                                                  std::uint64_t count) {
  if (count > in.bytes_left() / kCameraBytes)
    return in.invalid(std::to_string(count) + " cameras do not fit in the file");
  std::vector<BundleCamera> cameras(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const std::string place = "camera " + std::to_string(i);
    SLF_TRY(cameras[i].lens, in.numbers<3>(place + ": f k1 k2"));
    SLF_TRY(cameras[i].pose, in.numbers<12>(place + ": R and t"));
  }
  return cameras;
}

Result<PointCloud, InputError> read_bundle_points(BundleWords& in, std::uint64_t count) {
  if (count > in.bytes_left() / kPointBytes)
    return in.invalid(std::to_string(count) + " points do not fit in the file");
  PointCloud cloud;
  std::vector<Vec3> positions;
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::string place = "point " + std::to_string(i);
    SLF_TRY(const Vec3 position, in.numbers<3>(place + ": position"));
    positions.push_back(position);
    std::array<std::uint8_t, 3> colour{};
    for (std::uint8_t& c : colour) {
      SLF_TRY(c, in.number<std::uint8_t>(place + ": colour"));
    }
    cloud.colours.push_back(colour);
    SLF_TRY(const auto views, in.number<std::uint32_t>(place + ": number of views"));
    const std::string view = place + ": view";
    for (std::uint64_t v = 0; v < std::uint64_t{4} * views; ++v)  // ends with the file
      if (const auto skipped = in.number<double>(view); !skipped) return skipped.error();
  }
  set_positions(positions, cloud);
  return cloud;
}

/// A photograph a line, and what is known of its focal length.
Result<std::vector<std::string>, InputError> read_bundle_list(const fs::path& list) {
  SLF_TRY(const auto bytes, read_file(list, std::uint64_t{1} << 26));
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  std::vector<std::string> names;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const auto words = words_of(text.substr(at, end - at));
    at = end + 1;
    if (!words.empty()) names.emplace_back(words[0]);
  }
  return names;
}

/// list.txt beside the file, beside its folder bundle/ or the photographs; of x.bundle.out, as
/// COLMAP writes it, x.list.txt.
fs::path bundle_list(const fs::path& file, const fs::path& images) {
  const fs::path folder = file.parent_path();
  const fs::path colmap = file.stem().stem().concat(".list.txt");
  if (file.stem().extension() == ".bundle" && is_file(folder / colmap)) return folder / colmap;
  for (const fs::path& place : {folder, folder.parent_path(), images})
    if (!place.empty() && is_file(place / "list.txt")) return place / "list.txt";
  return folder / "list.txt";
}

Result<Camera, InputError> camera_of(const BundleCamera& given, const fs::path& photograph) {
  SLF_TRY(const ImageSize size, read_image_size(photograph));
  Camera camera;
  camera.width = static_cast<int>(size.width);
  camera.height = static_cast<int>(size.height);
  camera.cx = 0.5 * camera.width;
  camera.cy = 0.5 * camera.height;
  camera.fx = camera.fy = given.lens[0];
  camera.distortion = {given.lens[1], given.lens[2], 0, 0};
  constexpr std::array<double, 3> kSign{1, -1, -1};  // y down, z forward
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) camera.rotation[i][k] = kSign[i] * given.pose[3 * i + k];
    camera.translation[i] = kSign[i] * given.pose[9 + i];
  }
  return camera;
}

}  // namespace

Result<Import, InputError> import_bundler(const fs::path& file, const fs::path& images) {
  SLF_TRY(const auto bytes, read_file(file));
  BundleWords in(file.string(), bytes);
  SLF_TRY(const auto num_cameras, in.number<std::uint32_t>("the number of cameras"));
  SLF_TRY(const auto num_points, in.number<std::uint32_t>("the number of points"));
  SLF_TRY(const auto cameras, read_bundle_cameras(in, num_cameras));
  Import import;
  SLF_TRY(import.capture.cloud, read_bundle_points(in, num_points));
  import.cloud_name = file.string();
  const fs::path list = bundle_list(file, images);
  const bool with_photographs = !images.empty() && list.parent_path() == images;
  import.capture.root = with_photographs ? file.parent_path() : list.parent_path();
  if (!is_file(list))
    return in.invalid(
        "list.txt, a photograph a line, is missing beside it, its folder or the photographs");
  SLF_TRY(const auto names, read_bundle_list(list));
  if (names.size() != cameras.size())
    return in.invalid(std::to_string(cameras.size()) + " cameras, and " + list.string() + " has " +
                      std::to_string(names.size()) + " photographs");
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    if (cameras[i].lens[0] == 0) continue;
    const std::string label = file.string() + ": camera " + std::to_string(i);
    import.images.push_back(find_photograph(import.capture.root, names[i]));
    SLF_TRY(const fs::path photograph,
            photograph_file(import.capture.root, import.images.back(), images, names[i], label));
    SLF_TRY(Camera camera, camera_of(cameras[i], photograph));
    camera.name = names[i];
    import.labels.push_back(label);
    import.capture.cameras.push_back(std::move(camera));
  }
  warn_of_left_out(file.string(), cameras.size() - import.capture.cameras.size(), cameras.size(),
                   import);
  return import;
}

}  // namespace slf
