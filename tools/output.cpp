// SPDX-License-Identifier: Apache-2.0
#include "tools/output.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <optional>

#include "slf/jpeg.h"
#include "tools/interrupt.h"
#include "tools/text.h"

namespace slf::tools {
namespace {

namespace fs = std::filesystem;

/// A pipe may block for ever on its reader, and has no temporary file: no need to defer.
template <class Write>
Outcome written(const std::string& file, const Write& write) {
  std::optional<DeferInterrupts> defer;
  std::error_code ignored;
  const bool pipe =
      file == "-" || (fs::exists(file, ignored) && !fs::is_regular_file(file, ignored));
  if (!pipe) defer.emplace();
  return from(output_name(file), write());
}

/// Permissions do not tell of every system of files: a file is made, as write_file() will, and
/// gone.
bool takes_a_file(const fs::path& directory) {
  std::string name = (directory / ".slf.tmpXXXXXX").string();
  const int made = mkstemp(name.data());
  if (made < 0) return false;
  close(made);
  unlink(name.c_str());
  return true;
}

/// The name is empty or that of a directory, or the directory is missing or takes no file.
Outcome check_place(const std::string& file) {
  if (file.empty()) return Failure{kUsage, "the name of the output is empty"};
  if (file == "-") return Done{};
  std::error_code ignored;
  if (fs::is_directory(file, ignored)) return Failure{kWriteFailed, file + ": is a directory"};
  if (fs::exists(file, ignored) && !fs::is_regular_file(file, ignored))
    return Done{};  // a device, a pipe
  fs::path directory = fs::path(file).parent_path();
  if (directory.empty()) directory = ".";
  if (fs::exists(directory, ignored) && !fs::is_directory(directory, ignored))
    return Failure{kWriteFailed, file + ": " + directory.string() + " is not a directory"};
  if (!fs::is_directory(directory, ignored))
    return Failure{kWriteFailed,
                   file + ": the directory " + directory.string() + " does not exist"};
  if (!takes_a_file(directory))
    return Failure{kWriteFailed,
                   file + ": the directory " + directory.string() + " is not writable"};
  return Done{};
}

}  // namespace

std::string small_extension(const std::string& file) {
  std::string extension = fs::path(file).extension().string();
  for (char& c : extension)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return extension;
}

Outcome check_directory(const std::string& directory) {
  if (directory.empty()) return Failure{kUsage, "the name of a directory is empty"};
  if (directory != "-") return Done{};
  return Failure{kUsage, "-: standard output is no directory (./- names one)"};
}

Outcome check_output(const std::string& file, const char* verb,
                     std::span<const char* const> formats, FormatBy by) {
  constexpr std::array kKnown = {
      ".avi", ".avif", ".bmp",   ".csv", ".e57",  ".exr",  ".gif",  ".glb",   ".gltf",
      ".htm", ".html", ".igc",   ".ivf", ".jpeg", ".jpg",  ".json", ".jxl",   ".ksplat",
      ".las", ".laz",  ".mjpeg", ".mkv", ".mov",  ".mp4",  ".npy",  ".obj",   ".pcd",
      ".pdf", ".ply",  ".png",   ".ppm", ".pts",  ".slf",  ".sog",  ".splat", ".spz",
      ".stl", ".tif",  ".tiff",  ".txt", ".webm", ".webp", ".xyz"};
  const std::string extension = small_extension(file);
  const auto is_it = [&](const char* other) { return extension == other; };
  const bool promises_none =
      file == "-" || extension.empty() ||
      (by == FormatBy::kOption && std::none_of(kKnown.begin(), kKnown.end(), is_it));
  if (promises_none || std::any_of(formats.begin(), formats.end(), is_it)) return check_place(file);
  std::string names;
  for (const char* format : formats) names += (names.empty() ? "" : ", ") + std::string(format);
  return Failure{kUsage,
                 std::string(verb) + ": " + file + ": it writes " + names + ", no " + extension};
}

Outcome make_directory(const std::string& directory) {
  SLF_CHECK(check_directory(directory));
  std::error_code error;
  fs::create_directories(directory, error);
  if (error) return Failure{kWriteFailed, directory + ": " + error.message()};
  return Done{};
}

Outcome save(const std::string& file, const void* data, std::size_t size) {
  return written(file, [&] { return write_file(file, data, size); });
}

Outcome save(const std::string& file, std::span<const std::span<const std::byte>> pieces) {
  return written(file, [&] { return write_file(file, pieces); });
}

Outcome save(const std::string& file, const std::string& text) {
  return save(file, text.data(), text.size());
}

Outcome save(const std::string& file, const Image& image, const std::string& format) {
  const std::string extension = format.empty() ? small_extension(file) : format;
  if (extension == ".jpg" || extension == ".jpeg") {
    SLF_TRY(const auto bytes, from(file, encode_jpeg(image, kJpegQuality)));
    return save(file, bytes.data(), bytes.size());
  }
  return written(file, [&] { return write_png(file, image); });
}

Outcome save(const std::string& file, const PointCloud& cloud) {
  return written(file, [&] { return write_ply(file, cloud); });
}

std::string inside(const std::string& directory, const std::string& name) {
  return (fs::path(directory) / name).string();
}

std::string numbered(const std::string& pattern, int i, const std::string& extension) {
  if (pattern == "-") return pattern;  // standard output, though a directory may have the name
  std::error_code ignored;
  if (std::filesystem::is_directory(pattern, ignored) || pattern.ends_with('/'))
    return inside(pattern, text("%03d", i) + extension);
  const std::size_t percent = pattern.find('%');
  if (percent == std::string::npos) return pattern;
  std::size_t d = percent + 1;
  while (d < pattern.size() && pattern[d] >= '0' && pattern[d] <= '9') ++d;
  if (d == pattern.size() || pattern[d] != 'd' || d > percent + 3) return pattern;
  const std::string width = pattern.substr(percent + 1, d - percent - 1);
  std::string number = std::to_string(i);
  const std::size_t digits = width.empty() ? 0 : static_cast<std::size_t>(std::stoi(width));
  if (number.size() < digits) number.insert(0, digits - number.size(), '0');
  return pattern.substr(0, percent) + number + pattern.substr(d + 1);
}

}  // namespace slf::tools
