// SPDX-License-Identifier: Apache-2.0
// Decoding, on the C interface alone.
#include <memory>
#include <optional>

#include "contents.h"
#include "fields.h"

namespace slf::python {
namespace {

std::shared_ptr<const Stream> open(const py::object& source) {
  if (RangesView::is(source)) return std::make_shared<Stream>(std::make_shared<RangesView>(source));
  return std::make_shared<Stream>(std::make_shared<BytesView>(source));
}

Field decode(const py::object& source, const Part& part) {
  const auto stream = open(source);
  std::atomic<bool> ended = false;
  const slf_options options = options_of(part, ended);
  return {stream, ended, [&](slf_field** field, slf_error* error) {
            return slf_decode(stream->get(), &options, field, error);
          }};
}

}  // namespace

void add_decoding(py::module_& m) {
  m.def(
      "info", [](const py::object& source) { return open(source)->info(); }, py::arg("source"));
  m.def("version", [] { return std::string(slf_version()); });
  py::class_<Field>(m, "Field")
      .def(py::init([](const py::object& source, std::uint32_t levels, std::uint32_t groups,
                       std::uint32_t layers, std::uint64_t max_bytes,
                       const std::optional<std::array<int, 6>>& region, int threads,
                       std::uint64_t max_memory) {
             return std::make_unique<Field>(decode(
                 source, Part{levels, groups, layers, max_bytes, region, threads, max_memory}));
           }),
           py::arg("source"), py::arg("levels"), py::arg("groups"), py::arg("layers"),
           py::arg("max_bytes"), py::arg("region"), py::arg("threads"), py::arg("max_memory"))
      .def("info", checked(&Field::info))
      .def("shape", checked(&Field::shape))
      .def("positions", checked(&Field::positions))
      .def("components", checked(&Field::components))
      .def("normals", checked(&Field::normals))
      .def("radii", checked(&Field::radii))
      .def("opacities", checked(&Field::opacities))
      .def("covariances", checked(&Field::covariances))
      .def("mean_colours", checked(&Field::mean_colours))
      .def("radiance", checked(&Field::radiance), py::arg("points"), py::arg("directions"));
}

}  // namespace slf::python
