// SPDX-License-Identifier: Apache-2.0
// Encoding, on the C++ library.
#include "slf/encoder.h"

#include <cmath>
#include <functional>

#include "arrays.h"
#include "cameras.h"
#include "failure.h"
#include "module.h"
#include "slf/frame_inputs.h"
#include "slf/gaussian_files.h"
#include "slf/settings.h"

namespace slf::python {
namespace {

/// Calls a Python function, if there is one, and sees whether Python was interrupted. Either may
/// end what is going on: the exception is kept while the library is left without Python's lock.
class Reporter {
 public:
  explicit Reporter(const py::object& function) : function_(function) {}

  Progress progress() {
    return [this](const char* stage, double fraction) {
      const py::gil_scoped_acquire gil;
      try {
        if (!function_.is_none()) function_(stage, fraction);
        if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      } catch (const py::error_already_set&) {
        error_ = std::current_exception();
        throw Ended{};
      }
    };
  }

  /// What Python raised within call(), which is called without its lock.
  template <class Call>
  void run(const Call& call) const {
    try {
      const py::gil_scoped_release no_gil;
      call();
    } catch (const Ended&) {
      std::rethrow_exception(error_);
    }
  }

 private:
  struct Ended {};

  py::object function_;
  std::exception_ptr error_;
};

template <class T, std::size_t N>
void copy_rows(const Array<T>& from, std::vector<std::array<T, N>>& to) {
  to.resize(static_cast<std::size_t>(from.shape(0)));
  for (std::size_t i = 0; i < to.size(); ++i)
    for (std::size_t k = 0; k < N; ++k) to[i][k] = from.data()[N * i + k];
}

/// The mean, rounded: floats from there keep their digits.
Vec3 middle(const Array<double>& points) {
  Vec3 mean{0, 0, 0};
  const auto count = static_cast<std::size_t>(points.shape(0));
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t k = 0; k < 3; ++k) mean[k] += points.data()[3 * i + k] / double(count);
  for (double& c : mean) c = std::abs(c) > 1000 ? std::round(c) : 0;
  return mean;
}

Image image_of(const py::handle& given, const Camera& camera) {
  const auto array = array_of<std::uint8_t>(py::reinterpret_borrow<py::object>(given), "images");
  if (array.ndim() != 3 || array.shape(0) != camera.height || array.shape(1) != camera.width ||
      (array.shape(2) != 3 && array.shape(2) != 4))
    throw py::value_error("an image is uint8 [height, width, 3 or 4], as large as its camera says");
  Image image{camera.width, camera.height, static_cast<int>(array.shape(2)), {}};
  image.data.assign(array.data(), array.data() + array.size());
  return image;
}

Capture capture_of(const py::object& from) {
  Capture capture;
  const auto points = array_of<double>(from.attr("points"), "points");
  check_shape(points, {-1, 3}, "points");
  capture.origin = middle(points);
  for (py::ssize_t i = 0; i < points.shape(0); ++i)
    capture.cloud.positions.push_back({float(points.at(i, 0) - capture.origin[0]),
                                       float(points.at(i, 1) - capture.origin[1]),
                                       float(points.at(i, 2) - capture.origin[2])});
  if (const py::object given = from.attr("normals"); !given.is_none()) {
    const auto normals = array_of<float>(given, "normals");
    check_shape(normals, {points.shape(0), 3}, "normals");
    copy_rows(normals, capture.cloud.normals);
  }
  if (const py::object given = from.attr("colours"); !given.is_none()) {
    const auto colours = array_of<std::uint8_t>(given, "colours");
    check_shape(colours, {points.shape(0), 3}, "colours");
    copy_rows(colours, capture.cloud.colours);
  }
  for (const py::handle camera : from.attr("cameras"))
    capture.cameras.push_back(moved(camera_of(py::reinterpret_borrow<py::object>(camera)),
                                    {-capture.origin[0], -capture.origin[1], -capture.origin[2]}));
  std::size_t i = 0;
  for (const py::handle image : from.attr("images")) {
    if (i == capture.cameras.size()) throw py::value_error("there are more images than cameras");
    capture.images.push_back(image_of(image, capture.cameras[i++]));
  }
  if (i != capture.cameras.size()) throw py::value_error("there are more cameras than images");
  capture.image_files.resize(capture.cameras.size());
  capture.up = static_cast<UpAxis>(from.attr("up_index").cast<int>());
  return capture;
}

/// Names and values, by the table of settings.
EncoderSettings settings_of(const py::dict& options, int threads) {
  GivenSettings given;
  for (const auto& [name, value] : options)
    given.emplace_back(name.cast<std::string>(), value.cast<std::string>());
  EncoderSettings settings = value_of(settings_from(given));
  settings.threads = threads;
  return settings;
}

py::list settings_table() {
  using namespace py::literals;
  py::list table;
  for (const SettingInfo& s : encoder_settings())
    table.append(py::dict("name"_a = s.name, "low"_a = s.low, "high"_a = s.high,
                          "words"_a = s.words, "initial"_a = s.initial, "help"_a = s.help,
                          "flag"_a = s.kind == SettingInfo::kFlag));
  return table;
}

std::string what_is_wrong(const std::string& name, const std::string& value) {
  for (const SettingInfo& setting : encoder_settings())
    if (setting.name == name) return wrong_value(setting, value);
  return "is not a setting";
}

py::tuple encode_capture(const Capture& capture, const std::string& split, const py::dict& options,
                         int threads, const py::object& progress) {
  const EncoderSettings settings = settings_of(options, threads);
  Reporter reporter(progress);
  const Progress report = reporter.progress();
  Encoded encoded;
  reporter.run([&] {
    std::vector<int> cameras;
    if (!capture.cameras.empty()) cameras = value_of(split_cameras(capture, split));
    encoded = value_of(encode(capture, cameras, settings, report));
  });
  using namespace py::literals;
  return py::make_tuple(
      bytes_of(encoded.stream),
      py::dict("q"_a = encoded.q, "points"_a = encoded.points, "bits"_a = encoded.grid.bits,
               "step"_a = encoded.grid.step, "observations"_a = encoded.observations,
               "warnings"_a = encoded.warnings));
}

py::tuple encode_path(const std::string& path, const std::string& split, const py::dict& options,
                      int threads, const py::object& progress) {
  Capture capture;
  const auto refused = [&](const char* what) {
    return failure_of(InputError{Errc::kInvalidInput, path + what});
  };
  if (looks_like_gaussians(std::filesystem::path(path)))
    throw refused(": holds Gaussian splats, which the program codes: slf encode");
  if (holds_frames(path))
    throw refused(
        ": holds frames in time, which the program codes: slf encode; a frame of them is a "
        "capture");
  {
    const py::gil_scoped_release no_gil;
    capture = value_of(load_capture(path, {.points = {}, .points_needed = false}));
  }
  return encode_capture(capture, split, options, threads, progress);
}

py::bytes pack_arrays(const Array<std::int32_t>& positions, const py::object& components, int bits,
                      const Vec3& origin, double step, const py::object& steps,
                      const std::vector<int>& groups, const Metadata& metadata, int threads) {
  check_shape(positions, {-1, 3}, "positions");
  LightField field;
  copy_rows(positions, field.positions);
  field.header.grid = {origin, step, bits};
  field.header.has_basis = false;
  if (!components.is_none()) {
    const auto array = components.cast<Array<std::int32_t>>();
    check_shape(array, {positions.shape(0), -1, 3}, "components");
    field.header.num_functions = static_cast<int>(array.shape(1));
    field.components.assign(array.data(), array.data() + array.size());
  }
  CodingParameters parameters;
  parameters.group = groups;
  if (!steps.is_none()) {
    const auto array = steps.cast<Array<std::uint32_t>>();
    check_shape(array, {field.header.num_functions, 3}, "steps");
    copy_rows(array, parameters.step);
  }
  parameters.metadata = metadata;
  parameters.threads = threads;
  std::vector<std::uint8_t> stream;
  {
    const py::gil_scoped_release no_gil;
    stream = value_of(pack(field, parameters));
  }
  return bytes_of(stream);
}

}  // namespace

void add_encoding(py::module_& m) {
  m.def("settings", &settings_table);
  m.def("wrong_value", &what_is_wrong, py::arg("name"), py::arg("value"));
  m.def("encode_path", &encode_path, py::arg("path"), py::arg("split"), py::arg("options"),
        py::arg("threads"), py::arg("progress"));
  m.def(
      "encode_capture",
      [](const py::object& capture, const std::string& split, const py::dict& options, int threads,
         const py::object& progress) {
        return encode_capture(capture_of(capture), split, options, threads, progress);
      },
      py::arg("capture"), py::arg("split"), py::arg("options"), py::arg("threads"),
      py::arg("progress"));
  m.def("pack", &pack_arrays, py::arg("positions"), py::arg("components"), py::arg("bits"),
        py::arg("origin"), py::arg("step"), py::arg("steps"), py::arg("groups"),
        py::arg("metadata"), py::arg("threads"));
}

}  // namespace slf::python
