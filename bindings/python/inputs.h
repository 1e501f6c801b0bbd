// SPDX-License-Identifier: Apache-2.0
// What an encoding begins with, by the rules of `slf encode` (tools/capture_input.cpp,
// tools/verb_encode.cpp): the cameras of the split, settings that go with the capture, and what the
// file says of its input.
#pragma once

#include <algorithm>
#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "failure.h"
#include "slf/capture.h"
#include "slf/settings.h"
#include "slf/types.h"

namespace slf::python {

/// What split_cameras() made of "".
inline std::string split_name(const Capture& capture, const std::string& given) {
  if (!given.empty()) return given;
  return capture.splits.count("dense") > 0 ? "dense" : "default";
}

/// The cameras of the split; none of a capture that has none.
/// @throws Failure  the split has no images; or one is named and the capture has no cameras
inline std::vector<int> input_cameras(const Capture& capture, const std::string& split) {
  if (capture.cameras.empty()) {
    if (split.empty()) return {};
    throw failure_of(
        InputError{Errc::kInvalidArgument, "--split " + split + ": the capture has no cameras"});
  }
  std::vector<int> cameras = value_of(split_cameras(capture, split));
  if (!cameras.empty()) return cameras;
  throw failure_of(InputError{Errc::kInvalidInput,
                              "its split " + split_name(capture, split) + " has no images"});
}

/// Points alone cannot be mended or trained: a setting that changes nothing is refused.
/// @throws Failure  names the option and, where not all are wrong, the value
inline void check_photographs(const std::vector<int>& cameras, const GivenSettings& given) {
  if (!cameras.empty()) return;
  constexpr std::array<std::string_view, 4> kOfPhotographs = {
      "splats", "surface-seconds", "surface-memory", "photograph-pixels"};
  const auto refused = [](const std::string& option) {
    return failure_of(InputError{Errc::kInvalidArgument,
                                 option + " is for photographs, and the capture has none"});
  };
  for (const auto& [name, value] : given) {
    if (name == "surface" && value != "given" && value != "auto")
      throw refused("--surface " + value);
    if ((name == "match-exposure" || name == "refine-cameras") && value == "on")
      throw refused("--" + name + " on");
    if (std::find(kOfPhotographs.begin(), kOfPhotographs.end(), name) != kOfPhotographs.end())
      throw refused("--" + name);
  }
}

/// The last component of a path, whatever it ends with; never more, so that no machine's paths get
/// into a file.
inline std::string last_name(const std::string& path) {
  std::error_code ignored;
  std::filesystem::path full = std::filesystem::weakly_canonical(path, ignored);
  if (ignored) full = path;
  return full.filename().empty() ? full.parent_path().filename().string()
                                 : full.filename().string();
}

/// @param path  of the capture; empty: it was in memory
inline Metadata input_metadata(const Capture& capture, const std::vector<int>& cameras,
                               const std::string& split, const std::string& path) {
  Metadata metadata;
  if (!path.empty()) metadata.emplace_back("source", last_name(path));
  if (!cameras.empty()) metadata.emplace_back("split", split_name(capture, split));
  if (!capture.crs.empty()) metadata.emplace_back("crs", capture.crs);
  return metadata;
}

}  // namespace slf::python
