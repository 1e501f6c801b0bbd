// SPDX-License-Identifier: Apache-2.0
// Rendering, on the C++ library: the C interface has no renderer.
#include "slf/render.h"

#include <atomic>
#include <memory>
#include <mutex>

#include "arrays.h"
#include "cameras.h"
#include "contents.h"
#include "decoding.h"
#include "failure.h"
#include "interrupts.h"
#include "module.h"
#include "slf/frames.h"
#include "slf/gaussian_renderer.h"

namespace slf::python {
namespace {

/// View maps and the discs of a field, or its splats.
class FieldRenderer {
 public:
  FieldRenderer(const LightField& field, int threads) : threads_(threads) {
    if (!field.header.has_basis)
      throw failure_of(InputError{Errc::kInvalidInput, "holds planes without a basis: no colours"});
    const py::gil_scoped_release no_gil;
    if (has_gaussians(field.header)) {
      splats_ = std::make_unique<Gaussians>(value_of(gaussians_of(field, threads)));
    } else {
      maps_ = std::make_unique<ViewMaps>(field, threads);
      discs_ = std::make_unique<Renderer>(*maps_, settings({128, 128, 128}, true));
    }
  }

  py::array_t<std::uint8_t> render(const py::object& camera,
                                   const std::array<std::uint8_t, 3>& background,
                                   bool view_dependent) const {
    const Camera view = camera_of(camera);
    Rendering rendering;
    std::atomic<bool> ended = false;
    run_interruptibly(ended, [&] {
      const RenderSettings wanted = settings(background, view_dependent);
      const bool same = view_dependent && background == std::array<std::uint8_t, 3>{128, 128, 128};
      rendering = splats_ ? GaussianRenderer(*splats_, wanted).render(view, &ended)
                  : same  ? discs_->render(view, &ended)
                          : Renderer(*maps_, wanted).render(view, &ended);
    });
    py::array_t<std::uint8_t> out({view.height, view.width, 3});
    std::copy(rendering.image.data.begin(), rendering.image.data.end(), out.mutable_data());
    return out;
  }

  py::dict orbit(double turn, double elevation, int width, int height, double fov) const {
    return dict_of(splats_ ? GaussianRenderer(*splats_).orbit(turn, elevation, width, height, fov)
                           : discs_->orbit(turn, elevation, width, height, fov));
  }

 private:
  RenderSettings settings(const std::array<std::uint8_t, 3>& background,
                          bool view_dependent) const {
    RenderSettings made;
    made.background = background;
    made.view_dependent = view_dependent;
    made.threads = threads_;
    return made;
  }

  int threads_;
  std::unique_ptr<ViewMaps> maps_;
  std::unique_ptr<Renderer> discs_;
  std::unique_ptr<Gaussians> splats_;
};

/// Pictures of frames, which are decoded again for them: in order each once.
class FramePictures {
 public:
  FramePictures(const py::object& source, const Part& part)
      : view_(source),
        threads_(part.threads),
        decoder_(value_of(FrameDecoder::open(view_.bytes(), decode_options(part, ended_)))) {}

  std::unique_ptr<FieldRenderer> renderer(std::size_t place) {
    LightField field;
    run_interruptibly(ended_, [&] {
      const std::lock_guard one_at_a_time(mutex_);
      ended_ = false;
      field = value_of(decoder_.decode(place));
    });
    return std::make_unique<FieldRenderer>(field, threads_);
  }

 private:
  BytesView view_;
  int threads_;
  std::mutex mutex_;
  std::atomic<bool> ended_ = false;
  FrameDecoder decoder_;
};

}  // namespace

void add_rendering(py::module_& m) {
  py::class_<FieldRenderer>(m, "Renderer")
      .def(py::init([](const py::object& source, std::uint32_t levels, std::uint32_t groups,
                       std::uint32_t layers, std::uint64_t max_bytes,
                       const std::optional<std::array<int, 6>>& region, int threads,
                       std::uint64_t max_memory) {
             return std::make_unique<FieldRenderer>(
                 decoded(source,
                         Part{levels, groups, layers, max_bytes, region, threads, max_memory}),
                 threads);
           }),
           py::arg("source"), py::arg("levels"), py::arg("groups"), py::arg("layers"),
           py::arg("max_bytes"), py::arg("region"), py::arg("threads"), py::arg("max_memory"))
      .def("render", checked(&FieldRenderer::render), py::arg("camera"), py::arg("background"),
           py::arg("view_dependent"))
      .def("orbit", checked(&FieldRenderer::orbit), py::arg("turn"), py::arg("elevation"),
           py::arg("width"), py::arg("height"), py::arg("fov"));
  py::class_<FramePictures>(m, "FramePictures")
      .def(py::init([](const py::object& source, std::uint32_t levels, std::uint32_t groups,
                       const std::optional<std::array<int, 6>>& region, int threads,
                       std::uint64_t max_memory) {
             return std::make_unique<FramePictures>(
                 source, Part{levels, groups, 0, 0, region, threads, max_memory});
           }),
           py::arg("source"), py::arg("levels"), py::arg("groups"), py::arg("region"),
           py::arg("threads"), py::arg("max_memory"))
      .def("renderer", checked(&FramePictures::renderer), py::arg("place"));
}

}  // namespace slf::python
