// SPDX-License-Identifier: Apache-2.0
// Quality, by one definition that every comparison uses. Spec annex D.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "slf/capture.h"
#include "slf/error.h"
#include "slf/render.h"
#include "slf/view_map.h"

namespace slf {

struct EvaluateSettings {
  std::vector<double> deltas_degrees{10};  ///< δ′, at least one, each 0 .. 90
  bool images = true;                      ///< image quality too (renders every camera)
  double depth_tolerance = 2.5;            ///< of what hides a point, in spacings of the points
  /// R, G, B of each rendering are multiplied by what brings it nearest to its photograph, in least
  /// squares where both show the object: photographs of any exposure and white balance are then
  /// judged by their patterns. Points are judged as they are.
  bool match_exposure = false;
  /// Each camera's picture is first shifted, turned and scaled by what brings the rendering nearest
  /// to its photograph, 4 pixels at most: poses that are wrong by parts of a pixel are then no
  /// error of the file. Points are judged with the cameras as they are.
  bool align_cameras = false;
  int threads = 0;
  /// Where given: called once for every camera, from several threads, with one image of three times
  /// the photograph's width: photograph, rendering, and 128 + 4 (rendering - photograph), clamped.
  std::function<Result<Done, InputError>(int camera, const Image& map)> error_map;
};

/// Quality over the views within one δ′. dB; infinite where nothing differs, NaN where the capture
/// hides all points.
struct PointQuality {
  double delta_degrees = 10;
  double psnr = 0;       ///< pooled over points, cameras and channels
  double luma_psnr = 0;  ///< of Y = 0.2126 R + 0.7152 G + 0.0722 B (BT.709)
  std::array<double, 3> channel_psnr{};
  std::uint64_t observations = 0;
};

/// Rendered against photograph, over the same pixels of each.
struct PictureQuality {
  double psnr = 0;     ///< dB, pooled over pixels and channels
  double ssim = 0;     ///< of luma; mean over pixels (encoder/measure/ssim.h)
  double ms_ssim = 0;  ///< of luma; mean over pictures (encoder/measure/ssim.h)
};

/// A part of the pixels at which both show the object. Shares are of all of those.
struct PictureRegion {
  double psnr = 0;  ///< dB; NaN where there is no pixel of it
  double pixel_share = 0, error_share = 0;
};

/// Both pictures over one background: the photograph's own (spec annex D).
struct ImageQuality : PictureQuality {  ///< where both show the object
  PictureQuality all;                   ///< of every pixel
  double coverage = 0;  ///< share of the photographs' object pixels that the renderings cover
  /// Share of the squared error at the photographs' object pixels that is where no rendering covers
  /// them; and of that at all pixels where no photograph shows the object.
  double uncovered_error_share = 0, outside_error_share = 0;
  PictureRegion grazing;  ///< the ray is within 10° of the capture's surface
  PictureRegion rim;  ///< not that, but within 2 pixels of a silhouette or a step in depth of it
  PictureRegion rest;
  /// How far a picture would have to move to lie on its photograph, or was moved by align_cameras:
  /// median over cameras. 0.1 or less says nothing; more says that poses are wrong.
  double off_pixels = 0;
  std::vector<double> psnr_each;  ///< [cameras] dB, where both show the object
};

struct Quality {
  std::vector<PointQuality> points;  ///< [deltas], in the order given
  ImageQuality image;                ///< zero where images were not asked for
  double render_seconds = 0;         ///< median of one image on one thread
};

/// Point PSNR: over every decoded point, every given camera valid under δ′, three channels: mean
/// squared error of radiance clamped and rounded to 8 bit, peak 255. Normals and visibility are
/// those of the capture (nearest point), so that all codecs are judged on one set. Spec annex D.
/// @errors kInvalidArgument: no cameras or points, a camera index or δ′ out of range; those of
///         observe, load_image and settings.error_map. Points that no camera sees are none where
///         pictures show something.
/// The same for any thread count, but for render_seconds.
Result<Quality, InputError> evaluate(const ViewMaps& maps, const Capture& capture,
                                     std::span<const int> cameras, const EvaluateSettings& settings,
                                     const Progress& progress = {});

/// A picture over black. Called from several threads at a time.
using DrawPicture = std::function<Rendering(const Camera& camera)>;

/// Pictures of anything that can be drawn against photographs, as evaluate() has them of a light
/// field; Quality::points is empty, deltas have no meaning. The capture's points say where its
/// surface is.
/// @errors kInvalidArgument: no cameras, or one out of range, no points of the capture; those of
///         load_image and settings.error_map
Result<Quality, InputError> evaluate_pictures(const DrawPicture& draw, const Capture& capture,
                                              std::span<const int> cameras,
                                              const EvaluateSettings& settings,
                                              const Progress& progress = {});

/// What a file's pictures lose, and where: shares of the squared error at the photographs' object
/// pixels, which sum to 1. A share is negative where that step gains: pictures of a light field
/// that was fitted to pictures can be better than its points.
struct QualityGap {
  double coverage = 0;      ///< nothing is drawn there
  double points = 0;        ///< the unquantised light field at its points
  double splatting = 0;     ///< its pictures against its points
  double quantisation = 0;  ///< the file's pictures against those of the unquantised
};

/// @param unquantised, coded  of the same cameras and settings, with images; coverage is the
/// coded's
QualityGap quality_gap(const Quality& unquantised, const Quality& coded);

}  // namespace slf
