// SPDX-License-Identifier: Apache-2.0
#include "encoder/still_points.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "encoder/measure/changed_pixels.h"
#include "geometry/morton.h"
#include "slf/parallel.h"

namespace slf {
namespace {

bool same_view(const Camera& a, const Camera& b) {
  return a.width == b.width && a.height == b.height && a.fx == b.fx && a.fy == b.fy &&
         a.cx == b.cx && a.cy == b.cy && a.distortion == b.distortion && a.rotation == b.rotation &&
         a.translation == b.translation;
}

}  // namespace

Result<Done, InputError> StillPoints::see(View& view, const Camera& camera, Image image) {
  const bool comparable = same_view(view.camera, camera) && view.image.channels == image.channels &&
                          view.image.data.size() == image.data.size();
  view.camera = camera;
  if (!comparable) {
    view.changed.assign(std::size_t(image.width) * std::size_t(image.height), 1);
    view.image = std::move(image);
    return Done{};
  }
  view.changed = changed_pixels(view.image, image);
  const auto channels = static_cast<std::ptrdiff_t>(image.channels);
  for (std::size_t p = 0; p < view.changed.size(); ++p)
    if (view.changed[p]) {
      const auto at = static_cast<std::ptrdiff_t>(p) * channels;
      std::copy_n(image.data.begin() + at, channels, view.image.data.begin() + at);
    }
  return Done{};
}

Result<Done, InputError> StillPoints::see(const LoadedFrame& frame, int threads) {
  const Capture& capture = frame.capture;
  std::vector<View*> views;
  for (const int c : frame.cameras) views.push_back(&views_[capture.cameras[std::size_t(c)].name]);
  std::vector<Result<Done, InputError>> seen(views.size(), Done{});
  parallel_ranges(views.size(), 1, threads, [&](std::size_t begin, std::size_t) {
    const int c = frame.cameras[begin];
    auto image = load_image(capture, c);
    seen[begin] = image ? see(*views[begin], moved(capture.cameras[std::size_t(c)], capture.origin),
                              *std::move(image))
                        : Result<Done, InputError>(image.error());
  });
  for (const auto& each : seen) SLF_CHECK(each);
  return Done{};
}

bool StillPoints::changed_at(const Vec3& world) const {
  for (const auto& [name, view] : views_) {
    const auto at = view.camera.project(world);
    if (!at) continue;
    const auto x = std::floor((*at)[0]), y = std::floor((*at)[1]);
    if (!(x >= 0 && y >= 0 && x < view.camera.width && y < view.camera.height)) continue;
    if (view.changed[std::size_t(y) * std::size_t(view.camera.width) + std::size_t(x)]) return true;
  }
  return false;
}

std::size_t StillPoints::hold(const LoadedFrame& frame, LightField& field, int threads) {
  const Grid& grid = field.header.grid;
  const std::size_t planes = std::size_t(field.num_planes());
  std::vector<std::uint8_t> held(field.positions.size());
  const auto before = [](const Voxel& a, const Voxel& b) { return morton(a) < morton(b); };
  if (!frame.cameras.empty() && components_.size() == positions_.size() * planes)
    parallel_ranges(held.size(), 1024, threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t p = begin; p < end; ++p) {
        const Voxel& voxel = field.positions[p];
        const auto old = std::lower_bound(positions_.begin(), positions_.end(), voxel, before);
        if (old == positions_.end() || *old != voxel) continue;
        Vec3 world;
        for (std::size_t k = 0; k < 3; ++k) world[k] = grid.origin[k] + grid.step * voxel[k];
        if (changed_at(world)) continue;
        const auto row = std::size_t(old - positions_.begin()) * planes;
        std::copy_n(components_.begin() + std::ptrdiff_t(row), planes,
                    field.components.begin() + std::ptrdiff_t(p * planes));
        held[p] = 1;
      }
    });
  positions_ = field.positions;
  components_ = field.components;
  return std::size_t(std::count(held.begin(), held.end(), 1));
}

}  // namespace slf
