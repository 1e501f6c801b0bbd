// SPDX-License-Identifier: Apache-2.0
#include "encoder/measure/changed_pixels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

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
Plane channel_difference(const Image& before, const Image& after, int channel) {
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

}  // namespace

std::vector<std::uint8_t> changed_pixels(const Image& before, const Image& after) {
  std::vector<std::uint8_t> changed(std::size_t(after.width) * std::size_t(after.height));
  for (int channel = 0; channel < 3; ++channel) {
    const Plane signed_ = channel_difference(before, after, channel);
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

}  // namespace slf
