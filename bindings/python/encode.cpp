// SPDX-License-Identifier: Apache-2.0
// Encoding, on the C++ library.
#include "slf/encoder.h"

#include "arrays.h"
#include "captures.h"
#include "failure.h"
#include "inputs.h"
#include "module.h"
#include "reporter.h"
#include "slf/frame_inputs.h"
#include "slf/gaussian_files.h"
#include "slf/input_cameras.h"
#include "slf/settings.h"

namespace slf::python {
namespace {

/// Names and values, by the table of settings.
GivenSettings given_settings(const py::dict& options) {
  GivenSettings given;
  for (const auto& [name, value] : options)
    given.emplace_back(name.cast<std::string>(), value.cast<std::string>());
  return given;
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

/// What encode() of Python has beside the capture.
struct Wanted {
  std::string split;
  py::dict options;
  Metadata metadata;  ///< behind that of the input
  int threads = 0;
  py::object progress;
};

/// @param path  of the capture; empty: it was in memory
py::tuple encode_capture(const Capture& capture, const std::string& path, const Wanted& wanted) {
  const GivenSettings given = given_settings(wanted.options);
  EncoderSettings settings = value_of(settings_from(given));
  settings.threads = wanted.threads;
  std::vector<int> cameras = value_of(input_cameras(capture, wanted.split));
  check_photographs(cameras, given);
  std::vector<std::string> warnings = capture.warnings;
  settings.metadata = input_metadata(capture, cameras, wanted.split, path);
  settings.metadata.insert(settings.metadata.end(), wanted.metadata.begin(), wanted.metadata.end());
  Reporter reporter(wanted.progress);
  const Progress report = reporter.progress();
  Encoded encoded;
  reporter.run([&] {
    std::string empty = value_of(leave_out_empty_inputs(capture, wanted.threads, cameras));
    if (!empty.empty()) warnings.push_back(std::move(empty));
    encoded = value_of(encode(capture, cameras, settings, report));
  });
  warnings.insert(warnings.end(), encoded.warnings.begin(), encoded.warnings.end());
  using namespace py::literals;
  return py::make_tuple(bytes_of(encoded.stream),
                        py::dict("q"_a = encoded.q, "points"_a = encoded.points,
                                 "bits"_a = encoded.grid.bits, "step"_a = encoded.grid.step,
                                 "observations"_a = encoded.observations, "warnings"_a = warnings));
}

py::tuple encode_path(const std::string& path, const Wanted& wanted) {
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
  return encode_capture(capture, path, wanted);
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
  m.def(
      "encode_path",
      [](const std::string& path, const std::string& split, const py::dict& options,
         const Metadata& metadata, int threads, const py::object& progress) {
        return encode_path(path, {split, options, metadata, threads, progress});
      },
      py::arg("path"), py::arg("split"), py::arg("options"), py::arg("metadata"),
      py::arg("threads"), py::arg("progress"));
  m.def(
      "encode_capture",
      [](const py::object& capture, const std::string& split, const py::dict& options,
         const Metadata& metadata, int threads, const py::object& progress) {
        return encode_capture(capture_of(capture), "",
                              {split, options, metadata, threads, progress});
      },
      py::arg("capture"), py::arg("split"), py::arg("options"), py::arg("metadata"),
      py::arg("threads"), py::arg("progress"));
  m.def("pack", &pack_arrays, py::arg("positions"), py::arg("components"), py::arg("bits"),
        py::arg("origin"), py::arg("step"), py::arg("steps"), py::arg("groups"),
        py::arg("metadata"), py::arg("threads"));
}

}  // namespace slf::python
