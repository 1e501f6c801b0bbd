// SPDX-License-Identifier: Apache-2.0
#include "capture/colmap_workspace.h"

#include <algorithm>
#include <array>
#include <set>

#include "capture/file_names.h"
#include "capture/input_file.h"

namespace slf {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostModels = 100;
constexpr std::size_t kMostEntries = 100000;  // of a folder

std::string model_text(const fs::path& directory, std::size_t images) {
  return (directory.parent_path().filename() / directory.filename()).string() + " (" +
         std::to_string(images) + " photographs)";
}

bool is_photograph(const fs::path& file) {
  const std::string extension = extension_of(file);
  return extension == ".png" || extension == ".jpg" || extension == ".jpeg";
}

}  // namespace

std::optional<std::string> colmap_extension(const fs::path& directory) {
  if (is_file(directory / "cameras.bin")) return ".bin";
  if (is_file(directory / "cameras.txt")) return ".txt";
  return std::nullopt;
}

std::size_t colmap_num_images(const fs::path& directory, const std::string& extension) {
  if (extension == ".txt") return colmap_num_images_text(directory);
  auto file = InputFile::open(directory / "images.bin");
  std::array<std::uint8_t, 8> bytes{};
  if (!file) return 0;
  const auto count = file->read(bytes);
  if (!count || *count < bytes.size()) return 0;
  std::uint64_t images = 0;
  for (std::size_t i = 0; i < 8; ++i) images |= std::uint64_t{bytes[i]} << (8 * i);
  return static_cast<std::size_t>(std::min<std::uint64_t>(images, file->size()));
}

std::optional<ColmapPlace> find_colmap(const fs::path& directory) {
  if (const auto extension = colmap_extension(directory))
    return ColmapPlace{directory, *extension, {}};
  const fs::path sparse = directory / "sparse";
  std::optional<ColmapPlace> best;
  std::size_t most = 0;
  std::string others;
  for (std::size_t i = 0; i < kMostModels; ++i) {
    const fs::path place = sparse / std::to_string(i);
    const auto extension = colmap_extension(place);
    if (!extension) {
      if (i == 0) continue;  // somebody may have put the first away
      break;
    }
    const std::size_t images = colmap_num_images(place, *extension);
    if (best && images <= most) {
      others += (others.empty() ? "" : ", ") + model_text(place, images);
      continue;
    }
    if (best) others += (others.empty() ? "" : ", ") + model_text(best->directory, most);
    best = ColmapPlace{place, *extension, {}};
    most = images;
  }
  if (best && !others.empty())
    best->warning = "several COLMAP models: " + model_text(best->directory, most) +
                    " is taken, without " + others + "; each is a world of its own";
  if (best) return best;
  if (const auto extension = colmap_extension(sparse)) return ColmapPlace{sparse, *extension, {}};
  return std::nullopt;
}

/// How the mask of the first photograph may be named.
std::string names_of_mask(const std::vector<Camera>& cameras) {
  if (cameras.empty()) return "NAME.png";
  const fs::path name = cameras[0].name;
  return fs::path(name).replace_extension(".png").string() + " or " + name.string() + ".png";
}

void find_colmap_masks(Import& import) {
  const fs::path folder = import.capture.root / "masks";
  std::error_code error;
  if (!fs::is_directory(folder, error)) return;
  std::vector<std::string> masks;
  for (const Camera& camera : import.capture.cameras) {
    const fs::path name = camera.name;
    const std::array<fs::path, 3> places = {fs::path(name) += ".png", name,
                                            fs::path(name).replace_extension(".png")};
    const auto found = std::find_if(places.begin(), places.end(),
                                    [&](const fs::path& p) { return is_file(folder / p); });
    masks.push_back(found == places.end() ? "" : ("masks" / *found).string());
  }
  const auto without = std::count(masks.begin(), masks.end(), "");
  if (static_cast<std::size_t>(without) == masks.size()) {
    if (!fs::is_empty(folder, error))
      import.capture.warnings.push_back(
          folder.string() + ": no file there is the mask of a photograph, which is named as " +
          names_of_mask(import.capture.cameras) + "; no mask is used");
    return;
  }
  if (without > 0)
    import.capture.warnings.push_back(folder.string() + ": no mask of " + std::to_string(without) +
                                      " of " + std::to_string(masks.size()) + " photographs");
  import.masks = std::move(masks);
}

void count_other_photographs(const fs::path& folder, Import& import) {
  std::set<fs::path> known;
  for (const std::string& image : import.images)
    known.insert((import.capture.root / image).lexically_normal());
  std::error_code error;
  std::size_t others = 0, entries = 0;
  fs::path first;
  for (fs::recursive_directory_iterator at(folder, error), end; at != end && !error;
       at.increment(error)) {
    if (++entries > kMostEntries) return;
    if (!is_photograph(at->path()) || known.contains(at->path().lexically_normal())) continue;
    if (others++ == 0 || at->path() < first) first = at->path();
  }
  if (others == 0) return;
  import.capture.warnings.push_back(
      folder.string() + ": " + std::to_string(others) + " of " +
      std::to_string(others + known.size()) + " photographs are not in the model (" +
      first.lexically_relative(folder).string() + (others > 1 ? ", ...)" : ")"));
}

}  // namespace slf
