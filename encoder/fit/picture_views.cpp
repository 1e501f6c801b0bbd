// SPDX-License-Identifier: Apache-2.0
#include "encoder/fit/picture_views.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/release.h"
#include "capture/object_mask.h"
#include "capture/photograph_size.h"
#include "encoder/fit/observe_camera.h"
#include "lightfield/render/splat_weights.h"
#include "slf/parallel.h"

namespace slf {
namespace {

constexpr float kCovered = 0.99f;  // a pixel of less is part background, which no point can explain
constexpr double kSlanted = 0.2;   // cosine of a surface that is seen along itself
constexpr std::uint8_t kClipped = 250;  // such a sample may have been any brighter
constexpr std::array<float, 3> kNoGain{1, 1, 1};
constexpr double kMemory = 3.0 * (1u << 30), kMemoryOfPart = 0.75 * (1u << 30);
constexpr double kBytesPerPixel = 20 + 8 * 10;  // some ten discs a pixel
constexpr int kMostHalved = 2;
constexpr double kBytesPerRay = 6 * 16 + 24;  // vectors of the solver, directions
constexpr std::uint32_t kUnseen = ~std::uint32_t{0};
constexpr double kSeen = 0.5;  // share of the points that a camera sees, at most

/// Pixels of the rectangle about all points in a picture.
double pixels_about(const Camera& camera, const SurfelCloud& cloud) {
  constexpr std::size_t kEvery = 16;
  double left = camera.width, right = 0, top = camera.height, bottom = 0;
  for (std::size_t p = 0; p < cloud.size(); p += kEvery) {
    const auto at = camera.project(cloud.centres[p]);
    if (!at) continue;
    left = std::min(left, std::max((*at)[0], 0.0));
    right = std::max(right, std::min((*at)[0], double(camera.width)));
    top = std::min(top, std::max((*at)[1], 0.0));
    bottom = std::max(bottom, std::min((*at)[1], double(camera.height)));
  }
  return std::max(right - left, 0.0) * std::max(bottom - top, 0.0);
}

/// What fits into memory.
struct Held {
  int halved = 0;          ///< how often photographs are
  std::size_t stride = 1;  ///< every so many-th camera is there
};

/// Photographs are halved before cameras are left out: views of all sides tell more of a point than
/// its finest detail. Those of a part of a scene are as small as points need already.
Held held_in_memory(const Capture& capture, std::span<const int> cameras, const SurfelCloud& cloud,
                    bool part) {
  double of_pixels = 0, of_rays = 0;
  for (const int c : cameras) {
    const Camera& camera = capture.cameras[static_cast<std::size_t>(c)];
    const double all = double{1} * camera.width * camera.height;
    const double pixels = pixels_about(camera, cloud);
    of_pixels += kBytesPerPixel * pixels;
    of_rays += kBytesPerRay * kSeen * (part ? pixels / all : 1) * static_cast<double>(cloud.size());
  }
  const double memory = part ? kMemoryOfPart : kMemory;
  Held held;
  for (; !part && held.halved < kMostHalved && of_pixels + of_rays > memory; ++held.halved)
    of_pixels /= 4;
  held.stride = static_cast<std::size_t>(std::max(1.0, std::ceil((of_pixels + of_rays) / memory)));
  return held;
}

/// [pixels] is what a picture shows there hidden by something that is not in it?
Result<std::vector<bool>, InputError> hidden_pixels(const SplatWeights& splatted,
                                                    const Camera& camera, int camera_index,
                                                    const DepthOfCamera& hidden_by) {
  std::vector<bool> hidden(splatted.coverage.size(), false);
  if (!hidden_by) return hidden;
  SLF_TRY(const DepthBuffer depth, hidden_by(camera_index));
  for (std::size_t i = 0; i < hidden.size(); ++i) {
    if (splatted.coverage[i] < kCovered) continue;
    const std::size_t width = static_cast<std::size_t>(camera.width);
    const std::size_t row = i / width;
    const std::array<double, 2> at = {static_cast<double>(i % width) + 0.5,
                                      static_cast<double>(row) + 0.5};
    hidden[i] = depth.hides(at, double{splatted.depth[i]}, kSlanted);
  }
  return hidden;
}

/// @param local     [contributions] point of each
/// @param local_of  index of a point into view.points
void finish_view(std::vector<std::uint32_t>& local, const std::vector<std::uint32_t>& local_of,
                 PictureView& view) {
  for (std::uint32_t& p : local) p = local_of[p];
  view.set_local(local);
  view.weight.shrink_to_fit();
  view.first.shrink_to_fit();
  view.samples.shrink_to_fit();
  view.points.shrink_to_fit();
  view.trust.assign(view.pixels(), 1.0f);
}

Result<PictureView, InputError> picture_view(const Capture& capture, int camera_index,
                                             const std::array<float, 3>& gain,
                                             const SurfelCloud& cloud,
                                             const std::array<float, 256>& transfer,
                                             const DepthOfCamera& hidden_by) {
  const Camera& camera = capture.cameras[static_cast<std::size_t>(camera_index)];
  SLF_TRY(const Image image, load_image(capture, camera_index));
  const SplatWeights splatted =
      splat_weights(project_surfels(cloud, camera, 1), camera.width, camera.height, 1);
  SLF_TRY(const auto hidden, hidden_pixels(splatted, camera, camera_index, hidden_by));
  PictureView view;
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < 256; ++i) view.level[c][i] = gain[c] * transfer[i];
  view.first.push_back(0);
  std::vector<std::uint32_t> local, local_of(cloud.size(), kUnseen);
  const auto channels = static_cast<std::size_t>(image.channels);
  for (std::size_t i = 0; i < splatted.coverage.size(); ++i) {
    const std::uint8_t* sample = &image.data[channels * i];
    if (splatted.coverage[i] < kCovered || (channels == 4 && !shows_object(sample[3]))) continue;
    if (hidden[i]) continue;
    if (gain != kNoGain && *std::max_element(sample, sample + 3) >= kClipped) continue;
    for (auto j = splatted.first[i]; j < splatted.first[i + 1]; ++j) {
      local.push_back(splatted.point[j]);
      view.weight.push_back(splatted.weight[j]);
      local_of[splatted.point[j]] = 0;
    }
    view.first.push_back(static_cast<std::uint32_t>(local.size()));
    view.samples.push_back({sample[0], sample[1], sample[2]});
  }
  for (std::uint32_t p = 0; p < local_of.size(); ++p) {
    if (local_of[p] == kUnseen) continue;
    local_of[p] = static_cast<std::uint32_t>(view.points.size());
    view.points.push_back(p);
  }
  finish_view(local, local_of, view);
  return view;
}

/// The pixels of a view that show nothing but points that have a place.
PictureView view_of_points(const PictureView& from, const std::vector<std::uint32_t>& place) {
  PictureView view;
  view.level = from.level;
  view.first.push_back(0);
  std::vector<std::uint32_t> local, shown, local_of(from.points.size(), kUnseen);
  for (std::size_t i = 0; i < from.pixels(); ++i) {
    shown.clear();
    for (auto j = from.first[i]; j < from.first[i + 1]; ++j) shown.push_back(from.local(j));
    if (std::any_of(shown.begin(), shown.end(),
                    [&](std::uint32_t l) { return place[from.points[l]] == kUnseen; }))
      continue;
    for (const std::uint32_t l : shown) local_of[l] = 0;
    local.insert(local.end(), shown.begin(), shown.end());
    view.weight.insert(view.weight.end(), from.weight.begin() + from.first[i],
                       from.weight.begin() + from.first[i + 1]);
    view.first.push_back(static_cast<std::uint32_t>(local.size()));
    view.samples.push_back(from.samples[i]);
  }
  for (std::size_t l = 0; l < local_of.size(); ++l) {
    if (local_of[l] == kUnseen) continue;
    local_of[l] = static_cast<std::uint32_t>(view.points.size());
    view.points.push_back(place[from.points[l]]);
  }
  finish_view(local, local_of, view);
  return view;
}

/// Rays by point, cameras ascending within a point; tells the views.
Rays connect(std::vector<PictureView>& views, std::size_t points) {
  Rays rays;
  rays.first.assign(points + 1, 0);
  for (const PictureView& view : views)
    for (const std::uint32_t p : view.points) ++rays.first[p + 1];
  for (std::size_t p = 0; p < points; ++p) rays.first[p + 1] += rays.first[p];
  rays.view.resize(static_cast<std::size_t>(rays.first[points]));
  std::vector<std::uint64_t> next(rays.first.begin(), rays.first.end() - 1);
  for (std::size_t v = 0; v < views.size(); ++v)
    for (const std::uint32_t p : views[v].points) {  // rays: far fewer than 2^32, by kMemory
      rays.view[static_cast<std::size_t>(next[p])] = static_cast<std::uint32_t>(v);
      views[v].ray.push_back(static_cast<std::uint32_t>(next[p]++));
    }
  return rays;
}

}  // namespace

void PictureView::set_local(std::span<const std::uint32_t> local) {
  local_low.assign(local.begin(), local.end());
  local_high.clear();
  if (points.size() <= std::size_t{1} << 16) return;
  local_high.reserve(local.size());
  for (const std::uint32_t l : local) local_high.push_back(static_cast<std::uint16_t>(l >> 16));
}

Result<PictureViews, InputError> picture_views(const Capture& whole, std::span<const int> cameras,
                                               std::span<const std::array<float, 3>> gains,
                                               const SurfelCloud& cloud, Transfer transfer,
                                               const DepthOfCamera& hidden_by, int threads,
                                               const Progress& progress) {
  PictureViews pictures;
  pictures.views.resize(cameras.size());
  std::vector<std::optional<InputError>> failures(cameras.size());
  const auto table = transfer_table(transfer);
  const Held held = held_in_memory(whole, cameras, cloud, hidden_by != nullptr);
  std::optional<Capture> smaller;
  if (held.halved > 0)
    smaller = smaller_photographs(photographs_alone(whole),
                                  std::vector<int>(whole.cameras.size(), held.halved));
  const Capture& capture = smaller ? *smaller : whole;
  parallel_ranges(
      cameras.size(), 1, threads,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) {
          if (v % held.stride != 0) continue;
          auto view = picture_view(capture, cameras[v], gains.empty() ? kNoGain : gains[v], cloud,
                                   table, hidden_by);
          if (view) {
            pictures.views[v] = std::move(*view);
          } else {
            failures[v] = view.error();
          }
        }
      },
      [&](std::size_t done) {
        if (progress) progress("pictures", double(done) / double(cameras.size()));
      });
  for (const auto& failure : failures)
    if (failure) return *failure;
  for (PictureView& view : pictures.views)
    if (view.first.empty()) view.first.push_back(0);
  pictures.rays = connect(pictures.views, cloud.size());
  trim_heap();
  return pictures;
}

PictureViews views_of_points(const PictureViews& of, std::span<const std::uint32_t> points,
                             std::size_t count, const std::vector<bool>& wanted) {
  std::vector<std::uint32_t> place(count, kUnseen);
  for (std::size_t i = 0; i < points.size(); ++i) place[points[i]] = static_cast<std::uint32_t>(i);
  PictureViews part;
  part.views.resize(of.views.size());
  for (std::size_t v = 0; v < of.views.size(); ++v) {
    part.views[v].first.push_back(0);
    if (wanted[v]) part.views[v] = view_of_points(of.views[v], place);
  }
  part.rays = connect(part.views, points.size());
  return part;
}

}  // namespace slf
