#include "encoder/encode_splats.h"

#include <string>
#include <utility>

#include "base/stopwatch.h"
#include "encoder/encode_metadata.h"
#include "slf/encode_gaussians.h"
#include "train/train_gaussians.h"

namespace slf {
namespace {

constexpr int kSplatIterations = 3000;

TrainGeometrySettings training_of(const EncoderSettings& settings, StartId start) {
  TrainGeometrySettings training;
  training.iterations = kSplatIterations;
  training.threads = settings.threads;
  training.seconds = settings.surface_seconds;
  training.photograph_bytes = double(settings.surface_memory) * (1 << 20);
  training.is_volume = start == StartId::kVolume;
  return training;
}

}  // namespace

Result<Encoded, InputError> encode_splats(const Capture& capture, StartId start,
                                          std::span<const int> cameras,
                                          const EncoderSettings& settings,
                                          const Progress& progress) {
  const std::string obstacle =
      cameras.empty() ? "there are no photographs" : training_obstacle(capture, cameras);
  if (!obstacle.empty())
    return InputError{Errc::kInvalidInput, "splats are trained by photographs: " + obstacle};
  Encoded out;
  out.surface.start = start;
  out.surface.kept = Surface::kSplats;
  out.surface.points_before = capture.cloud.positions.size();
  Stopwatch watch;
  SLF_TRY(const Gaussians splats,
          train_gaussians(capture, cameras, training_of(settings, start), progress));
  out.surface.seconds_train = watch.lap();
  if (splats.size() == 0)
    return InputError{Errc::kInvalidInput, "photographs agree on nothing: no splat was left"};
  EncoderSettings coding = settings;
  coding.metadata.insert(coding.metadata.begin(), {{"surface", word_of(Surface::kSplats)},
                                                   {"cameras", std::to_string(cameras.size())}});
  if (progress) progress("code", 0);
  SLF_TRY(EncodedGaussians coded, encode_gaussians(splats, coding, capture.origin));
  out.stream = std::move(coded.stream);
  out.q = coded.q;
  out.grid = coded.grid;
  out.points = out.surface.points_after = out.surface.surfels = coded.splats;
  out.seconds_code = watch.lap();
  if (progress) progress("code", 1);
  return out;
}

}  // namespace slf
