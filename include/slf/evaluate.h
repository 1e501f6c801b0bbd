// Quality, by one definition that every comparison uses.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "slf/capture.h"
#include "slf/error.h"
#include "slf/view_map.h"

namespace slf {

struct EvaluateSettings {
  double delta_degrees = 10;  ///< δ′
  bool images = true;         ///< image PSNR too (renders every camera)
  double depth_tolerance = 2.5;
  int threads = 0;
};

struct Quality {
  double point_psnr = 0;  ///< dB, pooled over points, cameras, channels
  std::array<double, 3> channel_psnr{};
  std::uint64_t observations = 0;
  double image_psnr = 0;  ///< dB, pooled over pixels both cover
  double coverage = 0;    ///< share of the photographs' object pixels that the renderings cover
  std::vector<double> image_psnr_each;  ///< [cameras]
};

/// Point PSNR: over every decoded point, every given camera valid under δ′, three channels: mean
/// squared error of radiance clamped and rounded to 8 bit, peak 255. Normals and visibility are
/// those of the capture (nearest point), so that all codecs are judged on one set. Spec annex D,
/// DESIGN 7.
Result<Quality, InputError> evaluate(const ViewMaps& maps, const Capture& capture,
                                     std::span<const int> cameras, const EvaluateSettings& settings,
                                     const Progress& progress = {});

}  // namespace slf
