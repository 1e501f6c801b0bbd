// SPDX-License-Identifier: Apache-2.0
#include "tools/frame_places.h"

#include <filesystem>

#include "tools/output.h"

namespace slf::tools {

std::string file_of_frame(const std::string& given, const FrameInput& frame) {
  if (given.find('%') == std::string::npos) return given;
  return numbered(given, static_cast<int>(frame.number));
}

Result<std::string, Failure> images_of_frame(const std::string& given, const FrameInput& frame) {
  if (given.empty()) return given;
  std::string folder = file_of_frame(given, frame);
  if (folder == given && !frame.of_all) folder = inside(given, frame.name());
  std::error_code ignored;
  if (std::filesystem::is_directory(folder, ignored)) return folder;
  return Failure{kInputUnreadable, folder + ": no folder with the photographs of frame " +
                                       std::to_string(frame.number) + " (--images " + given + ")"};
}

}  // namespace slf::tools
