// SPDX-License-Identifier: Apache-2.0
// Photographs and points to an IGC file. Mirrors tools/rd/igc/decode_igc.cpp.
#include <algorithm>
#include <charconv>
#include <optional>

#include "attributes/video/encoder/hevc_encoder.h"
#include "base/input_error.h"
#include "base/stopwatch.h"
#include "encoder/check_settings.h"
#include "encoder/choose_surface.h"
#include "encoder/encode_metadata.h"
#include "encoder/fit_capture.h"
#include "tools/rd/igc/av1_codec.h"
#include "tools/rd/igc/camera_walk.h"
#include "tools/rd/igc/igc.h"
#include "tools/rd/igc/igc_file.h"
#include "tools/rd/igc/igc_parameters.h"
#include "tools/rd/igc/ycbcr.h"

namespace slf {
namespace {

using Video = Result<std::vector<std::uint8_t>, InputError>;
using Source = std::function<Picture(std::size_t)>;

std::string size_text(int width, int height) {
  return std::to_string(width) + " x " + std::to_string(height);
}

Result<Done, InputError> check_cameras(const Capture& capture, std::span<const int> cameras) {
  if (cameras.empty()) return invalid_argument("image-plus-geometry coding needs cameras");
  for (const int i : cameras)
    if (i < 0 || static_cast<std::size_t>(i) >= capture.cameras.size())
      return invalid_argument("camera " + std::to_string(i) + " is not one of the capture's " +
                              std::to_string(capture.cameras.size()));
  const Camera& first = capture.cameras[static_cast<std::size_t>(cameras[0])];
  for (const int i : cameras) {
    const Camera& camera = capture.cameras[static_cast<std::size_t>(i)];
    if (camera.width != first.width || camera.height != first.height)
      return InputError{Errc::kInvalidInput,
                        camera.name + ": image of " + size_text(camera.width, camera.height) +
                            " pixels, others of " + size_text(first.width, first.height)};
  }
  return Done{};
}

/// Positions alone: an .slf stream of no functions.
Video encode_geometry(const VoxelCloud& cloud, const Capture& capture,
                      const EncoderSettings& settings) {
  LightField field;
  field.header.grid = moved(cloud.grid, capture.origin);
  field.header.up = capture.up;
  field.header.transfer = settings.observe.transfer;
  field.header.has_basis = false;
  field.positions = cloud.positions;
  CodingParameters parameters;
  parameters.geometry = settings.geometry;
  if (cloud.positions.size() <= kMostSlicePoints) parameters.base_levels = 0;  // fewer bytes
  parameters.max_slice_points = kMostSlicePoints;
  parameters.digest = parameters.index = false;  // bytes that serve no comparison
  parameters.threads = settings.threads;
  return pack(field, parameters);
}

Video encode_video(std::size_t pictures, const Source& source, const IgcSettings& settings) {
  if (settings.codec != IgcCodec::kAv1) {
    HevcSettings hevc;
    hevc.qp = settings.qp;
    hevc.mode = settings.codec == IgcCodec::kHevcIntra ? HevcMode::kIntra : HevcMode::kLowDelay;
    hevc.preset = settings.speed.empty() ? "medium" : settings.speed;
    return encode_hevc(pictures, source, hevc);
  }
  Av1Settings av1;
  av1.cq_level = settings.qp;
  const char* end = settings.speed.data() + settings.speed.size();
  if (!settings.speed.empty()) {
    const auto [stop, error] = std::from_chars(settings.speed.data(), end, av1.cpu_used);
    if (error != std::errc() || stop != end)
      return invalid_argument("speed " + settings.speed + ": 0 to 8 for AV1");
  }
  return encode_av1(pictures, source, av1);
}

/// The photographs, in the order of `cameras`.
Video encode_images(const Capture& capture, std::span<const int> cameras,
                    const IgcSettings& settings, const Progress& progress) {
  std::optional<InputError> unread;
  const Source source = [&](std::size_t i) {
    if (progress) progress("images", static_cast<double>(i) / static_cast<double>(cameras.size()));
    const auto image = load_image(capture, cameras[i]);
    if (image) return to_ycbcr(*image, settings.chroma);
    unread = image.error();
    return Picture{};  // refused by the codec, which ends it
  };
  auto coded = encode_video(cameras.size(), source, settings);
  if (unread) return *unread;
  return coded;
}

}  // namespace

Result<IgcEncoded, InputError> encode_igc(const Capture& capture, std::span<const int> cameras,
                                          const IgcSettings& settings, const Progress& progress) {
  SLF_CHECK(check_settings(settings.slf));
  SLF_CHECK(check_cameras(capture, cameras));
  Stopwatch watch;
  IgcEncoded encoded;
  if (settings.slf.surface == Surface::kSplats)
    return InputError{Errc::kInvalidArgument, "surface: splats are of .slf files"};
  SLF_TRY(const VoxelCloud cloud, choose_surface(capture, cameras, settings.slf, StartId::kPoints,
                                                 encoded.surface, progress));
  encoded.points = cloud.positions.size();
  encoded.merged = cloud.merged;
  encoded.grid = moved(cloud.grid, capture.origin);
  encoded.density = cloud.density;
  encoded.seconds_voxelise = watch.lap() - encoded.surface.seconds();
  SLF_TRY(const auto geometry, encode_geometry(cloud, capture, settings.slf));
  encoded.seconds_geometry = watch.lap();
  std::vector<int> walk;
  for (const int place : camera_walk(capture, cameras))
    walk.push_back(cameras[static_cast<std::size_t>(place)]);
  SLF_TRY(const auto images, encode_images(capture, walk, settings, progress));
  encoded.seconds_images = watch.lap();
  const Camera& first = capture.cameras[static_cast<std::size_t>(cameras[0])];
  IgcParameters parameters{first.width, first.height, settings, {}};
  for (auto& pair : grid_metadata(settings.slf, cloud.grid, cloud.density))
    parameters.settings.slf.metadata.push_back(std::move(pair));
  for (const int camera : walk)
    parameters.cameras.push_back(capture.cameras[static_cast<std::size_t>(camera)].name);
  SLF_TRY(const auto text, write_igc_parameters(parameters));
  encoded.stream = write_igc_file({text, geometry, images});
  encoded.bytes_geometry = geometry.size() + kIgcSectionBytes;
  encoded.bytes_images = images.size() + kIgcSectionBytes;
  encoded.bytes_parameters = encoded.stream.size() - encoded.bytes_geometry - encoded.bytes_images;
  return encoded;
}

}  // namespace slf
