// SPDX-License-Identifier: Apache-2.0
#include "tools/frame_loader.h"

#include "tools/encode_splats.h"
#include "tools/frame_places.h"
#include "tools/text.h"

namespace slf::tools {

template <class T>
Result<T, InputError> FrameLoader::kept(Result<T, Failure> loaded) {
  if (!loaded) {
    failure_ = loaded.error();
    return InputError{Errc::kInvalidInput, failure_->message};
  }
  loaded_ = true;
  return *std::move(loaded);
}

LoadFrame FrameLoader::captures() {
  return [this](std::size_t f) -> Result<LoadedFrame, InputError> {
    SLF_TRY(CaptureInput input, kept(load_capture_of(inputs_.frames[f])));
    return LoadedFrame{std::move(input.capture), std::move(input.cameras)};
  };
}

LoadGaussians FrameLoader::splats() {
  return [this](std::size_t f) -> Result<Gaussians, InputError> {
    if (inputs_.frames[f].is_empty) return Gaussians{};
    return kept(load_splats_of(inputs_.frames[f]));
  };
}

LoadPlenoptic FrameLoader::views() {
  return [this](std::size_t f) -> Result<PlenopticCloud, InputError> {
    if (inputs_.frames[f].is_empty) return PlenopticCloud{};
    return kept(load_views_of(inputs_.frames[f]));
  };
}

Result<CaptureInput, Failure> FrameLoader::load_capture_of(const FrameInput& frame) {
  EncodeOptions options = given_;
  options.capture = frame.path.string();
  options.frame = frame;
  options.common.quiet = given_.common.quiet || loaded_;
  options.points = file_of_frame(given_.points, frame);
  SLF_TRY(options.images, images_of_frame(given_.images, frame));
  SLF_TRY(CaptureInput input, load_input(options, line_, PointsWanted::kOrNone));
  const PointCloud& cloud = input.capture.cloud;
  if (input.cameras.empty() && !cloud.positions.empty() && cloud.colours.empty())
    return Failure{kInputInvalid, options.capture +
                                      ": the frame has no cameras and its points have no "
                                      "colours"};
  return input;
}

Result<Gaussians, Failure> FrameLoader::load_splats_of(const FrameInput& frame) {
  EncodeOptions options = given_;
  options.common.quiet = given_.common.quiet || loaded_;
  const std::string file = frame.path.string();
  SLF_TRY(GaussianFile splats, wanted_splats(options, file));
  const Gaussians& g = splats.gaussians;
  if (!kind_) kind_ = Kind{frame.name(), g.degree, g.up};
  if (g.degree != kind_->degree)
    return Failure{kInputInvalid, file + ": splats have harmonics of degree " +
                                      std::to_string(g.degree) + ", in " + kind_->file +
                                      " of degree " + std::to_string(kind_->degree)};
  if (g.up != kind_->up)
    return Failure{kInputInvalid, file + ": another axis is up than in " + kind_->file +
                                      "; --up says it for all frames"};
  return std::move(splats.gaussians);
}

Result<PlenopticCloud, Failure> FrameLoader::load_views_of(const FrameInput& frame) {
  const std::string file = frame.path.string();
  PlenopticOptions options;
  options.views = views_;
  options.one_of_several = true;
  std::vector<std::string> warnings;
  SLF_TRY(PlenopticCloud cloud, from(file, read_plenoptic(file, options, &warnings)));
  line_.clear();
  warn(warnings, given_.common.quiet || loaded_);
  if (like_) {
    auto same = check_same_views(*like_, cloud);
    if (!same) return Failure{kInputInvalid, file + ": " + same.error().message};
    return cloud;
  }
  PlenopticCloud points;
  std::swap(points.positions, cloud.positions);
  std::swap(points.colours, cloud.colours);
  like_ = cloud;
  cloud.positions = std::move(points.positions);
  cloud.colours = std::move(points.colours);
  return cloud;
}

}  // namespace slf::tools
