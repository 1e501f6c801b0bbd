// SPDX-License-Identifier: Apache-2.0
#include "capture/photograph_names.h"

#include <algorithm>
#include <array>

#include "capture/file_names.h"
#include "capture/importer.h"

namespace slf {

namespace fs = std::filesystem;

std::optional<std::string> picture_named(const fs::path& root, const std::string& path) {
  constexpr std::array kExtensions{"",     ".png",  ".jpg", ".jpeg", ".PNG",
                                   ".JPG", ".JPEG", ".ppm", ".pgm"};
  for (const char* extension : kExtensions)
    if (is_file(root / (path + extension))) return path + extension;
  return std::nullopt;
}

std::string find_photograph(const fs::path& root, std::string given) {
  std::replace(given.begin(), given.end(), '\\', '/');
  std::string name = given.substr(given.find_last_of('/') + 1);
  const bool relative = !given.starts_with('/') && given.find("..") == std::string::npos &&
                        given.find(':') == std::string::npos;
  for (const std::string& path : {relative ? given : name, name})
    for (const char* folder : {"", "images/", "input/"})
      if (auto found = picture_named(root, folder + path)) return *std::move(found);
  return name;
}

Result<fs::path, InputError> photograph_file(const fs::path& root, const std::string& image,
                                             const fs::path& folder, const std::string& name,
                                             const std::string& label) {
  if (folder.empty()) return path_inside(root, image, label);
  SLF_TRY(const fs::path whole,
          path_inside(folder, picture_named(folder, name).value_or(name), label));
  if (is_file(whole)) return whole;
  return path_inside(folder, fs::path(image).filename().string(), label);
}

}  // namespace slf
