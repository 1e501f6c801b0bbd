// SPDX-License-Identifier: Apache-2.0
#include "encoder/plenoptic/plenoptic_coding.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/input_error.h"
#include "encoder/coding_parameters.h"
#include "encoder/encode_metadata.h"

namespace slf {
namespace {

/// Step of the planes of an exact file, grey levels. The corrections take what it leaves: smaller
/// and larger steps are larger files on clouds with the noise of cameras (docs/decisions/026).
constexpr std::uint32_t kExactStep = 8;
constexpr int kPlaneShift = 3;  // of planes with a step: eighths of a grey level

/// Bytes of a coefficient of three channels, as floats or as integers.
constexpr std::uint64_t kCoefficientBytes = 3 * 4;
/// Bytes of each point that an encode holds at its peak, measured at 0.3 and 4 million points
/// (docs/decisions/042). A function of view maps counts what transforms hold of it while they are
/// derived, a colour of planes the bytes of an exact file. Every point has kHeldByPoint more.
/// Points of two slices in flight are held twice.
constexpr std::uint64_t kHeldByFunction = 18, kHeldByColour = 25, kHeldByPoint = 150;
constexpr std::uint64_t kPointsInFlight = 2 * kDefaultSlicePoints;

std::uint64_t held_by_view_maps(const PlenopticCloud& cloud, std::uint64_t points, int functions) {
  return kHeldByFunction * static_cast<std::uint64_t>(functions) *
             (points + std::min(points, kPointsInFlight)) +
         points * (3 * cloud.num_colours() + kHeldByPoint);
}

InputError wrong_cloud(const std::string& what) {
  return {Errc::kInvalidInput, "plenoptic cloud: " + what};
}

}  // namespace

Result<Done, InputError> check_plenoptic_cloud(const PlenopticCloud& cloud) {
  if (cloud.views < 1 || cloud.views > kMostViews)
    return wrong_cloud(std::to_string(cloud.views) + " views, of 1 to " +
                       std::to_string(kMostViews));
  const std::size_t bytes = 3 * cloud.num_points() * cloud.num_colours();
  if (cloud.colours.size() != bytes)
    return wrong_cloud("colours: " + std::to_string(cloud.colours.size()) + " bytes in place of " +
                       std::to_string(bytes));
  if (!cloud.view_positions.empty() && cloud.view_positions.size() != cloud.views)
    return wrong_cloud("view_positions: " + std::to_string(cloud.view_positions.size()) + " of " +
                       std::to_string(cloud.views) + " views");
  for (const Vec3& at : cloud.view_positions)
    if (!std::isfinite(at[0]) || !std::isfinite(at[1]) || !std::isfinite(at[2]))
      return wrong_cloud("view_positions: a value that is not finite");
  const std::size_t properties = 3 + 3 * cloud.num_colours();
  if (cloud.properties.empty() || cloud.properties.size() == properties) return Done{};
  return wrong_cloud("properties: " + std::to_string(cloud.properties.size()) + " in place of " +
                     std::to_string(properties));
}

std::vector<PlenopticProperty> properties_of(const PlenopticCloud& cloud) {
  if (!cloud.properties.empty()) return cloud.properties;
  std::vector<PlenopticProperty> made;
  for (const char* axis : {"x", "y", "z"}) made.push_back({"float", axis});
  const auto add = [&](const std::string& of_view) {
    for (const char* channel : {"red", "green", "blue"})
      made.push_back({"uchar", channel + of_view});
  };
  if (cloud.own_colour) add("");
  for (std::size_t v = 0; v < cloud.views; ++v) add("_" + std::to_string(v));
  return made;
}

Result<Done, InputError> check_plenoptic(const PlenopticCloud& cloud,
                                         const PlenopticSettings& settings, PlenopticCoding as) {
  const EncoderSettings& s = settings.encoder;
  if (s.coefficients == CoefficientCoder::kTexture)
    return invalid_argument("--coefficients texture: plenoptic clouds have vector or independent");
  if (s.target_bytes > 0 || s.target_psnr > 0 || s.target_bitrate > 0)
    return invalid_argument(
        "--target-bytes, --target-bitrate, --target-psnr: plenoptic clouds have -q");
  if (s.normal_bits > 0) return invalid_argument("--normals: plenoptic clouds keep no normals");
  std::vector<int> sorted = settings.hold_out;
  std::sort(sorted.begin(), sorted.end());
  if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end())
    return invalid_argument("--hold-out: a view twice");
  if (!sorted.empty() && (sorted.front() < 0 || sorted.back() >= static_cast<int>(cloud.views)))
    return InputError{Errc::kInvalidArgument,
                      "--hold-out: views are 0 to " + std::to_string(cloud.views - 1)};
  if (as == PlenopticCoding::kPlanes && !sorted.empty())
    return invalid_argument(
        "--hold-out: planes predict no view that they do not have (--as viewmaps)");
  if (as == PlenopticCoding::kViewMaps && cloud.view_positions.empty())
    return InputError{
        Errc::kInvalidInput,
        "view maps need positions of views: --views FILE, or comment lines \"view 0 X "
        "Y Z\" in the PLY (docs/plenoptic.md)"};
  return Done{};
}

PlenopticCoding choose_coding(const PlenopticSettings& settings, std::string& reason) {
  if (settings.as != PlenopticCoding::kAuto) {
    reason = "as asked for";
    return settings.as;
  }
  if (!settings.hold_out.empty()) {
    reason = "views are held out, which planes cannot predict";
    return PlenopticCoding::kViewMaps;
  }
  reason = "no view is held out: planes are smaller at equal quality (docs/plenoptic.md)";
  return PlenopticCoding::kPlanes;
}

Metadata plenoptic_metadata(const PlenopticCloud& cloud, const EncoderSettings& settings,
                            const PlenopticRecord& record, const ChosenFit* fit,
                            std::size_t points) {
  Encoded encoded;
  encoded.merged = cloud.merged;
  encoded.grid = cloud.grid;
  if (fit != nullptr) encoded.observations = points * (cloud.views - record.hold_out.size());
  EncoderSettings plain = settings;
  plain.surface = Surface::kGiven;
  plain.grid_bits = cloud.grid.bits;
  plain.metadata.clear();
  if (fit == nullptr) plain.steps_by_norm = false;
  Metadata metadata = encoder_metadata(plain, encoded, 0);
  if (fit != nullptr) {
    const Metadata more = fit_metadata(*fit);
    metadata.insert(metadata.end(), more.begin(), more.end());
  }
  const Metadata own = write_record(record);
  metadata.insert(metadata.end(), own.begin(), own.end());
  metadata.insert(metadata.end(), settings.metadata.begin(), settings.metadata.end());
  return metadata;
}

PlenopticRecord record_of(const PlenopticCloud& cloud, const PlenopticSettings& settings,
                          PlenopticCoding as) {
  PlenopticRecord record;
  record.as = as;
  record.hold_out = settings.hold_out;
  record.view_positions = cloud.view_positions;
  record.properties = properties_of(cloud);
  record.views = cloud.views;
  record.own_colour = cloud.own_colour;
  return record;
}

PlanesCoding planes_coding(const PlenopticCloud& cloud, EncoderSettings settings,
                           PlenopticRecord& record) {
  record.exact = settings.q == kAutomaticQ;
  if (record.exact) settings.q = kExactStep;
  PlanesCoding coding{record.exact ? 0 : kPlaneShift, settings.q, coding_parameters(settings)};
  CodingParameters& parameters = coding.parameters;
  const auto step =
      static_cast<std::uint32_t>(std::max(1l, std::lround(std::ldexp(settings.q, coding.shift))));
  const std::size_t coded = cloud.num_colours() - (record.mean ? 1 : 0);
  parameters.step.assign(coded, {step, step, step});
  parameters.coefficient_level_ends = level_ends(cloud.grid.bits);
  if (settings.geometry == GeometryCoder::kOctree)
    parameters.geometry_level_ends = parameters.coefficient_level_ends;
  parameters.metadata = plenoptic_metadata(cloud, settings, record, nullptr, 0);
  return coding;
}

Result<Done, InputError> limit_memory(const PlenopticSettings& settings,
                                      const PlenopticCloud& cloud, std::uint64_t points,
                                      PlenopticCoding as, Basis& basis) {
  const std::uint64_t most = settings.most_memory;
  const auto needed = [&] {
    return as == PlenopticCoding::kPlanes
               ? points * (kHeldByColour * cloud.num_colours() + kHeldByPoint)
               : held_by_view_maps(cloud, points, basis.num_functions());
  };
  const auto too_much = [&] {
    const auto coefficients =
        static_cast<std::uint64_t>(basis.num_functions()) * points * kCoefficientBytes;
    return (settings.memory > 0 && coefficients > settings.memory) || (most > 0 && needed() > most);
  };
  if (as == PlenopticCoding::kViewMaps && basis.id == BasisId::kHarmonics)
    while (basis.degree > 0 && too_much()) --basis.degree;
  if (most == 0 || needed() <= most) return Done{};
  return InputError{Errc::kLimitExceeded, "--memory: " + std::to_string(points) + " points with " +
                                              std::to_string(cloud.num_colours()) +
                                              " colours take some " +
                                              std::to_string((needed() >> 20) + 1) + " MiB"};
}

}  // namespace slf
