// SPDX-License-Identifier: Apache-2.0
#include "tools/synth/trace.h"

#include "tools/synth/shading.h"

namespace slf::synth {
namespace {

constexpr std::uint8_t kBackground = 128;

/// Linear light to 8-bit display value by table: 2^14 steps are within 0.1 grey level everywhere.
class DisplayTable {
 public:
  DisplayTable() {
    for (std::size_t i = 0; i < table_.size(); ++i)
      table_[i] = static_cast<std::uint8_t>(
          std::lround(255 * srgb_from_linear(static_cast<double>(i) / (kSteps - 1))));
  }
  std::uint8_t operator()(double linear) const {
    return table_[static_cast<std::size_t>(std::clamp(linear, 0.0, 1.0) * (kSteps - 1) + 0.5)];
  }

 private:
  static constexpr std::size_t kSteps = 1 << 14;
  std::vector<std::uint8_t> table_ = std::vector<std::uint8_t>(kSteps);
};

class Tracer {
 public:
  Tracer(const Subject& subject, const Camera& camera, int supersampling)
      : subject_(subject), camera_(camera), grid_(supersampling), centre_(camera.centre()) {}

  /// Mean of the pixel's samples; false where it shows nothing but background.
  bool pixel(int x, int y, Colour& mean) const {
    // The ball around the scene, widened by a pixel's diagonal, tells most of the background.
    const Vec3 middle = ray_direction(x + 0.5, y + 0.5);
    const double along = -dot(centre_, middle);
    const double miss = dot(centre_, centre_) - along * along;
    const double reach = subject_.radius() + along / std::min(camera_.fx, camera_.fy);
    if (miss > reach * reach) return false;
    Colour sum{0, 0, 0};
    bool any = false;
    for (int sy = 0; sy < grid_; ++sy)
      for (int sx = 0; sx < grid_; ++sx) {
        const Ray ray{centre_, ray_direction(x + (sx + 0.5) / grid_, y + (sy + 0.5) / grid_)};
        Colour light{0, 0, 0};
        double transmittance = 1;
        any |= subject_.radiance(ray, light, transmittance);
        for (std::size_t k = 0; k < 3; ++k)  // display white is where a photograph clips
          sum[k] += std::min(1.0, light[k] + transmittance * background_);
      }
    mean = (1.0 / (grid_ * grid_)) * sum;
    return any;
  }

 private:
  Vec3 ray_direction(double u, double v) const {
    const double x = (u - camera_.cx) / camera_.fx, y = (v - camera_.cy) / camera_.fy;
    const auto& r = camera_.rotation;
    return normalised({x * r[0][0] + y * r[1][0] + r[2][0], x * r[0][1] + y * r[1][1] + r[2][1],
                       x * r[0][2] + y * r[1][2] + r[2][2]});
  }

  const Subject& subject_;
  const Camera& camera_;
  int grid_;
  Vec3 centre_;
  double background_ = linear_from_srgb(kBackground / 255.0);
};

}  // namespace

Image trace_image(const Subject& subject, const Camera& camera, int supersampling) {
  static const DisplayTable to_display;
  const Tracer tracer(subject, camera, supersampling);
  Image image;
  image.width = camera.width;
  image.height = camera.height;
  image.data.assign(std::size_t(image.width) * std::size_t(image.height) * 3, kBackground);
  std::uint8_t* out = image.data.data();
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x, out += 3) {
      Colour mean;
      if (!tracer.pixel(x, y, mean)) continue;
      for (std::size_t k = 0; k < 3; ++k) out[k] = to_display(mean[k]);
    }
  return image;
}

}  // namespace slf::synth
