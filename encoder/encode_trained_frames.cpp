// SPDX-License-Identifier: Apache-2.0
#include "encoder/encode_trained_frames.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "base/input_error.h"
#include "base/stopwatch.h"
#include "encoder/encode_splats.h"
#include "encoder/middle_view.h"
#include "encoder/other_start.h"
#include "encoder/train/splats_in_time.h"
#include "slf/gaussian_frames.h"

namespace slf {
namespace {

/// The splats of every frame, and how long each took.
struct TrainedFrames {
  std::vector<Gaussians> splats;
  std::vector<std::size_t> still;
  std::vector<double> seconds;
  Vec3 origin{};
  Metadata metadata;
};

/// The first frame's photographs with what its training begins with.
Result<LoadedFrame, InputError> with_start(LoadedFrame frame, const EncoderSettings& settings,
                                           StartId& start) {
  EncoderSettings splats = settings;
  splats.surface = Surface::kSplats;
  SLF_TRY(std::optional<StartingPoints> points, other_start(frame.capture, frame.cameras, splats));
  if (points) {
    start = points->start;
    frame.capture.cloud = std::move(points->cloud);
    frame.capture.mesh = {};
  }
  if (const std::string obstacle = training_obstacle(frame.capture, frame.cameras);
      !obstacle.empty())
    return invalid_input("splats are trained by photographs: " + obstacle);
  return frame;
}

/// Splats that are in their place, and look, as in the frame before. O(n log n)
std::size_t count_still(const Gaussians& before, const Gaussians& now) {
  using Coefficients = std::span<const float>;
  const std::size_t count = now.harmonics.size() / std::max<std::size_t>(now.size(), 1);
  const auto looks = [&](const Gaussians& splats, std::size_t i) {
    return Coefficients(splats.harmonics).subspan(i * count, count);
  };
  std::vector<std::size_t> order(before.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto& places = before.positions;
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return places[a] < places[b]; });
  std::size_t still = 0;
  for (std::size_t i = 0; i < now.size(); ++i) {
    const auto& place = now.positions[i];
    const auto found =
        std::lower_bound(order.begin(), order.end(), place,
                         [&](std::size_t a, const auto& value) { return places[a] < value; });
    if (found == order.end() || places[*found] != place) continue;
    const Coefficients a = looks(before, *found), b = looks(now, i);
    still += before.logits[*found] == now.logits[i] && std::equal(a.begin(), a.end(), b.begin());
  }
  return still;
}

Result<TrainedFrames, InputError> trained_frames(std::size_t frames, const LoadFrame& load,
                                                 const EncoderSettings& settings,
                                                 const Progress& progress) {
  TrainedFrames out;
  SplatsInTime training{training_of_frames(settings)};
  for (std::size_t f = 0; f < frames; ++f) {
    Stopwatch watch;
    SLF_TRY(LoadedFrame frame, load(f));
    if (f == 0) {
      StartId start = StartId::kPoints;
      SLF_TRY(frame, with_start(std::move(frame), settings, start));
      training.set_volume(start == StartId::kVolume);
      out.origin = frame.capture.origin;
      out.metadata = {{"surface", word_of(Surface::kSplats)},
                      {"cameras", std::to_string(frame.cameras.size())}};
    }
    const Progress of_frame = [&](const char* stage, double done) {
      if (progress) progress(stage, (static_cast<double>(f) + done) / static_cast<double>(frames));
    };
    SLF_TRY(Gaussians splats, training.next(frame.capture, frame.cameras, of_frame));
    if (splats.size() == 0) return invalid_input("photographs agree on nothing: no splat was left");
    if (f == 0)
      add_middle_view(frame.capture, frame.cameras, training.cache(), settings.metadata,
                      out.metadata);
    out.still.push_back(f == 0 ? 0 : count_still(out.splats.back(), splats));
    out.splats.push_back(std::move(splats));
    out.seconds.push_back(watch.lap());
  }
  return out;
}

}  // namespace

bool are_trained(const EncoderSettings& settings, const std::vector<std::size_t>& points,
                 const LoadedFrame& first) {
  if (first.cameras.empty()) return false;
  if (settings.surface != Surface::kAuto) return settings.surface == Surface::kSplats;
  EncoderSettings plain = settings;  // what a step and a grid are for splats too
  plain.q = kAutomaticQ;
  plain.grid_bits = 0;
  plain.voxel_size = 0;
  if (!may_be_splats(plain)) return false;
  const bool none = std::all_of(points.begin(), points.end(), [](std::size_t n) { return n == 0; });
  return none || (training_obstacle(first.capture, first.cameras).empty() &&
                  !is_dense(first.capture, first.cameras));
}

Result<EncodedFrames, InputError> encode_trained_frames(std::size_t frames, const LoadFrame& load,
                                                        const EncoderSettings& settings,
                                                        const FrameSettings& frame_settings,
                                                        const TakeFrame& take,
                                                        const Progress& progress) {
  SLF_TRY(TrainedFrames trained, trained_frames(frames, load, settings, progress));
  EncoderSettings coding = coding_of_splats(settings);
  coding.metadata.insert(coding.metadata.begin(), trained.metadata.begin(), trained.metadata.end());
  SLF_TRY(
      EncodedFrames encoded,
      encode_gaussian_frames(
          frames, [&](std::size_t f) -> Result<Gaussians, InputError> { return trained.splats[f]; },
          coding, frame_settings, take, progress, trained.origin));
  encoded.trained = true;
  for (std::size_t f = 0; f < encoded.frames.size(); ++f) {
    encoded.frames[f].held = trained.still[f];
    encoded.frames[f].seconds += trained.seconds[f];
  }
  return encoded;
}

}  // namespace slf
