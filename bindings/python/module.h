// SPDX-License-Identifier: Apache-2.0
// The extension module slf._slf. Python's own layer over it is slf/__init__.py.
#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <array>
#include <cstdint>
#include <optional>

namespace slf::python {

/// What of a stream is decoded: slf_options.
struct Part {
  std::uint32_t levels = 0, groups = 0, layers = 0;
  std::uint64_t max_bytes = 0;
  std::optional<std::array<int, 6>> region;  ///< voxels, low then high
  int threads = 0;                           ///< 0: all cores
  std::uint64_t max_memory = 0;              ///< bytes; 0: that of DecodeLimits
};

void add_decoding(pybind11::module_& m);
void add_frames(pybind11::module_& m);
void add_rendering(pybind11::module_& m);
void add_encoding(pybind11::module_& m);
void add_files(pybind11::module_& m);
void add_evaluation(pybind11::module_& m);

}  // namespace slf::python
