// SPDX-License-Identifier: Apache-2.0
// index.cams: cameras of the surface light fields of Wood et al. (SIGGRAPH 2000), of Fish and
// Elephant. A line a photograph: name x y z qi qj qk qr cx cy ar f k, the eye in metres, the
// quaternion's real part last, pixels. The data do not say which way it turns and along which axis
// a camera looks, so the reading is taken under which the cameras look at one place.
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>

#include "base/quaternion.h"
#include "capture/file_names.h"
#include "capture/image_formats.h"
#include "capture/importer.h"
#include "capture/photograph_names.h"
#include "capture/ply_header.h"

namespace slf {

namespace {

namespace fs = std::filesystem;
using Matrix = std::array<std::array<double, 3>, 3>;

constexpr std::size_t kNumbers = 12;
constexpr std::uint64_t kMostIndexBytes = std::uint64_t{1} << 24;

struct IndexLine {
  std::string name;
  std::array<double, kNumbers> number;  // x y z qi qj qk qr cx cy ar f k
  std::size_t line = 0;                 // of the file, from 1
};

/// The rotation of our cameras (x right, y down, z forward) by one of four readings.
Matrix rotation_of(const IndexLine& line, bool to_world, bool looks_backward) {
  const auto& n = line.number;
  const Matrix given = slf::rotation_of(std::array{n[6], n[3], n[4], n[5]});
  Matrix rotation{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k)
      rotation[i][k] = (looks_backward && i > 0 ? -1 : 1) * (to_world ? given[k][i] : given[i][k]);
  return rotation;
}

/// Mean distance of the axes from the place that they look at together, in its distance from the
/// eyes; infinite where it lies behind one of four of them, or they are parallel.
double miss_of(const std::vector<IndexLine>& lines, bool to_world, bool looks_backward) {
  // Normal equations of the point nearest to all axes: sum of (1 - d d^T) (p - eye).
  Matrix sum{};
  Vec3 right{}, place{};
  std::vector<Vec3> axes;
  for (const IndexLine& line : lines) {
    const Vec3 d = axes.emplace_back(rotation_of(line, to_world, looks_backward)[2]);
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        const double entry = (i == k ? 1 : 0) - d[i] * d[k];
        sum[i][k] += entry;
        right[i] += entry * line.number[k];
      }
  }
  const auto minor = [&](std::size_t i, std::size_t k) {
    const std::size_t a = (i + 1) % 3, b = (i + 2) % 3, c = (k + 1) % 3, d = (k + 2) % 3;
    return sum[a][c] * sum[b][d] - sum[a][d] * sum[b][c];
  };
  double determinant = 0;
  for (std::size_t k = 0; k < 3; ++k) determinant += sum[0][k] * minor(0, k);
  const double count = static_cast<double>(lines.size());
  if (!(std::abs(determinant) > 1e-9 * count * count * count))
    return std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t i = 0; i < 3; ++i) place[k] += minor(i, k) * right[i] / determinant;
  double miss = 0, behind = 0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    double along = 0, square = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double to = place[k] - lines[i].number[k];
      along += to * axes[i][k];
      square += to * to;
    }
    behind += along <= 0;
    miss += std::sqrt(std::max(square - along * along, 0.0) / std::max(square, 1e-300)) / count;
  }
  return behind > count / 4 ? std::numeric_limits<double>::infinity() : miss;
}

Result<std::vector<IndexLine>, InputError> read_lines(const fs::path& file) {
  SLF_TRY(const auto bytes, read_file(file, kMostIndexBytes));
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  std::vector<IndexLine> lines;
  std::size_t number = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const auto words = words_of(text.substr(at, end - at));
    at = end + 1;
    ++number;
    if (words.empty() || words[0].starts_with('#')) continue;
    const auto invalid = [&](const std::string& cause) {
      return InputError{Errc::kInvalidInput,
                        file.string() + ": line " + std::to_string(number) + ": " + cause};
    };
    if (words.size() != kNumbers + 1)
      return invalid("name x y z qi qj qk qr cx cy ar f k is expected, 13 words, not " +
                     std::to_string(words.size()));
    IndexLine line{std::string(words[0]), {}, number};
    for (std::size_t i = 0; i < kNumbers; ++i) {
      const std::string_view word = words[i + 1];
      const auto [stop, error] =
          std::from_chars(word.data(), word.data() + word.size(), line.number[i]);
      if (error != std::errc() || stop != word.data() + word.size() ||
          !std::isfinite(line.number[i]))
        return invalid(std::string("'").append(word.substr(0, 40)) + "' is no number");
    }
    const auto& n = line.number;
    if (!(std::abs(std::hypot(std::hypot(n[3], n[4]), std::hypot(n[5], n[6])) - 1) < 0.01))
      return invalid("qi qj qk qr is no rotation: its length is not 1");
    if (!(n[9] > 0) || !(n[10] > 0)) return invalid("ar and f are above 0");
    lines.push_back(std::move(line));
  }
  return lines;
}

/// The photograph, which may lie in images/.
std::string photograph_of(const fs::path& root, const std::string& name) {
  if (!is_file(root / name) && is_file(root / "images" / name)) return "images/" + name;
  return name;
}

/// The largest PLY of the folder: meshes come in several resolutions.
fs::path largest_ply(const fs::path& root, std::vector<std::string>& warnings) {
  fs::path best;
  std::uintmax_t most = 0;
  std::size_t found = 0;
  std::error_code error;
  for (fs::directory_iterator at(root, error), end; at != end && !error; at.increment(error)) {
    if (extension_of(at->path()) != ".ply" || !is_file(at->path())) continue;
    std::error_code ignored;
    const std::uintmax_t bytes = fs::file_size(at->path(), ignored);
    ++found;
    if (best.empty() || bytes > most || (bytes == most && at->path() < best)) {
      best = at->path();
      most = bytes;
    }
  }
  if (found > 1)
    warnings.push_back(root.string() + ": of " + std::to_string(found) + " meshes the largest, " +
                       best.filename().string() + ", is taken (--points FILE names another)");
  return best;
}

}  // namespace

Result<Import, InputError> import_index_cams(const fs::path& file, const fs::path& images) {
  SLF_TRY(const auto lines, read_lines(file));
  Import import;
  Capture& capture = import.capture;
  capture.root = file.parent_path();
  bool to_world = false, backward = false;
  double least = std::numeric_limits<double>::infinity();
  for (const bool turned : {false, true})
    for (const bool looks : {false, true})
      if (const double miss = miss_of(lines, turned, looks); miss < least) {
        least = miss;
        to_world = turned;
        backward = looks;
      }
  if (!lines.empty() && !std::isfinite(least))
    return InputError{Errc::kInvalidInput,
                      file.string() +
                          ": by no reading of its quaternions do the cameras look at "
                          "one place"};
  capture.warnings.push_back(file.string() + ": quaternions are read as " +
                             (to_world ? "camera to world" : "world to camera") +
                             ", cameras look " + (backward ? "along -z" : "along z"));
  for (const IndexLine& line : lines) {
    Camera camera;
    camera.name = line.name;
    import.images.push_back(photograph_of(capture.root, line.name));
    import.labels.push_back(file.string() + ": line " + std::to_string(line.line));
    SLF_TRY(const fs::path photograph, photograph_file(capture.root, import.images.back(), images,
                                                       line.name, import.labels.back()));
    SLF_TRY(const ImageSize size, read_image_size(photograph));
    camera.width = static_cast<int>(size.width);
    camera.height = static_cast<int>(size.height);
    const auto& n = line.number;
    camera.rotation = rotation_of(line, to_world, backward);
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t k = 0; k < 3; ++k) camera.translation[i] -= camera.rotation[i][k] * n[k];
    camera.cx = n[7];
    camera.cy = n[8];
    camera.fx = n[10];
    camera.fy = n[9] * n[10];
    camera.distortion[0] = n[11];
    capture.cameras.push_back(std::move(camera));
  }
  import.cloud_file = largest_ply(capture.root, capture.warnings);
  return import;
}

}  // namespace slf
