// SPDX-License-Identifier: Apache-2.0
// What slf eval says of a file, as JSON and as text.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "slf/evaluate.h"

namespace slf::tools {

/// One set of cameras and what was measured on it.
struct Measured {
  std::string name;  ///< "input", "held out"
  std::size_t cameras = 0;
  Quality quality;
  std::optional<Quality> unquantised;  ///< of the light field that --unquantised names
};

/// What is judged: a decoded file and what is said about it.
struct Subject {
  LightField field;
  std::uint64_t bytes = 0;
  Metadata metadata;
  nlohmann::ordered_json bytes_by_type, settings, decode_seconds;
  std::string bytes_text;
  std::size_t points = 0;  ///< where there is no field: of splats, of all frames

  std::size_t num_points() const { return points > 0 ? points : field.num_points(); }
};

/// @param images  whether pictures were judged too
nlohmann::ordered_json quality_json(const Measured& measured, bool images);
std::string quality_text(const Measured& measured, bool images);

/// @param images  whether pictures were judged too
nlohmann::ordered_json eval_json(const Subject& subject, const std::vector<Measured>& measured,
                                 bool images, double seconds);

/// @param name  of the file
std::string eval_text(const std::string& name, const Subject& subject,
                      const std::vector<Measured>& measured, bool images);

}  // namespace slf::tools
