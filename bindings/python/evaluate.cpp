// SPDX-License-Identifier: Apache-2.0
// Quality against photographs, by the library's one definition.
#include "slf/evaluate.h"

#include <algorithm>
#include <memory>
#include <sstream>

#include "captures.h"
#include "decoding.h"
#include "failure.h"
#include "module.h"
#include "reporter.h"
#include "slf/gaussian_renderer.h"

namespace slf::python {
namespace {

/// Points of the field in place of those that the capture does not have.
void add_points(const LightField& field, Capture& capture) {
  const Vec3 from = capture.origin, to = field.header.grid.origin;
  for (const Voxel& voxel : field.positions) {
    const Vec3 at = field.header.grid.world(voxel);
    capture.cloud.positions.push_back(
        {float(at[0] - to[0]), float(at[1] - to[1]), float(at[2] - to[2])});
  }
  for (Camera& camera : capture.cameras)
    camera = moved(std::move(camera), {from[0] - to[0], from[1] - to[1], from[2] - to[2]});
  capture.origin = to;
}

std::string value_in(const Metadata& metadata, const std::string& key) {
  for (const auto& [name, value] : metadata)
    if (name == key) return value;
  return {};
}

/// What the file was made from, and what it was not.
struct Sets {
  std::vector<int> input, held_out;
};

Sets sets_of(const Capture& capture, const Metadata& metadata, const std::string& split) {
  Sets sets;
  sets.input =
      value_of(split_cameras(capture, split.empty() ? value_in(metadata, "split") : split));
  if (split.empty()) {
    std::istringstream dropped(value_in(metadata, "cameras_dropped"));
    for (int camera = 0; dropped >> camera;) std::erase(sets.input, camera);
  }
  sets.held_out = value_of(split_cameras(capture, "evaluation"));
  std::erase_if(sets.held_out, [&](int i) {
    return std::find(sets.input.begin(), sets.input.end(), i) != sets.input.end();
  });
  return sets;
}

py::object pictures_dict(const Quality& quality, bool images) {
  using namespace py::literals;
  if (!images) return py::none();
  const ImageQuality& i = quality.image;
  return py::dict("psnr"_a = i.psnr, "ssim"_a = i.ssim, "ms_ssim"_a = i.ms_ssim,
                  "psnr_all"_a = i.all.psnr, "coverage"_a = i.coverage,
                  "off_pixels"_a = i.off_pixels, "psnr_each"_a = py::tuple(py::cast(i.psnr_each)));
}

py::object quality_dict(const std::optional<Quality>& quality, std::size_t cameras, bool images) {
  using namespace py::literals;
  if (!quality) return py::none();
  py::list points;
  for (const PointQuality& p : quality->points)
    points.append(py::dict(
        "delta"_a = p.delta_degrees, "psnr"_a = p.psnr, "luma_psnr"_a = p.luma_psnr,
        "channel_psnr"_a = py::tuple(py::cast(p.channel_psnr)), "observations"_a = p.observations));
  return py::dict("cameras"_a = cameras, "points"_a = points,
                  "image"_a = pictures_dict(*quality, images));
}

/// What a decoded file is judged by.
class Judge {
 public:
  Judge(const LightField& field, const Capture& capture, const EvaluateSettings& settings)
      : capture_(capture), settings_(settings) {
    if (!field.header.has_basis)
      throw failure_of(InputError{Errc::kInvalidInput, "holds planes without a basis: no colours"});
    if (!has_gaussians(field.header)) {
      maps_ = std::make_unique<ViewMaps>(field, settings.threads);
      return;
    }
    splats_ = std::make_unique<Gaussians>(value_of(gaussians_of(field, settings.threads)));
    RenderSettings over_black;
    over_black.background = {0, 0, 0};
    over_black.threads = 1;
    renderer_ = std::make_unique<GaussianRenderer>(*splats_, over_black);
  }
  std::optional<Quality> judged(const std::vector<int>& cameras, const Progress& progress) const {
    if (cameras.empty()) return std::nullopt;
    if (maps_) return value_of(evaluate(*maps_, capture_, cameras, settings_, progress));
    const DrawPicture draw = [this](const Camera& camera) { return renderer_->render(camera); };
    return value_of(evaluate_pictures(draw, capture_, cameras, settings_, progress));
  }

 private:
  const Capture& capture_;
  const EvaluateSettings& settings_;
  std::unique_ptr<ViewMaps> maps_;
  std::unique_ptr<Gaussians> splats_;
  std::unique_ptr<GaussianRenderer> renderer_;
};

py::tuple evaluate_file(const py::object& source, const py::object& given, const std::string& split,
                        const EvaluateSettings& settings, std::uint64_t max_memory,
                        const Metadata& metadata, const py::object& progress) {
  Capture capture;
  if (py::isinstance<py::str>(given)) {
    const auto path = given.cast<std::string>();
    const py::gil_scoped_release no_gil;
    capture = value_of(load_capture(path, {.points = {}, .points_needed = false}));
  } else {
    capture = capture_of(given);
  }
  const LightField field = decoded(source, Part{0, 0, 0, 0, {}, settings.threads, max_memory});
  if (capture.cloud.positions.empty()) add_points(field, capture);
  const Sets sets = sets_of(capture, metadata, split);
  std::optional<Quality> input, held_out;
  Reporter reporter(progress);
  const Progress report = reporter.progress();
  reporter.run([&] {
    const Judge judge(field, capture, settings);
    input = judge.judged(sets.input, report);
    held_out = judge.judged(sets.held_out, report);
  });
  return py::make_tuple(quality_dict(input, sets.input.size(), settings.images),
                        quality_dict(held_out, sets.held_out.size(), settings.images));
}

}  // namespace

void add_evaluation(py::module_& m) {
  m.def(
      "evaluate",
      [](const py::object& source, const py::object& capture, const std::string& split,
         const std::vector<double>& deltas, bool images, bool match_exposure, bool align_cameras,
         int threads, std::uint64_t max_memory, const Metadata& metadata,
         const py::object& progress) {
        EvaluateSettings settings;
        settings.deltas_degrees = deltas;
        settings.images = images;
        settings.match_exposure = match_exposure;
        settings.align_cameras = align_cameras;
        settings.threads = threads;
        return evaluate_file(source, capture, split, settings, max_memory, metadata, progress);
      },
      py::arg("source"), py::arg("capture"), py::arg("split"), py::arg("deltas"), py::arg("images"),
      py::arg("match_exposure"), py::arg("align_cameras"), py::arg("threads"),
      py::arg("max_memory"), py::arg("metadata"), py::arg("progress"));
}

}  // namespace slf::python
