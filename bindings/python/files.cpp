// SPDX-License-Identifier: Apache-2.0
// Files made of files: shorter ones, splats, and what a page has beside the stream.
#include <cstdio>
#include <map>

#include "arrays.h"
#include "cameras.h"
#include "decoding.h"
#include "failure.h"
#include "module.h"
#include "reporter.h"
#include "slf/annotate.h"
#include "slf/gaussian_files.h"
#include "slf/jpeg.h"
#include "slf/notes.h"
#include "slf/render.h"
#include "slf/splats.h"
#include "slf/truncate.h"

namespace slf::python {
namespace {

py::bytes truncate_stream(const py::object& source, const Part& part) {
  const BytesView view(source);
  std::atomic<bool> ended = false;
  const DecodeOptions options = decode_options(part, ended);
  std::vector<std::uint8_t> kept;
  run_interruptibly(ended, [&] { kept = value_of(truncate(view.bytes(), options)); });
  return bytes_of(kept);
}

SplatFormat format_of(const std::string& name) {
  static const std::map<std::string, SplatFormat> all{
      {"ply", SplatFormat::kPly},   {"glb", SplatFormat::kGlb},   {"spz", SplatFormat::kSpz},
      {"spz3", SplatFormat::kSpz3}, {"spz4", SplatFormat::kSpz4}, {"sog", SplatFormat::kSog}};
  const auto found = all.find(name);
  if (found == all.end()) throw py::value_error("format is ply, glb, spz, spz3, spz4 or sog");
  return found->second;
}

SplatAxes axes_named(const std::string& name, SplatFormat format) {
  if (name == "auto") return axes_of(format);
  if (name == "world") return SplatAxes::kWorld;
  if (name == "y-up") return SplatAxes::kYUp;
  if (name == "y-down") return SplatAxes::kYDown;
  throw py::value_error("axes is auto, world, y-up or y-down");
}

/// @param origin  receives what positions are from, in the world
std::vector<std::uint8_t> splats_of(const LightField& field, SplatFormat format,
                                    const SplatSettings& settings, Vec3& origin) {
  if (!field.header.has_basis)
    throw failure_of(InputError{Errc::kInvalidInput, "holds planes without a basis: no colours"});
  if (has_gaussians(field.header)) {
    Gaussians gaussians = value_of(gaussians_of(field, settings.threads));
    keep_degree(gaussians, settings.degree);
    origin = gaussians.origin;
    return value_of(gaussian_file(std::move(gaussians), format, settings.threads));
  }
  const ViewMaps maps(field, settings.threads);
  const SplatCloud splats = value_of(make_splats(maps, settings));
  origin = splats.origin;
  return value_of(splat_file(splats, format, settings.threads));
}

/// As `slf export` does.
void warn_of_origin(const Vec3& origin) {
  if (origin == Vec3{0, 0, 0}) return;
  char text[200];
  std::snprintf(
      text, sizeof text,
      "positions are from %.17g, %.17g, %.17g of the world, since floats cannot hold them",
      origin[0], origin[1], origin[2]);
  if (PyErr_WarnEx(PyExc_UserWarning, text, 1) < 0) throw py::error_already_set();
}

py::bytes export_splats(const py::object& source, const Part& part, const std::string& format,
                        int degree, double size, const std::string& axes) {
  SplatSettings settings;
  settings.degree = degree;
  settings.size = size;
  settings.threads = part.threads;
  const SplatFormat wanted = format_of(format);
  settings.axes = axes_named(axes, wanted);
  const LightField field = decoded(source, part);
  std::vector<std::uint8_t> bytes;
  Vec3 origin{0, 0, 0};
  std::atomic<bool> ended = false;  // nobody looks at it: an interrupt waits for the splats
  run_interruptibly(ended, [&] { bytes = splats_of(field, wanted, settings, origin); });
  warn_of_origin(origin);
  return bytes_of(bytes);
}

py::bytes jpeg_of(const Array<std::uint8_t>& picture, int quality) {
  check_shape(picture, {-1, -1, 3}, "picture");
  Image image{static_cast<int>(picture.shape(1)), static_cast<int>(picture.shape(0)), 3, {}};
  image.data.assign(picture.data(), picture.data() + picture.size());
  return bytes_of(value_of(encode_jpeg(image, quality)));
}

/// The view that metadata names, or None.
py::object view_of(const Metadata& metadata, int up, int width, int height) {
  const auto camera = named_view(metadata, static_cast<UpAxis>(up), width, height);
  return camera ? py::object(dict_of(*camera)) : py::none();
}

}  // namespace

void add_files(py::module_& m) {
  m.def(
      "truncate",
      [](const py::object& source, std::uint32_t levels, std::uint32_t groups, std::uint32_t layers,
         std::uint64_t max_bytes, const std::optional<std::array<int, 6>>& region, int threads,
         std::uint64_t max_memory) {
        return truncate_stream(
            source, Part{levels, groups, layers, max_bytes, region, threads, max_memory});
      },
      py::arg("source"), py::arg("levels"), py::arg("groups"), py::arg("layers"),
      py::arg("max_bytes"), py::arg("region"), py::arg("threads"), py::arg("max_memory"));
  m.def(
      "export",
      [](const py::object& source, std::uint32_t levels, std::uint32_t groups, std::uint32_t layers,
         std::uint64_t max_bytes, const std::optional<std::array<int, 6>>& region, int threads,
         std::uint64_t max_memory, const std::string& format, int degree, double size,
         const std::string& axes) {
        return export_splats(source,
                             Part{levels, groups, layers, max_bytes, region, threads, max_memory},
                             format, degree, size, axes);
      },
      py::arg("source"), py::arg("levels"), py::arg("groups"), py::arg("layers"),
      py::arg("max_bytes"), py::arg("region"), py::arg("threads"), py::arg("max_memory"),
      py::arg("format"), py::arg("degree"), py::arg("size"), py::arg("axes"));
  m.def(
      "checked_notes",
      [](const std::string& file, const std::string& json) {
        return value_of(
            checked_notes(file, {reinterpret_cast<const std::uint8_t*>(json.data()), json.size()}));
      },
      py::arg("file"), py::arg("json"));
  m.def(
      "annotate",
      [](const py::object& source,
         const std::vector<std::pair<std::string, std::optional<std::string>>>& metadata,
         std::optional<double> metres) {
        const BytesView view(source);
        return bytes_of(value_of(annotate(view.bytes(), {metadata, metres})));
      },
      py::arg("source"), py::arg("metadata"), py::arg("metres_per_unit"));
  m.def("jpeg", &jpeg_of, py::arg("picture"), py::arg("quality"));
  m.def("named_view", &view_of, py::arg("metadata"), py::arg("up"), py::arg("width"),
        py::arg("height"));
}

}  // namespace slf::python
