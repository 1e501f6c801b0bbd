#include "fit/environment.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "lightfield/harmonics.h"
#include "slf/parallel.h"

namespace slf {
namespace {

// A harmonic of degree 16 has 32 of these columns to a wave.
constexpr int kRows = 256, kColumns = 512;

}  // namespace

ObjectBox::ObjectBox(std::span<const Voxel> positions) {
  double longest = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    auto low = positions.front()[a], high = low;
    for (const Voxel& v : positions) {
      low = std::min(low, v[a]);
      high = std::max(high, v[a]);
    }
    centre_[a] = 0.5 * (static_cast<double>(low) + static_cast<double>(high));
    longest = std::max(longest, static_cast<double>(high) - static_cast<double>(low));
  }
  half_ = longest > 0 ? longest / 2 : 1;
}

Vec3 ObjectBox::operator()(const Voxel& voxel) const {
  Vec3 at{};
  for (std::size_t a = 0; a < 3; ++a) at[a] = (static_cast<double>(voxel[a]) - centre_[a]) / half_;
  return at;
}

Vec3 place_on_sphere(const Vec3& position, const Vec3& direction, double radius) {
  double along = 0, squared = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    along += position[a] * direction[a];
    squared += position[a] * position[a];
  }
  const double distance =
      -along + std::sqrt(std::max(0.0, along * along + radius * radius - squared));
  Vec3 place{};
  for (std::size_t a = 0; a < 3; ++a) place[a] = (position[a] + distance * direction[a]) / radius;
  return place;
}

Environment::Environment(double radius, int degree, std::span<const float> light, int threads)
    : radius_(radius), table_(std::size_t{kRows + 1} * (kColumns + 1)) {
  const Harmonics harmonics(degree);
  const std::size_t functions = light.size() / 3;
  parallel_ranges(kRows + 1, 1, threads, [&](std::size_t begin, std::size_t end) {
    std::vector<double> values(functions);
    for (std::size_t row = begin; row < end; ++row)
      for (std::size_t column = 0; column <= kColumns; ++column) {
        const double polar = std::numbers::pi * static_cast<double>(row) / kRows;
        const double azimuth = 2 * std::numbers::pi * static_cast<double>(column) / kColumns;
        harmonics.evaluate({std::sin(polar) * std::cos(azimuth),
                            std::sin(polar) * std::sin(azimuth), std::cos(polar)},
                           values.data());
        std::array<double, 3> sum{0, 0, 0};
        for (std::size_t k = 1; k < functions; ++k)
          for (std::size_t c = 0; c < 3; ++c)
            sum[c] += values[k] * static_cast<double>(light[3 * k + c]);
        for (std::size_t c = 0; c < 3; ++c)
          table_[row * (kColumns + 1) + column][c] = static_cast<float>(sum[c]);
      }
  });
}

std::array<float, 3> Environment::operator()(const Vec3& position, const Vec3& reflected) const {
  const Vec3 place = place_on_sphere(position, reflected, radius_);
  const double row = std::acos(std::clamp(place[2], -1.0, 1.0)) / std::numbers::pi * kRows;
  double turn = std::atan2(place[1], place[0]) / (2 * std::numbers::pi);
  turn -= std::floor(turn);
  const double column = turn * kColumns;
  const auto y = std::min(static_cast<std::size_t>(row), std::size_t{kRows - 1});
  const auto x = std::min(static_cast<std::size_t>(column), std::size_t{kColumns - 1});
  const auto wy = static_cast<float>(row - static_cast<double>(y)),
             wx = static_cast<float>(column - static_cast<double>(x));
  const auto* above = &table_[y * (kColumns + 1) + x];
  const auto* below = above + kColumns + 1;
  std::array<float, 3> light{};
  for (std::size_t c = 0; c < 3; ++c)
    light[c] = (1 - wy) * ((1 - wx) * above[0][c] + wx * above[1][c]) +
               wy * ((1 - wx) * below[0][c] + wx * below[1][c]);
  return light;
}

}  // namespace slf
