#include "tools/measure_file.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include "slf/decoder.h"
#include "slf/evaluate.h"
#include "slf/view_map.h"
#include "tools/text.h"

namespace slf::tools {
namespace {

constexpr std::size_t kMostCameras = 32;

/// The capture, judged on the file's own points where it has none, as `slf eval` does.
Capture with_points(const Capture& capture, const LightField& field) {
  Capture judged = capture;
  for (const Voxel& voxel : field.positions) {
    const Vec3 at = field.header.grid.world(voxel);
    judged.cloud.positions.push_back(
        {static_cast<float>(at[0]), static_cast<float>(at[1]), static_cast<float>(at[2])});
  }
  return judged;
}

}  // namespace

Result<FilePictures, Failure> measure_file(const Encoded& encoded, const Capture& capture,
                                           std::span<const int> cameras, int threads) {
  const auto start = std::chrono::steady_clock::now();
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
  const Capture own = has_points ? Capture{} : with_points(capture, field);
  SLF_TRY(const Quality quality,
          from("the file that was written",
               evaluate(ViewMaps(field), has_points ? capture : own, some, settings)));
  const auto end = std::chrono::steady_clock::now();
  return FilePictures{quality.image.psnr, chosen,
                      std::chrono::duration<double>(end - start).count()};
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
