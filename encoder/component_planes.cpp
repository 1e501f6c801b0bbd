// SPDX-License-Identifier: Apache-2.0
#include "encoder/component_planes.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "attributes/quantiser.h"
#include "base/release.h"
#include "slf/given_planes.h"
#include "slf/parallel.h"
#include "slf/view_map.h"

namespace slf {
namespace {

constexpr int kMostShift = 6;
constexpr std::size_t kPointGrain = 2048;

/// 1, 8, 27, and the rest of the harmonics.
int group_of_degree(int degree) { return degree == 0 ? 0 : degree <= 2 ? 1 : degree <= 5 ? 2 : 3; }

/// 0 for the constant, k + 1 for a wavelet of scale k.
int scale_of(unsigned index) { return static_cast<int>(std::bit_width(index)); }

/// @param largest  [K] of the magnitudes so far
void take_largest(std::span<const float> coefficients, std::vector<float>& largest) {
  for (std::size_t i = 0; i < coefficients.size(); ++i) {
    float& most = largest[i / 3 % largest.size()];
    most = std::max(most, std::abs(coefficients[i]));
  }
}

std::vector<int> shifts_for(const std::vector<float>& largest, std::size_t slice_points) {
  std::vector<int> shifts(largest.size(), kMostShift);
  const double root = std::floor(std::sqrt(static_cast<double>(slice_points))) + 2;
  for (std::size_t k = 0; k < shifts.size(); ++k)
    while (shifts[k] > 0 && (std::ldexp(static_cast<double>(largest[k]), shifts[k]) + 1) * root >=
                                static_cast<double>(kCoefficientLimit))
      --shifts[k];
  return shifts;
}

/// [3 K]
std::vector<float> scales_of(const std::vector<int>& shifts) {
  std::vector<float> scale(3 * shifts.size());
  for (std::size_t j = 0; j < scale.size(); ++j) scale[j] = static_cast<float>(1 << shifts[j / 3]);
  return scale;
}

/// @param scale  [row]
void round_rows(std::span<const float> coefficients, const std::vector<float>& scale, int threads,
                std::int32_t* components) {
  const std::size_t row = scale.size();
  parallel_ranges(
      coefficients.size() / row, kPointGrain, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p)
          for (std::size_t j = 0; j < row; ++j)
            components[p * row + j] = static_cast<std::int32_t>(
                std::lround(std::clamp(coefficients[p * row + j] * scale[j], -1e9f, 1e9f)));
      });
}

}  // namespace

void to_coded_channels(std::span<float> coefficients, ColourTransform transform, int threads) {
  if (transform == ColourTransform::kNone) return;
  const auto to_rgb = colour_matrix(transform);
  parallel_ranges(coefficients.size() / 3, kPointGrain * 64, threads,
                  [&](std::size_t begin, std::size_t end) {
                    for (std::size_t i = begin; i < end; ++i) {
                      float* rgb = &coefficients[3 * i];
                      std::array<double, 3> coded{};
                      for (std::size_t c = 0; c < 3; ++c)
                        for (std::size_t from = 0; from < 3; ++from)
                          coded[c] += to_rgb[from][c] * static_cast<double>(rgb[from]);
                      for (std::size_t c = 0; c < 3; ++c) rgb[c] = static_cast<float>(coded[c]);
                    }
                  });
}

std::vector<int> component_shifts(std::span<const float> coefficients, std::size_t functions,
                                  std::size_t slice_points) {
  std::vector<float> largest(functions, 0);
  take_largest(coefficients, largest);
  return shifts_for(largest, slice_points);
}

std::vector<int> component_shifts(FittedRows& coefficients, std::size_t functions,
                                  std::size_t slice_points) {
  std::vector<float> largest(functions, 0);
  for (const auto& piece : coefficients.pieces()) take_largest(piece, largest);
  return shifts_for(largest, slice_points);
}

std::vector<std::int32_t> to_components(std::span<const float> coefficients,
                                        const std::vector<int>& shifts, int threads) {
  std::vector<std::int32_t> components(coefficients.size());
  round_rows(coefficients, scales_of(shifts), threads, components.data());
  return components;
}

std::vector<std::int32_t> to_components(FittedRows coefficients, const std::vector<int>& shifts,
                                        int threads) {
  std::vector<std::int32_t> components;
  std::size_t all = 0;
  for (const auto& piece : coefficients.pieces()) all += piece.size();
  components.reserve(all);  // pages that nothing is in yet take no memory
  for (auto& piece : coefficients.pieces()) {
    const std::size_t at = components.size();
    components.resize(at + piece.size());
    round_rows(piece, scales_of(shifts), threads, components.data() + at);
    release(piece);
  }
  return components;
}

std::vector<float> decoded_coefficients(const LightField& field, int threads) {
  const auto to_rgb = colour_matrix(field.header.colour);
  const std::vector<std::int32_t> planes = given_planes(field, threads);
  std::vector<float> coefficients(planes.size());
  const std::vector<int>& shift = field.header.shift;
  parallel_ranges(
      planes.size() / 3, kPointGrain * 64, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
          for (std::size_t c = 0; c < 3; ++c) {
            double sum = 0;
            for (std::size_t from = 0; from < 3; ++from)
              sum += to_rgb[c][from] * planes[3 * i + from];
            coefficients[3 * i + c] = static_cast<float>(std::ldexp(sum, -shift[i % shift.size()]));
          }
      });
  return coefficients;
}

std::vector<std::array<std::uint32_t, 3>> quantiser_steps(const Basis& basis,
                                                          const std::vector<int>& shifts, double q,
                                                          bool by_norm) {
  const std::vector<double> norms = basis_norms(basis);
  std::vector<std::array<std::uint32_t, 3>> steps;
  for (std::size_t k = 0; k < shifts.size(); ++k) {
    const double step = std::ldexp(by_norm ? q / (2 * norms[k]) : q, shifts[k]);
    const auto rounded = static_cast<std::uint32_t>(std::lround(std::clamp(step, 1.0, kMostStep)));
    steps.push_back({rounded, rounded, rounded});
  }
  return steps;
}

std::vector<std::array<std::uint32_t, 3>> texture_steps(const Basis& basis,
                                                        const std::vector<int>& shifts,
                                                        std::span<const std::uint32_t> least,
                                                        bool by_norm) {
  const std::vector<double> norms = basis_norms(basis);
  const auto weight = [&](std::size_t k) {
    return std::ldexp(by_norm ? 1 / norms[k] : 1, shifts[k]);
  };
  double scale = 0;
  for (std::size_t j = 0; j < least.size(); ++j) scale = std::max(scale, least[j] / weight(j / 3));
  std::vector<std::array<std::uint32_t, 3>> steps;
  for (std::size_t k = 0; k < shifts.size(); ++k) {
    // The product may round to just below the least step it was made from.
    const double step = std::ceil(scale * weight(k) * (1 - 1e-12));
    const auto rounded = static_cast<std::uint32_t>(std::clamp(step, 1.0, kMostStep));
    steps.push_back({rounded, rounded, rounded});
  }
  return steps;
}

std::vector<int> scale_groups(const Basis& basis) {
  if (basis.id == BasisId::kHarmonics) {
    std::vector<int> groups;
    for (int l = 0; l <= basis.degree; ++l)
      groups.insert(groups.end(), static_cast<std::size_t>(2 * l + 1), group_of_degree(l));
    return groups;
  }
  const int extra_theta = std::max(basis.scales_theta - basis.scales_gamma, 0);
  const int extra_gamma = std::max(basis.scales_gamma - basis.scales_theta, 0);
  std::vector<int> groups;
  for (int k = 0; k < basis.num_functions(); ++k) {
    const int theta = scale_of(static_cast<unsigned>(k) & ((1u << basis.scales_theta) - 1));
    const int gamma = scale_of(static_cast<unsigned>(k) >> basis.scales_theta);
    groups.push_back(k == 0 ? 0 : std::max({theta - extra_theta, gamma - extra_gamma, 1}));
  }
  return groups;
}

}  // namespace slf
