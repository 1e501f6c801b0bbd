// Quality, by one definition that every comparison uses.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "slf/capture.h"
#include "slf/error.h"
#include "slf/view_map.h"

namespace slf {

struct EvaluateSettings {
  std::vector<double> deltas_degrees{10};  ///< δ′, at least one, each 0 .. 90
  bool images = true;                      ///< image quality too (renders every camera)
  double depth_tolerance = 2.5;
  int threads = 0;
};

/// Of the views within one δ′. dB; infinite where nothing differs.
struct PointQuality {
  double delta_degrees = 10;
  double psnr = 0;       ///< pooled over points, cameras and channels
  double luma_psnr = 0;  ///< of Y = 0.2126 R + 0.7152 G + 0.0722 B (BT.709)
  std::array<double, 3> channel_psnr{};
  std::uint64_t observations = 0;
};

/// Rendered against photograph, where both show the object.
struct ImageQuality {
  double psnr = 0;      ///< dB, pooled over pixels and channels
  double ssim = 0;      ///< of luma; mean over pixels (lightfield/ssim.h)
  double coverage = 0;  ///< share of the photographs' object pixels that the renderings cover
  std::vector<double> psnr_each;  ///< [cameras]
};

struct Quality {
  std::vector<PointQuality> points;  ///< [deltas], in the order given
  ImageQuality image;                ///< zero where images were not asked for
  double render_seconds = 0;         ///< median of one image on one thread
};

/// Point PSNR: over every decoded point, every given camera valid under δ′, three channels: mean
/// squared error of radiance clamped and rounded to 8 bit, peak 255. Normals and visibility are
/// those of the capture (nearest point), so that all codecs are judged on one set. Spec annex D,
/// DESIGN 7.
/// @errors kInvalidArgument: no cameras or points, a camera index or δ′ out of range; those of
///         observe and load_image.
/// The same for any thread count, but for render_seconds.
Result<Quality, InputError> evaluate(const ViewMaps& maps, const Capture& capture,
                                     std::span<const int> cameras, const EvaluateSettings& settings,
                                     const Progress& progress = {});

}  // namespace slf
