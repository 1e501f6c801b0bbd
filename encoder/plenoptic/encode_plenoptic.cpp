// SPDX-License-Identifier: Apache-2.0
// A plenoptic cloud to bytes, by way of planes or of view maps.
#include <algorithm>
#include <cmath>

#include "base/error_words.h"
#include "base/input_error.h"
#include "base/release.h"
#include "base/stopwatch.h"
#include "codec/encoder/pack_frame.h"
#include "encoder/coding_parameters.h"
#include "encoder/encode_metadata.h"
#include "encoder/plenoptic/corrections.h"
#include "encoder/plenoptic/plenoptic_planes.h"
#include "encoder/plenoptic/plenoptic_view_maps.h"
#include "slf/decoder.h"

namespace slf {
namespace {

/// Step of the planes of an exact file, grey levels. The corrections take what it leaves: smaller
/// and larger steps are larger files on clouds with the noise of cameras (docs/decisions/026).
constexpr std::uint32_t kExactStep = 8;
constexpr int kPlaneShift = 3;  // of planes with a step: eighths of a grey level

Result<Done, InputError> check_plenoptic(const PlenopticCloud& cloud,
                                         const PlenopticSettings& settings, PlenopticCoding as) {
  const EncoderSettings& s = settings.encoder;
  if (cloud.num_points() == 0) return InputError{Errc::kInvalidInput, "no points"};
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

/// The way, and why.
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

/// What encoder_metadata asks for, where there are no cameras.
/// @param cloud  perhaps without its points
Metadata metadata_of(const PlenopticCloud& cloud, const EncoderSettings& settings,
                     const PlenopticRecord& record, const ChosenFit* fit, std::size_t points) {
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

/// What the decoder will have, against what it should: the unit of the difference.
Result<Done, InputError> add_corrections(const PlenopticCloud& cloud, const PlenopticRecord& record,
                                         int threads, PlenopticEncoded& encoded) {
  DecodeOptions options;
  options.limits = DecodeLimits::none();
  options.threads = threads;
  std::vector<std::uint8_t> near;
  {
    const auto field = decode(encoded.stream, options);
    if (!field) return InputError{field.error().code, in_words(field.error())};
    near = bytes_of_planes(*field, threads);
  }
  const std::vector<std::uint8_t> exact = coded_bytes(cloud, record);
  const std::size_t row = exact.size() / cloud.num_points();
  const auto payload = write_corrections({exact, row}, {near, row}, threads);
  encoded.rest_bytes = payload.size();
  auto stream = with_corrections(encoded.stream, payload);
  if (!stream) return InputError{stream.error().code, in_words(stream.error())};
  encoded.stream = *std::move(stream);
  return Done{};
}

Result<PlenopticEncoded, InputError> encode_planes(const PlenopticCloud& cloud,
                                                   PlenopticRecord record, EncoderSettings settings,
                                                   const Progress& progress) {
  PlenopticEncoded encoded;
  encoded.exact = record.exact = settings.q == kAutomaticQ;
  record.mean = own_is_mean(cloud);
  const int shift = encoded.exact ? 0 : kPlaneShift;
  if (encoded.exact) settings.q = kExactStep;
  encoded.q = settings.q;
  CodingParameters parameters = coding_parameters(settings);
  const auto step =
      static_cast<std::uint32_t>(std::max(1l, std::lround(std::ldexp(settings.q, shift))));
  const std::size_t coded = cloud.num_colours() - (record.mean ? 1 : 0);
  parameters.step.assign(coded, {step, step, step});
  parameters.coefficient_level_ends = level_ends(cloud.grid.bits);
  if (settings.geometry == GeometryCoder::kOctree)
    parameters.geometry_level_ends = parameters.coefficient_level_ends;
  parameters.metadata = metadata_of(cloud, settings, record, nullptr, cloud.num_points());
  if (progress) progress("code", 0);
  SLF_TRY(encoded.stream, pack_taken(field_of_planes(cloud, record, shift), parameters));
  if (encoded.exact) SLF_CHECK(add_corrections(cloud, record, settings.threads, encoded));
  if (progress) progress("code", 1);
  return encoded;
}

/// Bytes of a coefficient of three channels, as floats or as integers.
constexpr std::uint64_t kCoefficientBytes = 3 * 4;
/// Bytes of each point that an encode holds at its peak, measured at 0.3 and 4 million points
/// (docs/decisions/042). A function of view maps counts what transforms hold of it while they are
/// derived, a colour of planes the bytes of an exact file. Every point has kHeldByPoint more.
/// Points of two slices in flight are held twice.
constexpr std::uint64_t kHeldByFunction = 18, kHeldByColour = 25, kHeldByPoint = 150;
constexpr std::uint64_t kPointsInFlight = 2 * kDefaultSlicePoints;

std::uint64_t held_by_view_maps(const PlenopticCloud& cloud, int functions) {
  const std::uint64_t points = cloud.num_points();
  return kHeldByFunction * static_cast<std::uint64_t>(functions) *
             (points + std::min(points, kPointsInFlight)) +
         points * (3 * cloud.num_colours() + kHeldByPoint);
}

/// The degree as far as memory goes.
Result<Done, InputError> limit_memory(const PlenopticSettings& settings,
                                      const PlenopticCloud& cloud, PlenopticCoding as,
                                      Basis& basis) {
  const std::uint64_t points = cloud.num_points(), most = settings.most_memory;
  const auto needed = [&] {
    return as == PlenopticCoding::kPlanes
               ? points * (kHeldByColour * cloud.num_colours() + kHeldByPoint)
               : held_by_view_maps(cloud, basis.num_functions());
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

/// @param cloud  its points are given up
Result<PlenopticEncoded, InputError> encode_view_maps(PlenopticCloud& cloud,
                                                      const PlenopticRecord& record,
                                                      EncoderSettings settings,
                                                      const Progress& progress) {
  PlenopticEncoded encoded;
  if (settings.q == kAutomaticQ) settings.q = kPlainQ;
  encoded.q = settings.q;
  settings.fit.pictures.rounds = 0;
  settings.fit.threads = settings.threads;
  const std::size_t points = cloud.num_points();
  Stopwatch watch;
  ChosenFit chosen;
  SLF_TRY(LightField field, fit_plenoptic(cloud, record, settings, chosen, progress));
  encoded.seconds_fit = watch.lap();
  CodingParameters parameters = coding_parameters(field, settings);
  parameters.metadata = metadata_of(cloud, settings, record, &chosen, points);
  if (progress) progress("code", 0);
  SLF_TRY(encoded.stream, pack_taken(std::move(field), parameters));
  encoded.seconds_code = watch.lap();
  if (progress) progress("code", 1);
  return encoded;
}

}  // namespace

Result<PlenopticEncoded, InputError> encode_plenoptic(PlenopticCloud cloud,
                                                      const PlenopticSettings& settings,
                                                      const Progress& progress) {
  std::string reason;
  const PlenopticCoding as = choose_coding(settings, reason);
  SLF_CHECK(check_plenoptic(cloud, settings, as));
  PlenopticRecord record;
  record.as = as;
  record.hold_out = settings.hold_out;
  record.view_positions = cloud.view_positions;
  record.properties = cloud.properties;
  record.views = cloud.views;
  record.own_colour = cloud.own_colour;
  EncoderSettings encoder = settings.encoder;
  SLF_CHECK(limit_memory(settings, cloud, as, encoder.fit.basis));
  Stopwatch watch;
  SLF_TRY(PlenopticEncoded encoded, as == PlenopticCoding::kPlanes
                                        ? encode_planes(cloud, std::move(record), encoder, progress)
                                        : encode_view_maps(cloud, record, encoder, progress));
  if (as == PlenopticCoding::kPlanes) encoded.seconds_code = watch.lap();
  encoded.as = as;
  encoded.reason = reason;
  return encoded;
}

}  // namespace slf
