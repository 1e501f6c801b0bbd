// Trained surfels as the PLY of Gaussian splats that other programs read: what tools/rd/splats.py
// codes by SPZ and SOG, from the same trainer and photographs as our own files.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "slf/capture.h"
#include "train/trained_surfel.h"

namespace slf {

/// Kerbl et al. 2023, harmonics of degree 2, in the world of the cameras.
inline Result<Done, InputError> write_surfel_splats(const std::filesystem::path& file,
                                                    const TrainedSurfels& surfels) {
  static_assert(std::endian::native == std::endian::little);
  constexpr float kReach = 3;     // deviations: (1 - r^2)^4 is nearly a Gaussian of a third
  constexpr float kThin = 1e-2f;  // of the lesser radius
  constexpr std::size_t kRest = kTrainedFunctions - 1;
  std::string text = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                     std::to_string(surfels.size()) + "\n";
  std::vector<std::string> names = {"x", "y", "z", "nx", "ny", "nz"};
  for (int c = 0; c < 3; ++c) names.push_back("f_dc_" + std::to_string(c));
  for (std::size_t i = 0; i < 3 * kRest; ++i) names.push_back("f_rest_" + std::to_string(i));
  names.emplace_back("opacity");
  for (int a = 0; a < 3; ++a) names.push_back("scale_" + std::to_string(a));
  for (int a = 0; a < 4; ++a) names.push_back("rot_" + std::to_string(a));
  for (const std::string& name : names) text += "property float " + name + "\n";
  text += "end_header\n";
  std::vector<float> values;
  values.reserve(surfels.size() * names.size());
  for (const TrainedSurfel& surfel : surfels) {
    const float* v = surfel.value.data();
    values.insert(values.end(), v, v + 3);
    const Float3 normal = axes_of(surfel).normal;
    values.insert(values.end(), normal.begin(), normal.end());
    const float* colour = v + TrainedSurfel::kColour;
    values.insert(values.end(), colour, colour + 3);
    for (std::size_t c = 0; c < 3; ++c)  // channel by channel
      for (std::size_t k = 1; k <= kRest; ++k) values.push_back(colour[3 * k + c]);
    values.push_back(v[TrainedSurfel::kOpacity]);
    const float first = v[TrainedSurfel::kLogRadius], second = v[TrainedSurfel::kLogRadius + 1];
    for (const float log_radius : {first, second, std::min(first, second) + std::log(kThin)})
      values.push_back(log_radius - std::log(kReach));
    values.insert(values.end(), v + TrainedSurfel::kTurn, v + TrainedSurfel::kTurn + 4);
  }
  const std::span<const std::byte> pieces[] = {std::as_bytes(std::span(text)),
                                               std::as_bytes(std::span(values))};
  return write_file(file, pieces);
}

}  // namespace slf
