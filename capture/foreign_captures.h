// SPDX-License-Identifier: Apache-2.0
// Captures of formats that are not read: what they are, and the way to one that is.
#pragma once

#include <filesystem>
#include <string>

namespace slf {

/// A sentence on a file or directory that is no capture; empty where it is not recognised.
std::string foreign_capture(const std::filesystem::path& path);

}  // namespace slf
