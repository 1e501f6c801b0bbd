#include "slf/view_map.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "lightfield/frame.h"
#include "lightfield/harmonics.h"
#include "lightfield/nodes.h"
#include "slf/parallel.h"

namespace slf {
namespace {

constexpr std::size_t kPointsPerRange = 512;

/// Component planes to R, G, B coefficients: one 3 x 3 matrix per function, 2^-shift folded in.
class Dequantiser {
 public:
  explicit Dequantiser(const LightFieldHeader& header) {
    const auto matrix = colour_matrix(header.colour);
    for (std::size_t k = 0; k < static_cast<std::size_t>(header.num_functions); ++k) {
      const int shift = k < header.shift.size() ? header.shift[k] : 0;
      for (const auto& row : matrix)
        for (const double m : row) factors_.push_back(static_cast<float>(std::ldexp(m, -shift)));
    }
  }

  /// [K][3] integers to [K][3] R, G, B.
  void apply(const std::int32_t* components, float* rgb) const {
    for (const float *m = factors_.data(), *end = m + factors_.size(); m != end; m += 9) {
      if ((components[0] | components[1] | components[2]) != 0) {
        const auto c0 = static_cast<float>(components[0]);
        const auto c1 = static_cast<float>(components[1]);
        const auto c2 = static_cast<float>(components[2]);
        for (int c = 0; c < 3; ++c) rgb[c] = m[3 * c] * c0 + m[3 * c + 1] * c1 + m[3 * c + 2] * c2;
      } else {
        rgb[0] = rgb[1] = rgb[2] = 0;
      }
      components += 3;
      rgb += 3;
    }
  }

 private:
  std::vector<float> factors_;  // [K][3][3]
};

std::array<float, 3> clamp_to_display(std::array<float, 3> rgb) {
  for (float& c : rgb) c = std::clamp(c, 0.0f, 255.0f);
  return rgb;
}

}  // namespace

ViewMaps::ViewMaps(const LightField& light_field, int threads)
    : header_(light_field.header),
      positions_(light_field.positions),
      normals_(light_field.normals),
      frame_normals_(frame_normals(header_.frame, positions_, threads)) {
  if (header_.basis.id == BasisId::kHarmonics)
    harmonics_ = std::make_shared<const Harmonics>(header_.basis.degree);
  assert(header_.has_basis && header_.num_functions == header_.basis.num_functions());
  const bool spline = header_.basis.id == BasisId::kBspline;
  const NodeMap<float> map(spline ? header_.basis : Basis{BasisId::kBspline, 2, 0, 0});
  const Dequantiser dequantiser(header_);
  const std::size_t size = 3 * static_cast<std::size_t>(header_.num_functions);
  assert(light_field.components.size() == num_points() * size);
  nodes_.resize(num_points() * size);
  mean_.resize(num_points());
  parallel_ranges(num_points(), kPointsPerRange, threads, [&](std::size_t begin, std::size_t end) {
    std::vector<float> coefficients(size), scratch(size);
    for (std::size_t p = begin; p < end; ++p) {
      dequantiser.apply(light_field.components.data() + p * size, coefficients.data());
      if (spline) {
        map.to_nodes(coefficients.data(), nodes_.data() + p * size, scratch.data());
      } else {
        std::copy(coefficients.begin(), coefficients.end(), nodes_.data() + p * size);
      }
      // Every other function has zero mean over the sphere.
      mean_[p] = clamp_to_display({coefficients[0], coefficients[1], coefficients[2]});
    }
  });
}

std::array<float, 3> ViewMaps::radiance(std::size_t p, float theta, float gamma) const {
  const float low = static_cast<float>(header_.gamma_min_q7) / 127.0f;
  const float high = static_cast<float>(header_.gamma_max_q7) / 127.0f;
  auto direction = to_frame(frame_normals_, p, {theta, gamma});
  direction[1] = std::min(std::max(direction[1], low), high);
  return clamp_to_display(sum_of_functions(p, direction));
}

std::array<float, 3> ViewMaps::radiance_unclamped(std::size_t p, float theta, float gamma) const {
  return sum_of_functions(p, to_frame(frame_normals_, p, {theta, gamma}));
}

std::array<float, 3> ViewMaps::sum_of_functions(std::size_t p,
                                                const std::array<float, 2>& direction) const {
  std::array<float, 3> rgb{0, 0, 0};
  const float* nodes = nodes_.data() + p * 3 * static_cast<std::size_t>(header_.num_functions);
  if (harmonics_) {
    std::array<float, (kMaxDegree + 1) * (kMaxDegree + 1)> row;
    harmonics_->evaluate(vector_of(direction), row.data());
    for (std::size_t k = 0; k < static_cast<std::size_t>(harmonics_->size()); ++k)
      for (std::size_t c = 0; c < 3; ++c) rgb[c] += row[k] * nodes[3 * k + c];
    return rgb;
  }
  const NodeTaps taps = node_taps(header_.basis, static_cast<double>(direction[0]),
                                  static_cast<double>(direction[1]));
  for (std::size_t t = 0; t < taps.count; ++t) {
    const auto weight = static_cast<float>(taps.weight[t]);
    for (std::size_t c = 0; c < 3; ++c) rgb[c] += weight * nodes[3 * taps.node[t] + c];
  }
  return rgb;
}

std::array<float, 3> ViewMaps::mean(std::size_t p) const { return mean_[p]; }

}  // namespace slf
