// SPDX-License-Identifier: Apache-2.0
// Frames of a light field that moves, on the C interface alone.
#include <atomic>
#include <memory>
#include <mutex>

#include "contents.h"
#include "fields.h"

namespace slf::python {
namespace {

struct ReleaseFrames {
  void operator()(slf_frames* frames) const { slf_release_frames(frames); }
};

/// All frames of a stream in memory.
class Frames {
 public:
  Frames(const py::object& source, const Part& part) : view_(std::make_shared<BytesView>(source)) {
    const slf_options options = options_of(part, ended_);
    slf_error error = SLF_ERROR_INIT;
    slf_frames* frames = nullptr;
    check(slf_open_frames(&options, nullptr, &frames, &error), error);
    frames_.reset(frames);
    slf_code code;
    {
      const py::gil_scoped_release no_gil;
      code = slf_frames_push(frames, view_->bytes().data(), view_->bytes().size(), &error);
      if (code == SLF_OK) code = slf_frames_finish(frames, &error);
    }
    check(code, error);
  }

  std::size_t count() const { return slf_frames_count(frames_.get()); }

  py::dict info(std::size_t place) const {
    const slf_frame f = get(place);
    using namespace py::literals;
    return py::dict("number"_a = f.number, "time"_a = f.time, "predicted"_a = f.predicted != 0,
                    "lost"_a = f.lost != 0, "offset"_a = f.offset, "bytes"_a = f.bytes);
  }

  /// Headers are those of the frame that its group begins with.
  Field decode(std::size_t place) {
    return {stream_of_group(place), ended_, [&](slf_field** field, slf_error* error) {
              const std::lock_guard one_at_a_time(mutex_);
              ended_ = false;
              return slf_frames_decode(frames_.get(), place, field, error);
            }};
  }

 private:
  slf_frame get(std::size_t place) const {
    slf_frame frame{};
    frame.size = sizeof frame;
    slf_error error = SLF_ERROR_INIT;
    check(slf_frames_get(frames_.get(), place, &frame, &error), error);
    return frame;
  }

  /// A lost frame has none: its decode says why.
  std::shared_ptr<const Stream> stream_of_group(std::size_t place) const {
    slf_frame first = get(place);
    while (first.predicted != 0 && place > 0) first = get(--place);
    if (first.lost != 0) return nullptr;
    return std::make_shared<Stream>(view_,
                                    view_->bytes().subspan(static_cast<std::size_t>(first.offset),
                                                           static_cast<std::size_t>(first.bytes)));
  }

  std::shared_ptr<const BytesView> view_;
  std::mutex mutex_;  // Python's lock is given up while a frame is decoded
  std::atomic<bool> ended_ = false;
  std::unique_ptr<slf_frames, ReleaseFrames> frames_;
};

}  // namespace

void add_frames(py::module_& m) {
  py::class_<Frames>(m, "Frames")
      .def(py::init([](const py::object& source, std::uint32_t levels, std::uint32_t groups,
                       const std::optional<std::array<int, 6>>& region, int threads,
                       std::uint64_t max_memory) {
             return std::make_unique<Frames>(
                 source, Part{levels, groups, 0, 0, region, threads, max_memory});
           }),
           py::arg("source"), py::arg("levels"), py::arg("groups"), py::arg("region"),
           py::arg("threads"), py::arg("max_memory"))
      .def("count", checked(&Frames::count))
      .def("info", checked(&Frames::info), py::arg("place"))
      .def("decode", checked(&Frames::decode), py::arg("place"));
}

}  // namespace slf::python
