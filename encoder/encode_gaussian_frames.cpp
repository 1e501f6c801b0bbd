// SPDX-License-Identifier: Apache-2.0
// Splats of several instants to one stream.
#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "base/stopwatch.h"
#include "base/vec3.h"
#include "bitstream/units.h"
#include "encoder/check_frame_run.h"
#include "encoder/frames_to_bitrate.h"
#include "encoder/gaussian_frames.h"
#include "slf/encode_gaussians.h"
#include "slf/gaussian_frames.h"

namespace slf {
namespace {

/// The list of frames after the first look at each.
struct GaussianRun {
  std::size_t frames;
  const LoadGaussians& load;
  const EncoderSettings& settings;
  const FrameSettings& frame_settings;
  const Progress& progress;
  const Vec3& origin;
  GaussianExtent extent;
  std::vector<std::size_t> points;
  std::optional<Vec3> base;  ///< what positions of all frames are from: that of the first splats

  /// What a frame shows.
  /// @param given  receives how many splats it has
  Result<Gaussians, InputError> shown_of(std::size_t f, std::size_t& given) const {
    SLF_TRY(Gaussians splats, load(f));
    SLF_CHECK(of_frame(f, check_gaussians(splats)));
    given = splats.size();
    const Vec3 by = minus(splats.origin, base.value_or(splats.origin));
    if (by != Vec3{0, 0, 0})
      for (auto& at : splats.positions) at = to_float(plus(to_double(at), by));
    if (base) splats.origin = *base;
    return that_show(std::move(splats));
  }

  Result<Done, InputError> look() {
    for (std::size_t f = 0; f < frames; ++f) {
      if (progress) progress("load", static_cast<double>(f) / static_cast<double>(frames));
      std::size_t given = 0;
      SLF_TRY(const Gaussians shown, shown_of(f, given));
      if (!base && shown.size() > 0) base = shown.origin;
      points.push_back(shown.size());
      SLF_CHECK(of_frame(f, extent.add(shown)));
    }
    if (extent.is_empty())
      return InputError{Errc::kInvalidArgument,
                        "frames: none has a splat with an opacity of 1/255 or more"};
    return Done{};
  }

  Result<Done, InputError> code(double q, std::size_t first, std::size_t count,
                                const TakeFrame& take, EncodedFrames& encoded) const {
    EncoderSettings own = settings;
    own.q = q;
    SLF_TRY(GaussianFrameEncoder encoder,
            GaussianFrameEncoder::open(extent, own, frame_settings.group,
                                       static_cast<std::uint32_t>(first),
                                       plus(origin, base.value_or(Vec3{0, 0, 0}))));
    encoded.grid = encoder.grid();
    encoded.q = encoder.q();
    encoded.frames.clear();
    for (std::size_t f = first; f < first + count; ++f) {
      if (progress) progress("frames", static_cast<double>(f - first) / static_cast<double>(count));
      Stopwatch watch;
      std::size_t given = 0;
      SLF_TRY(const Gaussians shown, shown_of(f, given));
      SLF_TRY(const auto bytes, encoder.add(shown, static_cast<double>(f) / frame_settings.rate));
      SLF_CHECK(take(f, bytes));
      EncodedFrame frame;
      frame.predicted = bytes.front() != kSignature.front();
      frame.points = shown.size();
      frame.left_out = given - shown.size();
      frame.bytes = bytes.size();
      frame.seconds = watch.lap();
      encoded.frames.push_back(frame);
    }
    if (progress) progress("frames", 1);
    return Done{};
  }
};

}  // namespace

Result<PlannedFrames, InputError> plan_gaussian_frames(std::size_t frames,
                                                       const LoadGaussians& load,
                                                       const EncoderSettings& settings,
                                                       const FrameSettings& frame_settings,
                                                       const Progress& progress) {
  SLF_CHECK(check_frame_run(frames, settings, frame_settings));
  SLF_CHECK(check_coding_of_splats(settings));
  const Vec3 origin{0, 0, 0};
  GaussianRun run{frames, load, settings, frame_settings, progress, origin, {}, {}, {}};
  SLF_CHECK(run.look());
  PlannedFrames plan;
  SLF_TRY(plan.grid,
          run.extent.grid(settings.q == kAutomaticQ ? kGaussianQ : settings.q, settings));
  plan.points = std::move(run.points);
  plan.cameras.assign(frames, 0);
  plan.part = frames_of_part(frames, frame_settings);
  return plan;
}

Result<EncodedFrames, InputError> encode_gaussian_frames(
    std::size_t frames, const LoadGaussians& load, const EncoderSettings& settings,
    const FrameSettings& frame_settings, const TakeFrame& take, const Progress& progress,
    const Vec3& origin) {
  SLF_CHECK(check_frame_run(frames, settings, frame_settings));
  SLF_CHECK(check_coding_of_splats(settings));
  GaussianRun run{frames, load, settings, frame_settings, progress, origin, {}, {}, {}};
  SLF_CHECK(run.look());
  std::size_t chooser = 0;
  while (run.points[chooser] == 0) ++chooser;
  const RateJob job{frames,
                    chooser,
                    frame_settings,
                    settings.target_bitrate,
                    kGaussianQ,
                    [&](double q, std::size_t first, std::size_t count, const TakeFrame& to,
                        EncodedFrames& out) { return run.code(q, first, count, to, out); }};
  const auto [first, count] = frames_of_part(frames, frame_settings);
  EncodedFrames encoded;
  SLF_CHECK(settings.target_bitrate > 0 ? code_to_bitrate(job, take, encoded)
                                        : run.code(settings.q, first, count, take, encoded));
  return encoded;
}

}  // namespace slf
