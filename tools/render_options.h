// SPDX-License-Identifier: Apache-2.0
// What slf render is told.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "slf/capture.h"
#include "tools/film.h"
#include "tools/options.h"
#include "tools/stream_input.h"

namespace slf::tools {

struct RenderOptions {
  std::string input, output, camera, capture, image, size, background = "128,128,128";
  std::string format;  ///< "png" or "jpg" in place of the name's
  int orbit = 0;
  double azimuth = 0, elevation = 20, fov = 30, radius = 0;
  bool own_view = false;  ///< no view was asked for: the file's own, if it has one
  bool sheet = false, pair = false, transparent = false, diffuse_only = false;
  std::optional<Camera> orbit_camera;  ///< of the first frame with points, for all
  std::optional<Film> film;            ///< in place of a picture a file
  PartOptions part;
  LimitOptions limits;
  CommonOptions common;
};

void add_render_options(CLI::App& verb, RenderOptions& options);

/// "R,G,B", each 0 to 255. @return false where it is none.
bool parse_background(const std::string& given, std::array<std::uint8_t, 3>& rgb);

/// Before any work is done. An output "DIR/" is made.
/// @errors kUsage, kWriteFailed
Outcome check_options(const RenderOptions& given);

}  // namespace slf::tools
