// SPDX-License-Identifier: Apache-2.0
// Writing results: checked before the work, atomic after it.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "slf/capture.h"
#include "tools/failure.h"

namespace slf::tools {

/// Refuses an empty name of a directory, and standard output, which is none.
Outcome check_directory(const std::string& directory);

/// The extension of a name, in small letters, with its dot.
std::string small_extension(const std::string& file);

/// What says which format is written.
enum class FormatBy {
  kName,    ///< the name's extension
  kOption,  ///< an option: the name may have an extension that nobody knows
};

/// Refuses, before any work is done, an output that could not be written after it: the name is
/// empty or that of a directory, the directory is missing or takes no file. Refuses too a name that
/// promises a format which is not written: x.obj, x.pts of slf decode. Names without an extension
/// are taken, and "-", standard output.
/// @param verb     for the message
/// @param formats  extensions that are written: ".png"
Outcome check_output(const std::string& file, const char* verb,
                     std::span<const char* const> formats, FormatBy by = FormatBy::kName);

/// Creates the directory (and those above it) if it is missing.
Outcome make_directory(const std::string& directory);

/// Atomic: the whole file or nothing, and an interrupt waits for it. "-" is standard output.
Outcome save(const std::string& file, const void* data, std::size_t size);
Outcome save(const std::string& file, std::span<const std::span<const std::byte>> pieces);
Outcome save(const std::string& file, const std::string& text);
inline constexpr int kJpegQuality = 95;  ///< as libjpeg has it
/// PNG; JPEG where the name says so, or `format`, ".jpg", in its place.
Outcome save(const std::string& file, const Image& image, const std::string& format = {});
Outcome save(const std::string& file, const PointCloud& cloud);

/// "%03d" or "%d" of a name replaced by a number; within a directory NUMBER.extension; else the name.
std::string numbered(const std::string& pattern, int i, const std::string& extension = ".png");

/// Path of `name` within `directory`.
std::string inside(const std::string& directory, const std::string& name);

}  // namespace slf::tools
