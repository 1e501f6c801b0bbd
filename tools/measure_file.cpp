// SPDX-License-Identifier: Apache-2.0
#include "tools/measure_file.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "slf/decoder.h"
#include "slf/evaluate.h"
#include "slf/view_map.h"
#include "tools/dump.h"
#include "tools/eval_subject.h"
#include "tools/options.h"
#include "tools/text.h"

namespace slf::tools {
namespace {

// Pixels. Right poses: 0.01 to 0.1 on four captures; the dinosaur, which has wrong ones: 0.4.
constexpr double kOffPixels = 0.25;
constexpr std::size_t kMostCameras = 32;
// dB. Captures whose parts belong together: 20 and more of the default; photographs of two objects
// 15.
constexpr double kUnlike = 17;
// Below, a picture lies off by what points and pixels are wide: 0.3 and more with right poses.
constexpr int kLeastSide = 128;
constexpr std::size_t kLeastCameras = 4;
constexpr double kCoarse = 3;  // pixels of a voxel

int least_side(const Capture& capture, std::span<const int> cameras) {
  int side = cameras.empty() ? 0 : std::numeric_limits<int>::max();
  for (const int c : cameras) {
    const Camera& camera = capture.cameras[static_cast<std::size_t>(c)];
    side = std::min({side, camera.width, camera.height});
  }
  return side;
}

std::string off_cameras_warning(const FilePictures& pictures, const Encoded& encoded) {
  if (!(pictures.off_pixels > kOffPixels) || !encoded.poses.cameras.empty()) return {};
  if (pictures.side < kLeastSide || pictures.cameras < kLeastCameras) return {};
  if (encoded.density.pixel > 0 && encoded.grid.step > kCoarse * encoded.density.pixel) return {};
  return text(
      "pictures lie %.2f pixels off their photographs (median): poses of cameras may be wrong; "
      "--refine-cameras on trains them",
      pictures.off_pixels);
}

std::string unlike_pictures_warning(const FilePictures& pictures, const EncoderSettings& settings) {
  if (settings.q != kAutomaticQ || settings.target_bytes > 0 || settings.target_psnr > 0) return {};
  if (!(pictures.psnr < kUnlike)) return {};
  return text(
      "pictures are %.1f dB from their photographs, as of another thing: do cameras, points and "
      "photographs belong together?",
      pictures.psnr);
}

}  // namespace

Capture with_points_of(const LightField& field, Capture capture, int threads) {
  capture.cloud = mean_cloud(field, threads);
  const Vec3 to = std::exchange(capture.cloud.origin, Vec3{0, 0, 0}), from = capture.origin;
  for (Camera& camera : capture.cameras)
    camera = moved(std::move(camera), {from[0] - to[0], from[1] - to[1], from[2] - to[2]});
  capture.origin = to;
  return capture;
}

std::vector<int> used_cameras(const Encoded& encoded, std::vector<int> cameras) {
  for (const CameraTrust& trust : encoded.cameras)
    if (trust.verdict == CameraVerdict::kDropped) std::erase(cameras, trust.camera);
  return cameras;
}

Result<FilePictures, Failure> measure_file(const Encoded& encoded, const Capture& capture,
                                           std::span<const int> cameras, int threads) {
  Stopwatch watch;
  DecodeOptions options;
  options.threads = threads;
  options.limits = DecodeLimits::none();
  SLF_TRY(const LightField field,
          from("the file that was written", decode(encoded.stream, options)));
  const std::size_t chosen = std::min(cameras.size(), kMostCameras);
  std::vector<int> some;
  for (std::size_t c = 0; c < chosen; ++c) some.push_back(cameras[c * cameras.size() / chosen]);
  EvaluateSettings settings;
  settings.threads = threads;
  const bool has_points = !capture.cloud.positions.empty();
  const Capture own = has_points ? Capture{} : with_points_of(field, capture, threads);
  const Capture& judge = has_points ? capture : own;
  if (has_gaussians(field.header)) {
    SLF_TRY(Gaussians splats, from("the file that was written", gaussians_of(field, threads)));
    SLF_TRY(const Quality quality,
            from("the file that was written",
                 evaluate_pictures(pictures_of(std::move(splats)), judge, some, settings)));
    return FilePictures{quality.image.psnr, chosen, quality.image.off_pixels,
                        least_side(judge, some), watch.lap()};
  }
  SLF_TRY(const Quality quality,
          from("the file that was written", evaluate(ViewMaps(field), judge, some, settings)));
  return FilePictures{quality.image.psnr, chosen, quality.image.off_pixels, least_side(judge, some),
                      watch.lap()};
}

void take_poses(const PoseReport& poses, Capture& capture) {
  // Poses alone: the encoder may have had smaller photographs.
  for (std::size_t c = 0; c < poses.cameras.size(); ++c) {
    capture.cameras[c].rotation = poses.cameras[c].rotation;
    capture.cameras[c].translation = poses.cameras[c].translation;
  }
}

std::vector<std::string> picture_warnings(const FilePictures& pictures, const Encoded& encoded,
                                          const EncoderSettings& settings) {
  std::vector<std::string> warnings = {off_cameras_warning(pictures, encoded),
                                       unlike_pictures_warning(pictures, settings)};
  std::erase(warnings, "");
  return warnings;
}

std::string pictures_text(const FilePictures& pictures, const Encoded& encoded,
                          std::size_t input_cameras) {
  if (std::isnan(pictures.psnr))
    return "pictures      no photograph shows the object where there are points\n";
  std::string of = pictures.cameras == input_cameras
                       ? std::string("the input")
                       : text("%zu of the input photographs", pictures.cameras);
  std::string out = text("pictures      %.2f dB of %s", pictures.psnr, of.c_str());
  if (encoded.fit.settings.pictures.rounds > 0)
    out += text(", %.2f before quantisation", encoded.pictures.psnr_after);
  return out + "\n";
}

}  // namespace slf::tools
