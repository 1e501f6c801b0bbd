// SPDX-License-Identifier: Apache-2.0
// A plenoptic cloud to bytes, by way of planes or of view maps.
#include "base/error_words.h"
#include "base/stopwatch.h"
#include "codec/encoder/pack_frame.h"
#include "encoder/check_settings.h"
#include "encoder/coding_parameters.h"
#include "encoder/plenoptic/corrections.h"
#include "encoder/plenoptic/plenoptic_coding.h"
#include "encoder/plenoptic/plenoptic_planes.h"
#include "encoder/plenoptic/plenoptic_view_maps.h"
#include "slf/decoder.h"

namespace slf {
namespace {

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
                                                   PlenopticRecord record,
                                                   const EncoderSettings& settings,
                                                   const Progress& progress) {
  record.mean = own_is_mean(cloud);
  const PlanesCoding coding = planes_coding(cloud, settings, record);
  PlenopticEncoded encoded;
  encoded.exact = record.exact;
  encoded.q = coding.q;
  if (progress) progress("code", 0);
  SLF_TRY(encoded.stream,
          pack_taken(field_of_planes(cloud, record, coding.shift), coding.parameters));
  if (encoded.exact) SLF_CHECK(add_corrections(cloud, record, settings.threads, encoded));
  if (progress) progress("code", 1);
  return encoded;
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
  parameters.metadata = plenoptic_metadata(cloud, settings, record, &chosen, points);
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
  if (cloud.num_points() == 0) return InputError{Errc::kInvalidInput, "no points"};
  SLF_CHECK(check_settings(settings.encoder));
  SLF_CHECK(check_plenoptic_cloud(cloud));
  SLF_CHECK(check_plenoptic(cloud, settings, as));
  PlenopticRecord record = record_of(cloud, settings, as);
  EncoderSettings encoder = settings.encoder;
  SLF_CHECK(limit_memory(settings, cloud, cloud.num_points(), as, encoder.fit.basis));
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
