// SPDX-License-Identifier: Apache-2.0
#include "attributes/texture/encoder/padding.h"

#include <algorithm>

namespace slf {
namespace {

constexpr int kFraction = 8;  // bits of a value below a sample

struct Layer {
  int width = 0, height = 0;
  std::vector<std::int32_t> value;
  std::vector<std::uint8_t> known;

  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }
};

/// Half the size; a value is the mean of the known ones of 2 x 2.
Layer halved(const Layer& fine) {
  Layer coarse{(fine.width + 1) / 2, (fine.height + 1) / 2, {}, {}};
  for (int y = 0; y < coarse.height; ++y)
    for (int x = 0; x < coarse.width; ++x) {
      std::int32_t sum = 0, count = 0;
      for (int fy = 2 * y; fy < std::min(2 * y + 2, fine.height); ++fy)
        for (int fx = 2 * x; fx < std::min(2 * x + 2, fine.width); ++fx)
          if (fine.known[fine.at(fx, fy)]) {
            sum += fine.value[fine.at(fx, fy)];
            ++count;
          }
      coarse.value.push_back(count > 0 ? (sum + count / 2) / count : 0);
      coarse.known.push_back(count > 0);
    }
  return coarse;
}

/// The unknown of `fine` from `coarse`, where all is known: bilinear, weights 9 3 3 1.
void fill(Layer& fine, const Layer& coarse) {
  const auto beside = [](int i, int size) {
    return std::clamp(i / 2 + (i % 2 == 1 ? 1 : -1), 0, size - 1);
  };
  for (int y = 0; y < fine.height; ++y)
    for (int x = 0; x < fine.width; ++x) {
      if (fine.known[fine.at(x, y)]) continue;
      const int bx = beside(x, coarse.width), by = beside(y, coarse.height);
      fine.value[fine.at(x, y)] =
          (9 * coarse.value[coarse.at(x / 2, y / 2)] + 3 * coarse.value[coarse.at(bx, y / 2)] +
           3 * coarse.value[coarse.at(x / 2, by)] + coarse.value[coarse.at(bx, by)] + 8) /
          16;
    }
}

}  // namespace

void pad_picture(std::vector<std::uint16_t>& samples, std::span<const std::uint8_t> occupied,
                 int width, int height) {
  std::vector<Layer> layers(1);
  layers[0] = {width, height, {}, {occupied.begin(), occupied.end()}};
  for (const std::uint16_t sample : samples) layers[0].value.push_back(sample << kFraction);
  while (std::max(layers.back().width, layers.back().height) > 1)
    layers.push_back(halved(layers.back()));
  for (std::size_t i = layers.size() - 1; i-- > 0;) fill(layers[i], layers[i + 1]);
  for (std::size_t i = 0; i < samples.size(); ++i)
    samples[i] =
        static_cast<std::uint16_t>((layers[0].value[i] + (1 << (kFraction - 1))) >> kFraction);
}

}  // namespace slf
