// SPDX-License-Identifier: Apache-2.0
#include "encoder/refine/photo_views.h"

#include <cmath>
#include <limits>

#include "capture/object_mask.h"
#include "slf/parallel.h"

namespace slf {
namespace {

constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();

PhotoView grey_view(const Camera& camera, const Image& image) {
  PhotoView view;
  view.camera = &camera;
  view.centre = camera.centre();
  view.width = image.width;
  view.height = image.height;
  view.grey.resize(std::size_t(image.width) * std::size_t(image.height));
  const auto channels = std::size_t(image.channels);
  for (std::size_t i = 0; i < view.grey.size(); ++i) {
    const std::uint8_t* rgb = &image.data[i * channels];
    const bool masked = channels == 4 && !shows_object(rgb[3]);
    view.grey[i] =
        masked ? kNothing : 0.25f * float(rgb[0]) + 0.5f * float(rgb[1]) + 0.25f * float(rgb[2]);
  }
  return view;
}

}  // namespace

float PhotoView::sample(float u, float v) const {
  const float x = u - 0.5f, y = v - 0.5f;
  if (!(x >= 0 && y >= 0 && x < float(width - 1) && y < float(height - 1))) return kNothing;
  const int column = int(x), row = int(y);
  const float fx = x - float(column), fy = y - float(row);
  const float* top = &grey[std::size_t(row) * std::size_t(width) + std::size_t(column)];
  const float* bottom = top + width;
  const float above = top[0] + fx * (top[1] - top[0]);
  const float below = bottom[0] + fx * (bottom[1] - bottom[0]);
  return above + fy * (below - above);
}

Result<std::vector<PhotoView>, InputError> load_views(const Capture& capture,
                                                      std::span<const int> cameras, int threads) {
  std::vector<PhotoView> views(cameras.size());
  std::vector<std::optional<InputError>> failures(cameras.size());
  parallel_ranges(cameras.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto image = load_image(capture, cameras[i]);
      if (image)
        views[i] = grey_view(capture.cameras[std::size_t(cameras[i])], *image);
      else
        failures[i] = image.error();
    }
  });
  for (const auto& failure : failures)
    if (failure) return *failure;
  return views;
}

PhotoView half(const PhotoView& view) {
  PhotoView small;
  small.camera = view.camera;
  small.centre = view.centre;
  small.scale = view.scale / 2;
  small.width = view.width / 2;
  small.height = view.height / 2;
  small.grey.resize(std::size_t(small.width) * std::size_t(small.height));
  for (int y = 0; y < small.height; ++y)
    for (int x = 0; x < small.width; ++x) {
      const float* top =
          &view.grey[std::size_t(2 * y) * std::size_t(view.width) + std::size_t(2 * x)];
      const float* bottom = top + view.width;
      small.grey[std::size_t(y) * std::size_t(small.width) + std::size_t(x)] =
          0.25f * (top[0] + top[1] + bottom[0] + bottom[1]);
    }
  return small;
}

std::optional<PatchPath> patch_path(const PhotoView& view, const Float3& position,
                                    const Float3& normal, const Float3& a, const Float3& b,
                                    double unit) {
  const auto project = [&](const Float3& direction, double distance, double& z) {
    return view.camera->project({double(position[0]) + distance * double(direction[0]),
                                 double(position[1]) + distance * double(direction[1]),
                                 double(position[2]) + distance * double(direction[2])},
                                &z);
  };
  double z = 0, z_up = 0, ignored = 0;
  const auto centre = project(normal, 0, z);
  const auto up = project(normal, unit, z_up);
  const auto along_a = project(a, unit, ignored);
  const auto along_b = project(b, unit, ignored);
  if (!centre || !up || !along_a || !along_b) return std::nullopt;
  PatchPath path;
  // A pinhole's image of a line; with distortion the same to first order.
  for (std::size_t i = 0; i < 2; ++i) {
    path.at[i] = (*centre)[i] * view.scale * z;
    path.step[i] = ((*up)[i] * view.scale * z_up - path.at[i]) / unit;
  }
  path.at[2] = z;
  path.step[2] = (z_up - z) / unit;
  for (std::size_t i = 0; i < 2; ++i) {
    path.tangent[i] = float(((*along_a)[i] - (*centre)[i]) * view.scale / unit);
    path.tangent[2 + i] = float(((*along_b)[i] - (*centre)[i]) * view.scale / unit);
  }
  return path;
}

}  // namespace slf
