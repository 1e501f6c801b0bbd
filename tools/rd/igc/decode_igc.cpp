// SPDX-License-Identifier: Apache-2.0
// An IGC file to a light field: the decoder does what the encoder of .slf does. Mirrors
// tools/rd/igc/encode_igc.cpp.
#include <algorithm>
#include <map>
#include <utility>

#include "attributes/video/hevc_decoder.h"
#include "base/error_words.h"
#include "base/stopwatch.h"
#include "capture/nearest.h"
#include "encoder/encode_metadata.h"
#include "encoder/fit_capture.h"
#include "slf/decoder.h"
#include "slf/parallel.h"
#include "tools/rd/igc/av1_codec.h"
#include "tools/rd/igc/igc.h"
#include "tools/rd/igc/igc_file.h"
#include "tools/rd/igc/igc_parameters.h"
#include "tools/rd/igc/ycbcr.h"

namespace slf {
namespace {

using Bytes = std::span<const std::uint8_t>;

InputError corrupt(const std::string& what) { return {Errc::kInvalidInput, "IGC file: " + what}; }

/// The result of a bitstream call, its error as a person reads it.
template <class T>
Result<T, InputError> from(Result<T> result) {
  if (!result) return InputError{result.error().code, in_words(result.error())};
  return *std::move(result);
}

/// A capture of the file's cameras, without images as yet; `order` receives their indices in it.
Result<Capture, InputError> file_cameras(const IgcParameters& parameters, const Capture& given,
                                         std::vector<int>& order) {
  std::map<std::string, int> index;
  for (std::size_t i = 0; i < given.cameras.size(); ++i)
    index.emplace(given.cameras[i].name, static_cast<int>(i));
  for (const std::string& name : parameters.cameras) {
    const auto found = index.find(name);
    if (found == index.end()) return corrupt("camera " + name + " is not the capture's, or twice");
    const Camera& camera = given.cameras[static_cast<std::size_t>(found->second)];
    if (camera.width != parameters.width || camera.height != parameters.height)
      return corrupt("camera " + name + " has another size in the capture");
    order.push_back(found->second);
    index.erase(found);
  }
  Capture capture;
  capture.origin = given.origin;
  capture.cameras = given.cameras;
  return capture;
}

Result<Done, InputError> decode_images(Bytes section, const IgcParameters& parameters,
                                       const DecodeLimits& limits, std::span<const int> order,
                                       Capture& capture, const Progress& progress) {
  const IgcSettings& settings = parameters.settings;
  const VideoFormat format =
      video_format(parameters.width, parameters.height, settings.chroma, order.size());
  const auto pixels =
      static_cast<std::uint64_t>(format.width) * static_cast<std::uint64_t>(format.height);
  if (pixels * 3 > limits.max_memory / order.size())
    return InputError{Errc::kLimitExceeded, "IGC file: images larger than the limit"};
  capture.images.resize(capture.cameras.size());
  const auto sink = [&](std::size_t i, const Picture& picture) {
    if (progress) progress("images", static_cast<double>(i) / static_cast<double>(order.size()));
    capture.images[static_cast<std::size_t>(order[i])] =
        to_rgb(picture, parameters.width, parameters.height);
  };
  return from(settings.codec == IgcCodec::kAv1 ? decode_av1(section, format, sink)
                                               : decode_hevc(section, format, sink));
}

/// Normals of the nearest captured points.
std::vector<std::array<float, 3>> captured_normals(const PointCloud& captured,
                                                   const PointCloud& points, int threads) {
  const NearestPoints tree(captured.positions);
  std::vector<std::array<float, 3>> normals(points.positions.size());
  parallel_ranges(normals.size(), 1024, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      std::uint32_t nearest = 0;
      tree.nearest(points.positions[p], 1, &nearest, nullptr);
      normals[p] = captured.normals[nearest];
    }
  });
  return normals;
}

/// The decoded points as a voxel cloud from the capture's origin, with normals.
VoxelCloud with_normals(LightField geometry, const Capture& capture, const PointCloud& captured,
                        const IgcDecodeOptions& options) {
  VoxelCloud cloud;
  const Vec3& origin = capture.origin;
  cloud.grid = moved(geometry.header.grid, {-origin[0], -origin[1], -origin[2]});
  cloud.positions = std::move(geometry.positions);
  PointCloud points;
  for (const Voxel& v : cloud.positions) {
    const Vec3 w = cloud.grid.world(v);
    points.positions.push_back(
        {static_cast<float>(w[0]), static_cast<float>(w[1]), static_cast<float>(w[2])});
  }
  if (!options.estimate_normals && !captured.normals.empty()) {
    cloud.normals = captured_normals(captured, points, options.threads);
    return cloud;
  }
  std::vector<Vec3> viewpoints;
  for (const Camera& camera : capture.cameras) viewpoints.push_back(camera.centre());
  cloud.normals = estimate_normals(points, viewpoints, 16, options.threads);
  return cloud;
}

Result<LightField, InputError> decode_geometry(Bytes section, const IgcDecodeOptions& options) {
  DecodeOptions decode_options;
  decode_options.limits = options.limits;
  decode_options.threads = options.threads;
  SLF_TRY(LightField geometry, from(decode(section, decode_options)));
  if (geometry.partial || geometry.header.num_functions != 0 || geometry.positions.empty())
    return corrupt("geometry is not a whole cloud without functions");
  return geometry;
}

/// What the fit and the depth buffers will take.
Result<Done, InputError> check_size(const IgcParameters& parameters, std::size_t points,
                                    const DecodeLimits& limits) {
  const EncoderSettings& s = parameters.settings.slf;
  // A search may choose a basis of up to sqrt 2 as many.
  const double functions = s.fit.basis.num_functions() * (s.search.basis ? 1.5 : 1);
  const double scale = s.observe.occlusion_resolution;
  const double view_maps = static_cast<double>(points) * (12 + 12 * functions);
  const double depths = 4 * scale * scale * parameters.width * parameters.height;
  if (std::max(view_maps, depths) <= static_cast<double>(limits.max_memory)) return Done{};
  return InputError{Errc::kLimitExceeded, "IGC file: view maps or depth buffers beyond the limit"};
}

}  // namespace

bool is_igc(Bytes stream) {
  return stream.size() >= kIgcSignature.size() &&
         std::equal(kIgcSignature.begin(), kIgcSignature.end(), stream.begin());
}

Result<IgcDecoded, InputError> decode_igc(Bytes stream, const Capture& given,
                                          const IgcDecodeOptions& options,
                                          const Progress& progress) {
  IgcDecoded decoded;
  SLF_TRY(const IgcSections sections, from(read_igc_file(stream)));
  decoded.bytes_geometry = sections.geometry.size() + kIgcSectionBytes;
  decoded.bytes_images = sections.images.size() + kIgcSectionBytes;
  decoded.bytes_parameters = stream.size() - decoded.bytes_geometry - decoded.bytes_images;
  SLF_TRY(IgcParameters parameters, read_igc_parameters(sections.parameters, decoded.metadata));
  std::vector<int> order;
  SLF_TRY(Capture capture, file_cameras(parameters, given, order));
  Stopwatch watch;
  SLF_TRY(LightField geometry, decode_geometry(sections.geometry, options));
  SLF_CHECK(check_size(parameters, geometry.num_points(), options.limits));
  const UpAxis up = geometry.header.up;
  decoded.seconds_geometry = watch.lap();
  SLF_CHECK(decode_images(sections.images, parameters, options.limits, order, capture, progress));
  decoded.seconds_images = watch.lap();
  EncoderSettings& settings = parameters.settings.slf;
  settings.check_cameras = settings.fit.method == FitMethod::kHierarchical;
  settings.threads = settings.observe.threads = settings.fit.threads = options.threads;
  const VoxelCloud cloud = with_normals(std::move(geometry), capture, given.cloud, options);
  const double seconds_normals = watch.lap();
  SLF_TRY(CaptureFit fit, fit_capture(capture, order, cloud, settings, progress));
  decoded.seconds_observe = seconds_normals + fit.seconds_observe;
  decoded.seconds_fit = fit.seconds_choose + fit.seconds_fit + fit.seconds_pictures;
  settings.fit = fit.chosen.settings;
  for (const auto& [key, value] : fit_metadata(fit.chosen))
    decoded.metadata.emplace_back("chosen_" + key, value);
  decoded.light_field = quantise_grid(cloud, std::move(fit), capture.origin, up, settings);
  return decoded;
}

}  // namespace slf
