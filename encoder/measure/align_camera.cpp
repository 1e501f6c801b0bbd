// SPDX-License-Identifier: Apache-2.0
#include "encoder/measure/align_camera.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "base/error_sum.h"

namespace slf {
namespace {

constexpr double kLeastSlope = 2;  // grey levels a pixel: flatter ones say nothing
constexpr std::size_t kLeastPixels = 64;
constexpr double kEnoughPixels = 1 << 19;  // of 12 megapixels all slopes take 700 MB
constexpr double kLarge = 8;               // grey levels: larger differences are something else
constexpr int kRounds = 5;                 // of weights
constexpr double kMostPixels = 4;

using Row = Eigen::Vector4d;  // by shifts along x and y, a turn and a scale about the middle

struct Slopes {
  std::vector<Row> rows;
  std::vector<double> differences;
  std::vector<std::array<double, 2>> places;  ///< from the middle
};

/// What a change of the picture means for each pixel inside what is drawn.
Slopes slopes_of(const Image& photograph, const Image& drawn,
                 const std::vector<std::uint8_t>& coverage) {
  Slopes out;
  const auto width = std::size_t(drawn.width), height = std::size_t(drawn.height);
  const auto grey = [](const Image& image, std::size_t i) { return luma(&image.data[3 * i]); };
  const auto step = std::size_t(
      std::max(1.0, std::ceil(std::sqrt(double(width) * double(height) / kEnoughPixels))));
  for (std::size_t y = 1; y + 1 < height; y += step)
    for (std::size_t x = 1; x + 1 < width; x += step) {
      const std::size_t i = y * width + x;
      if (coverage[i] < 128) continue;
      const double gx = (grey(drawn, i + 1) - grey(drawn, i - 1)) / 2;
      const double gy = (grey(drawn, i + width) - grey(drawn, i - width)) / 2;
      if (std::abs(gx) + std::abs(gy) < kLeastSlope) continue;
      const double dx = double(x) + 0.5 - double(width) / 2;
      const double dy = double(y) + 0.5 - double(height) / 2;
      out.rows.push_back({gx, gy, dx * gy - dy * gx, dx * gx + dy * gy});
      out.differences.push_back(grey(photograph, i) - grey(drawn, i));
      out.places.push_back({dx, dy});
    }
  return out;
}

Row solved(const Slopes& slopes) {
  Row x = Row::Zero();
  for (int round = 0; round < kRounds; ++round) {
    Eigen::Matrix4d products = Eigen::Matrix4d::Zero();
    Row right = Row::Zero();
    for (std::size_t i = 0; i < slopes.rows.size(); ++i) {
      const Row& row = slopes.rows[i];
      const double left = round == 0 ? 0 : std::abs(slopes.differences[i] - row.dot(x));
      const double weight = 1 / std::max(1.0, left / kLarge);
      products += weight * row * row.transpose();
      right += weight * slopes.differences[i] * row;
    }
    products.diagonal().array() *= 1 + 1e-9;
    x = products.ldlt().solve(right);
    if (!x.allFinite()) return Row::Zero();
  }
  return x;
}

}  // namespace

Alignment aligned(const Camera& camera, const Image& photograph, const Image& drawn,
                  const std::vector<std::uint8_t>& coverage) {
  const Slopes slopes = slopes_of(photograph, drawn, coverage);
  if (slopes.rows.size() < kLeastPixels) return {camera, 0};
  const Row x = solved(slopes);
  double squares = 0;
  for (const auto& [dx, dy] : slopes.places)
    squares +=
        std::pow(x[0] - x[2] * dy + x[3] * dx, 2) + std::pow(x[1] + x[2] * dx + x[3] * dy, 2);
  const double pixels = std::sqrt(squares / double(slopes.places.size()));
  if (pixels > kMostPixels) return {camera, 0};
  // The photograph shows at `at` what the drawing has at at + x: the camera's picture moves by -x.
  Camera out = camera;
  const double cosine = std::cos(x[2]), sine = std::sin(x[2]);  // turned by -x[2]
  const double px = camera.cx - camera.width / 2.0, py = camera.cy - camera.height / 2.0;
  out.cx = (cosine * px + sine * py) / (1 + x[3]) + camera.width / 2.0 - x[0];
  out.cy = (cosine * py - sine * px) / (1 + x[3]) + camera.height / 2.0 - x[1];
  out.fx /= 1 + x[3], out.fy /= 1 + x[3];
  for (std::size_t k = 0; k < 3; ++k) {
    const double first = camera.rotation[0][k], second = camera.rotation[1][k];
    out.rotation[0][k] = cosine * first + sine * second;
    out.rotation[1][k] = cosine * second - sine * first;
  }
  out.translation[0] = cosine * camera.translation[0] + sine * camera.translation[1];
  out.translation[1] = cosine * camera.translation[1] - sine * camera.translation[0];
  return {out, pixels};
}

}  // namespace slf
