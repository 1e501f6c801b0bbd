// SPDX-License-Identifier: Apache-2.0
#include "encoder/train/training_view.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "capture/object_mask.h"
#include "capture/quantile.h"
#include "encoder/fit/observe_depth.h"
#include "encoder/measure/picture_background.h"
#include "slf/parallel.h"

namespace slf {
namespace {

TrainingCamera pinhole(const Camera& camera) {
  TrainingCamera out;
  out.width = camera.width;
  out.height = camera.height;
  out.fx = float(camera.fx), out.fy = float(camera.fy);
  out.cx = float(camera.cx), out.cy = float(camera.cy);
  const Vec3 centre = camera.centre();
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c) out.rotation[r][c] = float(camera.rotation[r][c]);
    out.translation[r] = float(camera.translation[r]);
    out.centre[r] = float(centre[r]);
  }
  return out;
}

/// Median depth of the points in the picture; 0 without any.
float depth_of(const Camera& camera, const SurfacePoints& points) {
  constexpr std::size_t kLooked = 2000;
  std::vector<float> depths;
  const std::size_t stride = std::max<std::size_t>(points.size() / kLooked, 1);
  for (std::size_t p = 0; p < points.size(); p += stride) {
    const Float3& at = points.positions[p];
    double z = 0;
    const auto image = camera.project({at[0], at[1], at[2]}, &z);
    if (image && (*image)[0] >= 0 && (*image)[0] < camera.width && (*image)[1] >= 0 &&
        (*image)[1] < camera.height)
      depths.push_back(float(z));
  }
  return depths.empty() ? 0.0f : median(std::move(depths));
}

/// Those of photographs that show no point: the median of the others, else 1.
void guess_depths(std::vector<TrainingView>& views) {
  std::vector<float> known;
  for (const TrainingView& view : views)
    if (view.camera.depth > 0) known.push_back(view.camera.depth);
  const float guess = known.empty() ? 1.0f : median(std::move(known));
  for (TrainingView& view : views)
    if (!(view.camera.depth > 0)) view.camera.depth = guess;
}

std::vector<std::uint8_t> object_of(const Camera& camera, const SurfacePoints& points,
                                    double spacing) {
  const DepthBuffer buffer(camera, points.positions, {1, 0.6 * spacing, 2.5});
  std::vector<std::uint8_t> object;
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x)
      object.push_back(buffer.hides({x + 0.5, y + 0.5}, 1e30, 1));
  return object;
}

/// Where a pinhole camera's image point is in the photograph.
/// @param lens  the camera, in its own axes
std::array<double, 2> distorted(const Camera& lens, double u, double v) {
  const auto at = lens.project({(u - lens.cx) / lens.fx, (v - lens.cy) / lens.fy, 1});
  return at ? *at : std::array{u, v};
}

/// Bilinear, held at the edges.
float sample(const Image& image, std::size_t channel, double u, double v) {
  const double x = std::clamp(u - 0.5, 0.0, double(image.width - 1));
  const double y = std::clamp(v - 0.5, 0.0, double(image.height - 1));
  const auto x0 = std::size_t(x), y0 = std::size_t(y);
  const std::size_t x1 = std::min(x0 + 1, std::size_t(image.width - 1));
  const std::size_t y1 = std::min(y0 + 1, std::size_t(image.height - 1));
  const auto at = [&](std::size_t column, std::size_t row) {
    return double(image.data[3 * (row * std::size_t(image.width) + column) + channel]);
  };
  const double fx = x - double(x0), fy = y - double(y0);
  return float(((at(x0, y0) * (1 - fx) + at(x1, y0) * fx) * (1 - fy) +
                (at(x0, y1) * (1 - fx) + at(x1, y1) * fx) * fy) /
               255);
}

PlanarPicture picture_of(const Camera& camera, const Image& image) {
  PlanarPicture picture{image.width, image.height, {}};
  picture.value.resize(3 * picture.pixels());
  const bool straight = camera.distortion == std::array<double, 4>{0, 0, 0, 0};
  Camera lens = camera;
  lens.rotation = Camera{}.rotation;
  lens.translation = {0, 0, 0};
  std::size_t i = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x, ++i) {
      if (straight) {
        for (std::size_t c = 0; c < 3; ++c)
          picture.plane(c)[i] = float(image.data[3 * i + c]) / 255;
        continue;
      }
      const auto [u, v] = distorted(lens, x + 0.5, y + 0.5);
      for (std::size_t c = 0; c < 3; ++c) picture.plane(c)[i] = sample(image, c, u, v);
    }
  return picture;
}

ViewSetting setting_of(const Capture& capture, std::size_t camera, const Image& image,
                       const SurfacePoints& surface, double spacing) {
  const bool has_mask = camera < capture.mask_files.size() && !capture.mask_files[camera].empty();
  const Camera& whole = capture.cameras[camera];
  std::vector<std::uint8_t> object = object_of(whole, surface, spacing);
  if (image.channels == 4)
    for (std::size_t i = 0; i < object.size(); ++i) object[i] = shows_object(image.data[4 * i + 3]);
  return {picture_background(image, object, has_mask), depth_of(whole, surface)};
}

/// @param setting  found where it is not known
Result<TrainingView, InputError> load_training_view(const Capture& capture, int index,
                                                    const SurfacePoints& surface, double spacing,
                                                    int log2, std::optional<ViewSetting>& setting) {
  const auto camera = std::size_t(index);
  SLF_TRY(const Image image, load_image(capture, index));
  if (!setting) setting = setting_of(capture, camera, image, surface, spacing);
  const Camera& whole = capture.cameras[camera];
  TrainingView view;
  view.index = index;
  view.camera = pinhole(whole);
  view.camera.depth = setting->depth;
  view.picture = picture_of(whole, over_background(image, setting->background));
  for (std::size_t c = 0; c < 3; ++c) view.background[c] = float(setting->background[c]) / 255;
  for (int i = 0; i < log2; ++i) view = half(view);
  return view;
}

}  // namespace

Result<std::vector<TrainingView>, InputError> load_training_views(
    const Capture& capture, std::span<const int> cameras, const SurfacePoints& surface,
    double spacing, int log2, int threads, TrainingCache* cache) {
  TrainingCache own;
  if (cache == nullptr) cache = &own;
  cache->views.resize(capture.cameras.size());
  std::vector<TrainingView> views(cameras.size());
  std::vector<std::optional<InputError>> failures(cameras.size());
  parallel_ranges(cameras.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      auto view = load_training_view(capture, cameras[i], surface, spacing, log2,
                                     cache->views[std::size_t(cameras[i])]);
      if (view)
        views[i] = *std::move(view);
      else
        failures[i] = view.error();
    }
  });
  for (const auto& failure : failures)
    if (failure) return *failure;
  guess_depths(views);
  return views;
}

TrainingView half(const TrainingView& view) {
  TrainingView out = view;
  TrainingCamera& camera = out.camera;
  camera.width /= 2, camera.height /= 2;
  camera.fx /= 2, camera.fy /= 2, camera.cx /= 2, camera.cy /= 2;
  out.picture = {camera.width, camera.height, {}};
  out.picture.value.resize(3 * out.picture.pixels());
  const auto from = std::size_t(view.picture.width), to = std::size_t(camera.width);
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t y = 0; y < std::size_t(camera.height); ++y)
      for (std::size_t x = 0; x < to; ++x) {
        const float* at = view.picture.plane(c) + 2 * y * from + 2 * x;
        out.picture.plane(c)[y * to + x] = (at[0] + at[1] + at[from] + at[from + 1]) / 4;
      }
  if (view.hiding.empty()) return out;
  out.hiding.resize(out.picture.pixels());
  for (std::size_t y = 0; y < std::size_t(camera.height); ++y)
    for (std::size_t x = 0; x < to; ++x) {
      const float* at = view.hiding.data() + 2 * y * from + 2 * x;
      out.hiding[y * to + x] = std::min({at[0], at[1], at[from], at[from + 1]});
    }
  return out;
}

}  // namespace slf
