// SPDX-License-Identifier: Apache-2.0
#include "capture/frame_photographs.h"

#include <string_view>

#include "base/input_error.h"
#include "slf/capture.h"

namespace slf {
namespace {

namespace fs = std::filesystem;

std::optional<NumberedFile> numbered_file(const fs::path& file) {
  NumberedFile out;
  bool found = false;
  for (const fs::path& part : file) {
    const auto pattern = parse_pattern(part.string());
    if (pattern && found) return std::nullopt;
    if (pattern) out.pattern = *pattern;
    if (!pattern) (found ? out.behind : out.directory) /= part;
    found = found || pattern;
  }
  return found ? std::optional(out) : std::nullopt;
}

}  // namespace

std::filesystem::path NumberedFile::file(std::uint32_t number) const {
  const std::filesystem::path own = directory / pattern.name_of(number);
  return behind.empty() ? own : own / behind;
}

Result<std::vector<NumberedFile>, InputError> numbered_images(const fs::path& directory) {
  SLF_TRY(const Capture capture,
          load_capture(directory, {.points = {}, .check_images = false, .cloud = false}));
  std::vector<NumberedFile> files;
  for (std::size_t i = 0; i < capture.image_files.size(); ++i) {
    auto file = numbered_file(capture.image_files[i]);
    if (!file)
      return invalid_input((directory / "cameras.json").string() + ": image '" +
                           capture.cameras[i].name + "' has no %d for the number of a frame");
    files.push_back(*std::move(file));
  }
  return files;
}

bool has_numbered_images(const fs::path& directory) {
  std::error_code ignored;
  if (!fs::is_regular_file(directory / "cameras.json", ignored)) return false;
  const auto bytes = read_file(directory / "cameras.json");
  if (!bytes) return false;
  const std::string_view text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
  for (std::size_t at = text.find('%'); at != text.npos; at = text.find('%', at + 1)) {
    if (!parse_pattern(text.substr(at, text.find_first_of("/\"%", at + 1) - at))) continue;
    const std::size_t quote = text.rfind('"', at), begin = quote == text.npos ? 0 : quote + 1;
    const fs::path literal(text.substr(begin, text.find('"', at) - begin));
    if (!fs::exists(directory / literal, ignored)) return true;  // else a name like any other
  }
  return false;
}

std::string at_frame(const std::string& path, std::uint32_t frame) {
  std::string out;
  for (const fs::path& part : fs::path(path)) {
    const auto pattern = parse_pattern(part.string());
    out = (fs::path(out) / (pattern ? pattern->name_of(frame) : part.string())).string();
  }
  return out;
}

Result<Done, InputError> take_frame(std::uint32_t frame, Import& import) {
  for (std::size_t i = 0; i < import.images.size(); ++i) {
    const std::string own = at_frame(import.images[i], frame);
    if (own == import.images[i])
      return invalid_input(import.labels[i] + ": image '" + own +
                           "' has no %d for the number of a frame");
    import.images[i] = own;
  }
  for (std::string& mask : import.masks) mask = at_frame(mask, frame);
  if (!import.cloud_file.empty()) import.cloud_file = at_frame(import.cloud_file.string(), frame);
  return Done{};
}

}  // namespace slf
