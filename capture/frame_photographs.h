// SPDX-License-Identifier: Apache-2.0
// One capture of all frames: its files have the number of a frame in their paths.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "capture/frame_names.h"
#include "capture/importer.h"

namespace slf {

/// Where a path has the number of a frame.
struct NumberedFile {
  std::filesystem::path directory;
  FramePattern pattern;
  std::filesystem::path behind;  ///< the component with the pattern

  std::filesystem::path file(std::uint32_t number) const;
};

/// Is this a directory with one cameras.json of all frames? Read as text: what it is is checked
/// where it is loaded.
bool has_numbered_images(const std::filesystem::path& directory);

/// The photographs of its cameras.
/// @errors those of load_capture; kInvalidInput: one without a pattern, or with two
Result<std::vector<NumberedFile>, InputError> numbered_images(
    const std::filesystem::path& directory);

/// A path of such a capture, of one frame.
std::string at_frame(const std::string& path, std::uint32_t frame);

/// Images, masks and the cloud become those of one frame; cameras keep their names.
/// @errors kInvalidInput: an image without a pattern
Result<Done, InputError> take_frame(std::uint32_t frame, Import& import);

}  // namespace slf
