// SPDX-License-Identifier: Apache-2.0
#include "encoder/gaussian_coding.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "encoder/check_settings.h"
#include "encoder/component_planes.h"
#include "encoder/gaussian_planes.h"
#include "geometry/morton.h"
#include "lightfield/keep_splats.h"
#include "slf/encode_gaussians.h"

namespace slf {
namespace {

// Shares of Q at which the last byte of each buys the same in pictures: slopes of blender_can and
// middlebury_dino, 4,000 and 6,000 splats. docs/decisions/024
constexpr double kOpacityShare = 0.04, kShapeShare = 0.019, kPositionShare = 0.014;

constexpr int kMostGridBits = 21;
constexpr double kMostCrowded = 64;  // times finer, for room

constexpr std::array kLevelShares{1.0 / 6, 1.0 / 3, 3.0 / 4};

/// What the reference rasteriser never draws.
const double kLeastLogit = -std::log(254.0);

}  // namespace

GaussianSteps steps_of(double q) { return {q, kOpacityShare * q, kShapeShare * q}; }

Result<Done, InputError> check_coding_of_splats(const EncoderSettings& settings) {
  SLF_CHECK(check_settings(settings));
  if (settings.geometry == GeometryCoder::kOctree &&
      settings.coefficients != CoefficientCoder::kTexture)
    return Done{};
  return InputError{Errc::kInvalidArgument, "splats: no Draco, and no texture maps"};
}

Gaussians that_show(Gaussians splats) {
  keep_splats(splats, [&](std::size_t p) { return !(double{splats.logits[p]} < kLeastLogit); });
  return splats;
}

double typical_deviation(const Gaussians& splats) {
  std::vector<float> middle;
  middle.reserve(splats.size());
  for (const auto& d : splats.log_deviations)
    middle.push_back(std::max(std::min(d[0], d[1]), std::min(std::max(d[0], d[1]), d[2])));
  const auto place = middle.begin() + static_cast<std::ptrdiff_t>(middle.size() / 2);
  std::nth_element(middle.begin(), place, middle.end());
  return std::exp(double{*place});
}

double room_of(const Gaussians& splats, double deviation) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  const auto [low, high] = bounds_of(splats);
  const double extent = std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
  const double finest = kPositionShare * kGaussianQ * deviation / kMostCrowded;
  if (!(extent > 0) || !(finest > 0)) return kNone;
  const int bits =
      std::clamp(static_cast<int>(std::ceil(std::log2(extent / finest))), 1, kMostGridBits);
  std::vector<std::uint64_t> codes = codes_of(splats, Grid{low, extent / ((1 << bits) - 1), bits});
  std::sort(codes.begin(), codes.end());
  // Neighbours in that order part where their codes first differ.
  std::array<std::size_t, kMostGridBits + 1> parted{};
  std::size_t places = 1;
  for (std::size_t i = 1; i < codes.size(); ++i)
    if (const std::uint64_t differ = codes[i] ^ codes[i - 1]; differ != 0) {
      ++parted[std::size_t(bits - (static_cast<int>(std::bit_width(differ)) - 1) / 3)];
      ++places;
    }
  std::size_t occupied = 1;
  for (int level = 0; level < bits; ++level) {
    occupied += parted[std::size_t(level)];
    if (4 * occupied >= 3 * places) return std::ldexp(extent, -level);
  }
  return finest;
}

double grid_step_of(double q, const SplatSizes& sizes, const EncoderSettings& settings) {
  if (settings.voxel_size > 0) return settings.voxel_size;
  if (settings.grid_bits > 0) return sizes.extent / ((1 << settings.grid_bits) - 1);
  const double step = kPositionShare * q * sizes.deviation;
  return std::clamp(sizes.room, step / kMostCrowded, step);
}

Metadata metadata_of_gaussians(double q, const EncoderSettings& settings) {
  Metadata metadata = settings.metadata;
  metadata.emplace_back("quality", std::to_string(q));
  return metadata;
}

std::vector<int> splat_level_ends(std::span<const Voxel> positions, int bits) {
  std::vector<std::size_t> begun(static_cast<std::size_t>(bits) + 1);  // nodes, by coarsest level
  ++begun[0];
  for (std::size_t p = 1; p < positions.size(); ++p) {
    const std::uint64_t differs = morton(positions[p - 1]) ^ morton(positions[p]);
    const auto below = (static_cast<int>(std::bit_width(differs)) + 2) / 3;  // the common node
    ++begun[static_cast<std::size_t>(bits - below + 1)];
  }
  std::vector<int> ends;
  std::size_t nodes = begun[0];
  auto share = kLevelShares.begin();
  for (int level = 1; level < bits && share != kLevelShares.end(); ++level) {
    nodes += begun[static_cast<std::size_t>(level)];
    const double here = static_cast<double>(nodes) / static_cast<double>(positions.size());
    if (here < *share) continue;
    ends.push_back(level);
    while (share != kLevelShares.end() && *share <= here) ++share;
  }
  ends.push_back(bits);
  return ends;
}

CodingParameters gaussian_parameters(const LightFieldHeader& header, const GaussianSteps& steps,
                                     const std::vector<int>& ends,
                                     const EncoderSettings& settings) {
  CodingParameters parameters = coding_parameters(settings);
  for (const int group : scale_groups(header.basis)) parameters.group.push_back(group + 1);
  std::vector<double> step(parameters.group.size(), steps.colour);
  for (const Attribute& attribute : header.attributes)
    for (int i = 0; i < attribute.num_functions; ++i) {
      parameters.group.push_back(0);
      step.push_back(attribute.id == AttributeId::kOpacity ? steps.opacity : steps.shape);
    }
  for (std::size_t k = 0; k < step.size(); ++k) {
    const double units = std::ldexp(step[k], header.shift[k]);
    const auto rounded = static_cast<std::uint32_t>(std::lround(std::clamp(units, 1.0, kMostStep)));
    parameters.step.push_back({rounded, rounded, rounded});
  }
  parameters.coefficient_level_ends = parameters.geometry_level_ends = ends;
  return parameters;
}

}  // namespace slf
