// SPDX-License-Identifier: Apache-2.0
// Plenoptic clouds of several instants to one stream.
#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "base/input_error.h"
#include "base/stopwatch.h"
#include "bitstream/units.h"
#include "encoder/check_frame_run.h"
#include "encoder/coding_parameters.h"
#include "encoder/frames_to_bitrate.h"
#include "encoder/plenoptic/corrections.h"
#include "encoder/plenoptic/plenoptic_coding.h"
#include "encoder/plenoptic/plenoptic_grid.h"
#include "encoder/plenoptic/plenoptic_planes.h"
#include "encoder/plenoptic/plenoptic_view_maps.h"
#include "slf/plenoptic_frames.h"

namespace slf {
namespace {

/// How the frames of a run are coded.
struct CloudCoding {
  PlenopticRecord record;
  int shift = 0;             // of planes
  LightFieldHeader header;   // of view maps, and of planes in an empty frame
  EncoderSettings settings;  // of view maps: what the first frame with points chose
  double q = 0;
  CodingParameters parameters;
};

/// The list of frames after the first look at each.
struct CloudRun {
  std::size_t frames;
  const LoadPlenoptic& load;
  const PlenopticSettings& settings;
  const FrameSettings& frame_settings;
  const Progress& progress;
  PlenopticCoding as;
  PlenopticCloud like = {};  // what all have in common: no points
  std::size_t chooser = 0;   // the first frame with points
  bool mean = true;          // the own colour of all is the mean of their views
  std::vector<std::size_t> points = {};

  Result<Done, InputError> look();
  /// @param q  quantiser step, or kAutomaticQ
  Result<Done, InputError> code(double q, std::size_t first, std::size_t count,
                                const TakeFrame& take, EncodedFrames& encoded) const;

 private:
  Result<CloudCoding, InputError> coding_of(double q) const;
  Result<CloudCoding, InputError> view_maps_of(EncoderSettings own) const;
  Result<LightField, InputError> field_of(const CloudCoding& coding, PlenopticCloud& cloud) const;
};

Result<Done, InputError> CloudRun::look() {
  PlenopticGrid grid;
  std::size_t merged = 0;
  for (std::size_t f = 0; f < frames; ++f) {
    if (progress) progress("load", static_cast<double>(f) / static_cast<double>(frames));
    SLF_TRY(PlenopticCloud cloud, load(f));
    points.push_back(cloud.num_points());
    if (cloud.num_points() == 0) continue;
    SLF_CHECK(of_frame(f, check_plenoptic_cloud(cloud)));
    SLF_CHECK(of_frame(f, grid.add(cloud)));
    mean = mean && own_is_mean(cloud);
    merged += cloud.merged;
    cloud.positions.clear();
    cloud.colours.clear();
    if (like.views > 0) {
      SLF_CHECK(of_frame(f, check_same_views(like, cloud)));
    } else {
      chooser = f;
      like = std::move(cloud);
    }
  }
  if (like.views == 0) return invalid_input("frames: none has points");
  PlenopticSettings plain = settings;
  plain.encoder.target_bitrate = 0;
  SLF_CHECK(check_plenoptic(like, plain, as));
  like.merged = merged;
  SLF_TRY(like.grid, grid.grid());
  return Done{};
}

Result<CloudCoding, InputError> CloudRun::view_maps_of(EncoderSettings own) const {
  if (own.q == kAutomaticQ) own.q = kPlainQ;
  own.fit.pictures.rounds = 0;
  own.fit.threads = own.threads;
  const std::uint64_t most = *std::max_element(points.begin(), points.end());
  SLF_CHECK(limit_memory(settings, like, most, as, own.fit.basis));
  CloudCoding coding;
  coding.record = record_of(like, settings, as);
  coding.q = own.q;
  SLF_TRY(PlenopticCloud cloud, load(chooser));
  SLF_TRY(cloud, on_grid_of_voxels(std::move(cloud), like.grid));
  ChosenFit chosen;
  SLF_TRY(LightField field, fit_plenoptic(cloud, coding.record, own, chosen, progress));
  coding.header = field.header;
  coding.parameters = coding_parameters(field, own);
  coding.parameters.metadata =
      plenoptic_metadata(like, own, coding.record, &chosen, points[chooser]);
  coding.settings = std::move(own);
  coding.settings.search = FitSearch::none();
  return coding;
}

Result<CloudCoding, InputError> CloudRun::coding_of(double q) const {
  EncoderSettings own = settings.encoder;
  own.q = q;
  own.target_bitrate = 0;
  if (as == PlenopticCoding::kViewMaps) return view_maps_of(std::move(own));
  CloudCoding coding;
  coding.record = record_of(like, settings, as);
  coding.record.mean = mean;
  PlanesCoding planes = planes_coding(like, own, coding.record);
  coding.shift = planes.shift;
  coding.q = planes.q;
  coding.parameters = std::move(planes.parameters);
  coding.header = field_of_planes(like, coding.record, coding.shift).header;
  coding.header.metres_per_unit = own.metres_per_unit;
  return coding;
}

/// @param cloud  on the grid of all; view maps take its points
Result<LightField, InputError> CloudRun::field_of(const CloudCoding& coding,
                                                  PlenopticCloud& cloud) const {
  LightField field;
  if (cloud.num_points() > 0 && as == PlenopticCoding::kPlanes) {
    field = field_of_planes(cloud, coding.record, coding.shift);
  } else if (cloud.num_points() > 0) {
    EncoderSettings own = coding.settings;
    ChosenFit chosen;
    SLF_TRY(field, fit_plenoptic(cloud, coding.record, own, chosen, {}, coding.header.shift));
  }
  field.header = coding.header;
  return field;
}

Result<Done, InputError> CloudRun::code(double q, std::size_t first, std::size_t count,
                                        const TakeFrame& take, EncodedFrames& encoded) const {
  SLF_TRY(const CloudCoding coding, coding_of(q));
  encoded.grid = like.grid;
  encoded.q = coding.q;
  encoded.as = as == PlenopticCoding::kPlanes ? "planes" : "viewmaps";
  encoded.exact = coding.record.exact;
  encoded.frames.clear();
  const int threads = settings.encoder.threads;
  FrameEncoder encoder(coding.parameters, frame_settings.group, static_cast<std::uint32_t>(first));
  for (std::size_t f = first; f < first + count; ++f) {
    if (progress) progress("frames", static_cast<double>(f - first) / static_cast<double>(count));
    Stopwatch watch;
    SLF_TRY(PlenopticCloud cloud, load(f));
    const std::size_t num_points = cloud.num_points();
    if (num_points > 0) {
      SLF_TRY(cloud, on_grid_of_voxels(std::move(cloud), like.grid));
    }
    SLF_TRY(const LightField field, field_of(coding, cloud));
    const auto corrections = [&](const LightField& decoded) {
      const std::vector<std::uint8_t> near = bytes_of_planes(decoded, threads),
                                      exact = coded_bytes(cloud, coding.record);
      const std::size_t row = exact.size() / num_points;
      return corrections_of_frame(write_corrections({exact, row}, {near, row}, threads));
    };
    SLF_TRY(const auto bytes,
            encoder.add(field, static_cast<double>(f) / frame_settings.rate,
                        encoded.exact && num_points > 0 ? corrections : UnitOfFrame{}));
    SLF_CHECK(take(f, bytes));
    EncodedFrame frame;
    frame.predicted = bytes.front() != kSignature.front();
    frame.points = num_points;
    frame.bytes = bytes.size();
    frame.seconds = watch.lap();
    encoded.frames.push_back(frame);
  }
  if (progress) progress("frames", 1);
  return Done{};
}

Result<CloudRun, InputError> looked_at(std::size_t frames, const LoadPlenoptic& load,
                                       const PlenopticSettings& settings,
                                       const FrameSettings& frame_settings,
                                       const Progress& progress) {
  SLF_CHECK(check_frame_run(frames, settings.encoder, frame_settings));
  if (settings.most_memory > 0)
    return invalid_argument("frames: a limit of memory is of one cloud");
  std::string reason;
  CloudRun run{frames, load, settings, frame_settings, progress, choose_coding(settings, reason)};
  SLF_CHECK(run.look());
  return run;
}

}  // namespace

Result<PlannedFrames, InputError> plan_plenoptic_frames(std::size_t frames,
                                                        const LoadPlenoptic& load,
                                                        const PlenopticSettings& settings,
                                                        const FrameSettings& frame_settings,
                                                        const Progress& progress) {
  SLF_TRY(const CloudRun run, looked_at(frames, load, settings, frame_settings, progress));
  PlannedFrames plan;
  plan.grid = run.like.grid;
  plan.points = run.points;
  plan.cameras.assign(frames, 0);
  plan.part = frames_of_part(frames, frame_settings);
  return plan;
}

Result<EncodedFrames, InputError> encode_plenoptic_frames(
    std::size_t frames, const LoadPlenoptic& load, const PlenopticSettings& settings,
    const FrameSettings& frame_settings, const TakeFrame& take, const Progress& progress) {
  SLF_TRY(const CloudRun run, looked_at(frames, load, settings, frame_settings, progress));
  const RateJob job{frames,
                    run.chooser,
                    frame_settings,
                    settings.encoder.target_bitrate,
                    kPlainQ,
                    [&](double q, std::size_t first, std::size_t count, const TakeFrame& to,
                        EncodedFrames& out) { return run.code(q, first, count, to, out); }};
  const auto [first, count] = frames_of_part(frames, frame_settings);
  EncodedFrames encoded;
  SLF_CHECK(settings.encoder.target_bitrate > 0
                ? code_to_bitrate(job, take, encoded)
                : run.code(settings.encoder.q, first, count, take, encoded));
  return encoded;
}

}  // namespace slf
