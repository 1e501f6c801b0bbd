// SPDX-License-Identifier: Apache-2.0
// Notes: points of a light field with text, and guided tours of views (docs/notes.md).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "slf/error.h"

namespace slf {

/// The metadata key whose value is the JSON of notes.
inline constexpr const char* kNotesKey = "notes";
inline constexpr std::size_t kMostNoteBytes = std::size_t{1} << 20;  ///< of that JSON

/// Checks a JSON of notes by all rules of docs/notes.md; texts with markup are refused, too, since
/// viewers show them as they stand. Members that no rule is about are left alone.
/// @param file  for messages
/// @returns the same JSON without the space between its values: for metadata, or for a page
/// @errors kInvalidInput, which names the file and the place in it: "annotations[2].at"
Result<std::string, InputError> checked_notes(const std::string& file,
                                              std::span<const std::uint8_t> json);

}  // namespace slf
