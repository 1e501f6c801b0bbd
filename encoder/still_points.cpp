// SPDX-License-Identifier: Apache-2.0
#include "encoder/still_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "geometry/morton.h"
#include "slf/parallel.h"

namespace slf {
namespace {

constexpr int kReachPixels = 2;  // pixels to each side of what is averaged
constexpr float kWindow = (2 * kReachPixels + 1) * (2 * kReachPixels + 1);
constexpr float kLeast = 1;      // grey level: less is no change, without any noise
constexpr float kMostNoise = 8;  // standard deviation: more is no noise
// Standard errors of a mean of noise that are no change: 1 pixel of 16,000 by chance.
constexpr float kErrors = 4;
// For normal noise: mean magnitude and its deviation, standard deviation of a median magnitude.
constexpr float kMeanMagnitude = 0.798f, kOfMagnitude = 0.603f, kOfMedian = 1.4826f;

/// A plane of values, and means over windows of it, which are smaller at the border.
struct Plane {
  int width, height;
  std::vector<float> values;

  Plane(int w, int h) : width(w), height(h), values(std::size_t(w) * std::size_t(h)) {}

  Plane means() const {
    Plane rows(width, height), out(width, height);
    average(values.data(), rows.values.data(), width, 1, height, width);
    average(rows.values.data(), out.values.data(), height, width, width, 1);
    return out;
  }

 private:
  /// Along lines of `length` values, `step` apart; the lines are `next` apart.
  static void average(const float* from, float* to, int length, int step, int lines, int next) {
    for (int line = 0; line < lines; ++line, from += next, to += next)
      for (int i = 0; i < length; ++i) {
        const int low = std::max(0, i - kReachPixels),
                  high = std::min(length - 1, i + kReachPixels);
        float sum = 0;
        for (int j = low; j <= high; ++j) sum += from[std::ptrdiff_t{j} * step];
        to[std::ptrdiff_t{i} * step] = sum / float(high - low + 1);
      }
  }
};

/// What differs in a channel of two photographs; nothing where both are clear.
Plane difference(const Image& before, const Image& after, int channel) {
  Plane out(after.width, after.height);
  const auto clear = [](const Image& image, std::size_t pixel) {
    return image.channels == 4 && image.data[4 * pixel + 3] == 0;
  };
  const auto value = [&](const Image& image, std::size_t pixel) {
    return image.data[pixel * std::size_t(image.channels) + std::size_t(channel)];
  };
  for (std::size_t p = 0; p < out.values.size(); ++p) {
    const bool shown = !clear(before, p), shows = !clear(after, p);
    if (shown && shows) out.values[p] = float(value(after, p)) - float(value(before, p));
    if (shown != shows) out.values[p] = 255;
  }
  return out;
}

/// Standard deviation of a difference without its local means.
float noise_of(const Plane& difference, const Plane& means) {
  std::array<std::size_t, 2048> counts{};  // of eighths
  for (std::size_t p = 0; p < difference.values.size(); ++p)
    ++counts[std::size_t(std::min(8 * std::abs(difference.values[p] - means.values[p]), 2047.0f))];
  std::size_t seen = 0, median = 0;
  while (2 * (seen += counts[median]) < difference.values.size()) ++median;
  const float middle = median == 0 ? 0 : (float(median) + 0.5f) / 8;
  return std::min(kOfMedian * middle * std::sqrt(kWindow / (kWindow - 1)), kMostNoise);
}

bool same_view(const Camera& a, const Camera& b) {
  return a.width == b.width && a.height == b.height && a.fx == b.fx && a.fy == b.fy &&
         a.cx == b.cx && a.cy == b.cy && a.distortion == b.distortion && a.rotation == b.rotation &&
         a.translation == b.translation;
}

}  // namespace

std::vector<std::uint8_t> changed_pixels(const Image& before, const Image& after) {
  std::vector<std::uint8_t> changed(std::size_t(after.width) * std::size_t(after.height));
  for (int channel = 0; channel < 3; ++channel) {
    const Plane signed_ = difference(before, after, channel);
    Plane magnitude = signed_;
    for (float& value : magnitude.values) value = std::abs(value);
    const Plane mean = signed_.means(), mean_magnitude = magnitude.means();
    const float noise = noise_of(signed_, mean), root = std::sqrt(kWindow);
    const float most = kLeast + kErrors * noise / root,
                most_magnitude = kLeast + (kMeanMagnitude + kErrors * kOfMagnitude / root) * noise;
    for (std::size_t p = 0; p < changed.size(); ++p)
      changed[p] |= std::abs(mean.values[p]) > most || mean_magnitude.values[p] > most_magnitude;
  }
  return changed;
}

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
