// SPDX-License-Identifier: Apache-2.0
// Captures or clouds of several instants to one stream.
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "base/input_error.h"
#include "base/stopwatch.h"
#include "bitstream/units.h"
#include "capture/photograph_size.h"
#include "capture/voxelise.h"
#include "encoder/check_frame_run.h"
#include "encoder/check_settings.h"
#include "encoder/choose_step.h"
#include "encoder/coding_parameters.h"
#include "encoder/encode_trained_frames.h"
#include "encoder/fit_capture.h"
#include "encoder/frames_to_bitrate.h"
#include "encoder/still_points.h"
#include "slf/frames.h"

namespace slf {
namespace {

InputError of_frames(const std::string& what) {
  return {Errc::kInvalidArgument, "frames: " + what};
}

/// What clouds and photographs of frames have, beyond what all frames have.
Result<Done, InputError> check_frames(std::size_t frames, const EncoderSettings& s,
                                      const FrameSettings& f) {
  SLF_CHECK(check_frame_run(frames, s, f));
  if (s.match_exposure == MatchExposure::kOn) return of_frames("exposure is not matched over them");
  if (s.refine_cameras == RefineCameras::kOn) return of_frames("poses are not refined over them");
  if (s.densify.mode == Densify::kOn) return of_frames("no points are made up");
  if (s.surface != Surface::kGiven && s.surface != Surface::kAuto && s.surface != Surface::kSplats)
    return of_frames("their points are coded as given, not mended, or splats are trained");
  if (f.parts > 1 && f.hold_over_groups)
    return of_frames("parts hold still points within groups alone");
  return Done{};
}

/// In the world, double: the origins of captures may differ.
Box box_in_world(const Capture& capture) {
  Box box;
  for (std::size_t i = 0; i < capture.cloud.positions.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const double x = capture.origin[k] + double{capture.cloud.positions[i][k]};
      box.min[k] = i == 0 ? x : std::min(box.min[k], x);
      box.max[k] = i == 0 ? x : std::max(box.max[k], x);
    }
  return box;
}

/// The grid of all frames: its step is the first frame's.
class SharedGrid {
 public:
  Result<Done, InputError> add(const LoadedFrame& frame, const EncoderSettings& settings) {
    const PointCloud& cloud = frame.capture.cloud;
    if (cloud.positions.empty()) return Done{};
    const Box box = box_in_world(frame.capture);
    if (points_ == 0) {
      const bool automatic = settings.grid_bits == 0 && settings.voxel_size == 0;
      bits_ = settings.grid_bits;
      step_ =
          automatic ? choose_density(frame.capture, frame.cameras).voxel_size : settings.voxel_size;
      box_ = box;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      box_.min[k] = std::min(box_.min[k], box.min[k]);
      box_.max[k] = std::max(box_.max[k], box.max[k]);
    }
    points_ += cloud.positions.size();
    return Done{};
  }
  Result<Grid, InputError> grid() const {
    if (points_ == 0)
      return invalid_input(
          "frames: none has points; photographs train splats of them by --surface splats, or by "
          "themselves from --effort 4 on");
    return choose_grid(box_, points_, bits_, step_);
  }

 private:
  Box box_;
  std::size_t points_ = 0;
  int bits_ = 0;
  double step_ = 0;
};

/// The points of a frame on the grid of all, which is given from the world's origin.
VoxelCloud frame_on_grid(const LoadedFrame& frame, const Grid& grid,
                         const EncoderSettings& settings) {
  const Capture& capture = frame.capture;
  PointCloud cloud = capture.cloud;
  if (cloud.normals.empty() && (!frame.cameras.empty() || settings.normal_bits > 0)) {
    std::vector<Vec3> viewpoints;
    for (const Camera& camera : capture.cameras) viewpoints.push_back(camera.centre());
    cloud.normals = estimate_normals(cloud, viewpoints, 16, settings.threads);
  }
  Vec3 back{};
  for (std::size_t k = 0; k < 3; ++k) back[k] = -capture.origin[k];
  VoxelCloud voxels = voxelise_on(cloud, moved(grid, back));
  voxels.grid = moved(grid, back);
  return voxels;
}

/// What the first frame chooses for those after it.
struct ChosenForAll {
  EncoderSettings settings;
  std::vector<int> shift;
  CodingParameters parameters;
  LightField empty;  ///< of no points, with the header of all
};

Result<LightField, InputError> light_field_of(const LoadedFrame& frame, const VoxelCloud& cloud,
                                              const EncoderSettings& given, bool chooses,
                                              std::optional<ChosenForAll>& chosen,
                                              const Progress& progress) {
  EncoderSettings settings = chosen ? chosen->settings : given;
  SLF_TRY(CaptureFit fit, frame.cameras.empty()
                              ? colours_alone(cloud)
                              : fit_capture(frame.capture, frame.cameras, cloud, settings, progress,
                                            chooses && !chosen));
  if (!frame.cameras.empty()) settings.fit = fit.chosen.settings;
  if (!chosen && settings.q == kAutomaticQ) {
    SLF_TRY(const StepAndOrigin step,
            choose_step(settings, fit, cloud.grid, cloud.positions.size(), frame.cameras.size()));
    settings.q = step.q;
  }
  LightField field = quantise_grid(cloud, std::move(fit), frame.capture.origin, frame.capture.up,
                                   settings, chosen ? chosen->shift : std::vector<int>{});
  if (!chosen) {
    LightField empty;
    empty.header = field.header;
    empty.normals.bits = field.normals.bits;
    chosen = ChosenForAll{settings, field.header.shift, coding_parameters(field, settings), empty};
    chosen->settings.search = FitSearch::none();
    chosen->settings.check_cameras = false;
  }
  return field;
}

/// The frames of an input, which can be coded as often as is asked for.
struct Sequence {
  std::size_t length;  // frames
  const LoadFrame& load;
  EncoderSettings settings;
  const FrameSettings& frames;
  Grid grid;
  bool clouds;          // no frame has cameras
  std::size_t chooser;  // the first frame with points: it chooses for all
  const Progress& progress;

  /// @param q  quantiser step, or kAutomaticQ
  Result<Done, InputError> code(double q, std::size_t first, std::size_t count,
                                const TakeFrame& take, EncodedFrames& encoded) const;
};

/// What the first frame with points chooses, where it is not the one that is coded first.
Result<Done, InputError> choose_for_all(const Sequence& sequence, const EncoderSettings& own,
                                        bool chooses, std::optional<ChosenForAll>& chosen) {
  SLF_TRY(const LoadedFrame frame, sequence.load(sequence.chooser));
  const VoxelCloud cloud = frame_on_grid(frame, sequence.grid, own);
  SLF_CHECK(light_field_of(frame, cloud, own, chooses, chosen, sequence.progress));
  return Done{};
}

Result<Done, InputError> Sequence::code(double q, std::size_t first, std::size_t count,
                                        const TakeFrame& take, EncodedFrames& encoded) const {
  EncoderSettings own = settings;
  own.q = q;
  const bool chooses = !clouds && q == kAutomaticQ;
  encoded.grid = grid;
  encoded.frames.clear();
  std::optional<ChosenForAll> chosen;
  if (first != chooser) SLF_CHECK(choose_for_all(*this, own, chooses, chosen));
  std::optional<FrameEncoder> encoder;
  StillPoints still;
  for (std::size_t f = first; f < first + count; ++f) {
    if (progress) progress("frames", static_cast<double>(f - first) / static_cast<double>(count));
    Stopwatch watch;
    SLF_TRY(const LoadedFrame frame, load(f));
    const bool empty = frame.capture.cloud.positions.empty();
    std::optional<LightField> field;
    if (empty) {
      field = chosen->empty;
    } else {
      const VoxelCloud cloud = frame_on_grid(frame, grid, own);
      SLF_TRY(field, light_field_of(frame, cloud, own, chooses, chosen, progress));
    }
    if (empty || (!frames.hold_over_groups && f % static_cast<std::size_t>(frames.group) == 0))
      still = {};
    std::size_t held = 0;
    if (frames.hold_still && !clouds && !empty) {
      SLF_CHECK(still.see(frame, own.threads));
      held = still.hold(frame, *field, own.threads);
    }
    if (!encoder) {
      encoded.q = chosen->settings.q;
      CodingParameters parameters = chosen->parameters;
      parameters.metadata = settings.metadata;
      encoder.emplace(parameters, frames.group, static_cast<std::uint32_t>(f));
    }
    SLF_TRY(const auto bytes, encoder->add(*field, static_cast<double>(f) / frames.rate));
    SLF_CHECK(take(f, bytes));
    encoded.frames.push_back({bytes.front() != kSignature.front(), field->num_points(), held,
                              bytes.size(), watch.lap()});
  }
  if (progress) progress("frames", 1);
  return Done{};
}

}  // namespace

Result<PlannedFrames, InputError> plan_frames(std::size_t frames, const LoadFrame& load,
                                              const EncoderSettings& settings,
                                              const FrameSettings& frame_settings,
                                              const Progress& progress) {
  SLF_CHECK(check_settings(settings));
  SLF_CHECK(check_frames(frames, settings, frame_settings));
  PlannedFrames plan;
  SharedGrid shared;
  std::optional<LoadedFrame> first;  // with points, if one has
  std::optional<std::size_t> bare;   // without a cloud
  for (std::size_t f = 0; f < frames; ++f) {
    if (progress) progress("load", static_cast<double>(f) / static_cast<double>(frames));
    SLF_TRY(LoadedFrame frame, load(f));
    SLF_CHECK(of_frame(f, check_capture(frame.capture, frame.cameras)));
    if (auto within = photographs_within(frame.capture, settings.photograph_pixels))
      frame.capture = *std::move(within);
    plan.points.push_back(frame.capture.cloud.positions.size());
    plan.cameras.push_back(frame.cameras.size());
    SLF_CHECK(shared.add(frame, settings));
    if (!bare && !frame.capture.has_geometry) bare = f;
    if (!first || (first->capture.cloud.positions.empty() && plan.points.back() > 0))
      first = std::move(frame);
  }
  plan.part = frames_of_part(frames, frame_settings);
  plan.trained = are_trained(settings, plan.points, *first);
  if (!plan.trained && settings.surface == Surface::kSplats)
    return of_frames("splats are trained by photographs, and there are none");
  if (plan.trained) {
    if (frame_settings.parts > 1)
      return of_frames(
          "splats of a frame go on from those of the one before, so there are no parts; "
          "--surface given has them, of frames with points");
    return plan;
  }
  SLF_TRY(plan.grid, shared.grid());
  if (bare)
    return of_frames("the one at place " + std::to_string(*bare) +
                     " has no point cloud, and others have");
  return plan;
}

Result<EncodedFrames, InputError> encode_frames(std::size_t frames, const LoadFrame& load_whole,
                                                const EncoderSettings& given,
                                                const FrameSettings& frame_settings,
                                                const TakeFrame& take, const Progress& progress) {
  const LoadFrame load = [&](std::size_t f) -> Result<LoadedFrame, InputError> {
    SLF_TRY(LoadedFrame frame, load_whole(f));
    if (auto within = photographs_within(frame.capture, given.photograph_pixels))
      frame.capture = *std::move(within);
    return frame;
  };
  SLF_TRY(const PlannedFrames plan, plan_frames(frames, load, given, frame_settings, progress));
  if (plan.trained)
    return encode_trained_frames(frames, load, given, frame_settings, take, progress);
  Sequence sequence{frames, load, given, frame_settings, plan.grid, false, 0, progress};
  sequence.settings.observe.threads = sequence.settings.fit.threads = given.threads;
  while (plan.points[sequence.chooser] == 0) ++sequence.chooser;
  for (std::size_t f = 0; f < frames; ++f)
    if (plan.points[f] > 0) sequence.clouds = plan.cameras[f] == 0;
  if (sequence.clouds) fit_colours_alone(sequence.settings);
  const auto [first, count] = plan.part;
  EncodedFrames encoded;
  const RateJob job{frames,
                    sequence.chooser,
                    frame_settings,
                    given.target_bitrate,
                    kPlainQ,
                    [&](double q, std::size_t from, std::size_t many, const TakeFrame& to,
                        EncodedFrames& out) { return sequence.code(q, from, many, to, out); }};
  SLF_CHECK(given.target_bitrate > 0
                ? code_to_bitrate(job, take, encoded)
                : sequence.code(sequence.settings.q, first, count, take, encoded));
  return encoded;
}

}  // namespace slf
