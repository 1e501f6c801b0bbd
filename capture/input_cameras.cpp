// SPDX-License-Identifier: Apache-2.0
#include "slf/input_cameras.h"

#include <cstddef>
#include <filesystem>
#include <system_error>

namespace slf {
namespace {

/// Whatever the path ends with.
std::string last_name(const std::string& path) {
  std::error_code ignored;
  std::filesystem::path full = std::filesystem::weakly_canonical(path, ignored);
  if (ignored) full = path;
  return full.filename().empty() ? full.parent_path().filename().string()
                                 : full.filename().string();
}

}  // namespace

std::string split_name(const Capture& capture, const std::string& given) {
  if (!given.empty()) return given;
  return capture.splits.count("dense") > 0 ? "dense" : "default";
}

Result<std::vector<int>, InputError> input_cameras(const Capture& capture,
                                                   const std::string& split) {
  if (capture.cameras.empty()) {
    if (split.empty()) return std::vector<int>{};
    return InputError{Errc::kInvalidArgument, "--split " + split + ": the capture has no cameras"};
  }
  SLF_TRY(std::vector<int> cameras, split_cameras(capture, split));
  if (!cameras.empty()) return cameras;
  return InputError{Errc::kInvalidInput,
                    "its split " + split_name(capture, split) + " has no images"};
}

std::string leave_out_empty(const Capture& capture, const char* which, int threads,
                            std::vector<int>& cameras) {
  const std::vector<int> empty = cameras_without_object(capture, cameras, threads);
  if (empty.empty()) return {};
  const std::size_t all = cameras.size();
  for (const int camera : empty) std::erase(cameras, camera);
  return std::to_string(empty.size()) + " of " + std::to_string(all) + " " + which +
         " photographs have a mask or alpha without a pixel of the object (the first is " +
         capture.cameras[static_cast<std::size_t>(empty[0])].name +
         "): left out; 128 and more, white, is the object";
}

Result<std::string, InputError> leave_out_empty_inputs(const Capture& capture, int threads,
                                                       std::vector<int>& cameras) {
  const std::size_t all = cameras.size();
  std::string warning = leave_out_empty(capture, "input", threads, cameras);
  if (warning.empty() || !cameras.empty()) return warning;
  return InputError{Errc::kInvalidInput,
                    "the masks (or alpha) of all " + std::to_string(all) +
                        " input photographs are black, and 128 and more, white, is the object: "
                        "invert them (mogrify -negate) or take them away"};
}

Metadata input_metadata(const Capture& capture, const std::vector<int>& cameras,
                        const std::string& split, const std::string& path) {
  Metadata metadata;
  if (!path.empty()) metadata.emplace_back("source", last_name(path));
  if (!cameras.empty()) metadata.emplace_back("split", split_name(capture, split));
  if (!capture.crs.empty()) metadata.emplace_back("crs", capture.crs);
  return metadata;
}

}  // namespace slf
