// SPDX-License-Identifier: Apache-2.0
#include "slf/gaussian_files.h"

#include <algorithm>
#include <string_view>

#include "capture/input_file.h"
#include "lightfield/splats/gaussian_readers.h"
#include "slf/capture.h"

namespace slf {
namespace {

constexpr std::size_t kHeadBytes = std::size_t{1} << 16;

bool has_text(FileBytes bytes, std::string_view text) {
  return std::search(bytes.begin(), bytes.end(), text.begin(), text.end()) != bytes.end();
}

}  // namespace

// A bundle is a zip whose first names are among these; what stands beside pictures is JSON.
bool is_sog(FileBytes head) {
  if (head.size() < 4) return false;
  const bool zip = head[0] == 'P' && head[1] == 'K' && head[2] == 3 && head[3] == 4;
  if (zip)
    return has_text(head, "meta.json") || has_text(head, "means_l.webp") ||
           has_text(head, "means_u.webp");
  return head[0] == '{' && has_text(head, "\"means\"") && has_text(head, ".webp\"");
}

InputError refuse_sog(const std::string& name) {
  return {Errc::kUnsupported, name +
                                  ": SOG is pictures in WebP, which this build does not read: "
                                  "splat-transform (npm @playcanvas/splat-transform) makes a PLY "
                                  "of it"};
}

bool looks_like_gaussians(std::span<const std::uint8_t> head, std::uint64_t size) {
  return is_gaussian_ply(head, size) || is_compressed_ply(head, size) || is_spz(head) ||
         is_gaussian_gltf(head) || is_sog(head) || is_ksplat(head, size) || is_splat(head, size);
}

bool looks_like_gaussians(const std::filesystem::path& file) {
  if (file == "-") return false;
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) return false;
  auto input = InputFile::open(file);
  if (!input) return false;
  std::vector<std::uint8_t> head(kHeadBytes);
  const auto count = input->read(head);
  if (!count) return false;
  return looks_like_gaussians(std::span(head).first(*count), input->size());
}

Result<GaussianFile, InputError> parse_gaussians(const std::string& name,
                                                 std::span<const std::uint8_t> bytes,
                                                 const std::filesystem::path& folder) {
  const FileBytes head = bytes.first(std::min(bytes.size(), kHeadBytes));
  if (is_compressed_ply(head, bytes.size())) return read_compressed_ply(name, bytes);
  if (head.size() >= 4 && head[0] == 'p' && head[1] == 'l' && head[2] == 'y')
    return read_gaussian_ply(name, bytes);
  if (is_spz(head)) return read_spz(name, bytes);
  if (is_gaussian_gltf(head)) return read_gaussian_gltf(name, bytes, folder);
  if (is_sog(head)) return read_sog(name, bytes, folder);
  if (is_ksplat(head, bytes.size())) return read_ksplat(name, bytes);
  if (is_splat(head, bytes.size())) return read_splat(name, bytes);
  return InputError{Errc::kInvalidInput,
                    name +
                        ": none of the formats of splats that are read: PLY, SPZ, SOG, "
                        "splat, ksplat, glTF with KHR_gaussian_splatting"};
}

Result<GaussianFile, InputError> read_gaussians(const std::filesystem::path& file) {
  SLF_TRY(const auto bytes, read_file(file));
  std::error_code ignored;
  const auto folder = std::filesystem::absolute(file, ignored).parent_path();
  return parse_gaussians(file == "-" ? "standard input" : file.string(), bytes,
                         file == "-" ? std::filesystem::path{} : folder);
}

}  // namespace slf
