// SPDX-License-Identifier: Apache-2.0
// numpy arrays and buffers.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace slf::python {

namespace py = pybind11;

template <class T>
using Array = py::array_t<T, py::array::c_style | py::array::forcecast>;

/// Bytes of any object that has them in one piece; kept alive, and unchangeable in size, as long as
/// this lives.
class BytesView {
 public:
  explicit BytesView(const py::object& source) {
    if (PyObject_GetBuffer(source.ptr(), &view_, PyBUF_SIMPLE) != 0) throw py::error_already_set();
  }
  ~BytesView() {
    const py::gil_scoped_acquire gil;
    PyBuffer_Release(&view_);
  }
  BytesView(const BytesView&) = delete;
  BytesView& operator=(const BytesView&) = delete;

  std::span<const std::uint8_t> bytes() const {
    return {static_cast<const std::uint8_t*>(view_.buf), static_cast<std::size_t>(view_.len)};
  }

 private:
  Py_buffer view_{};
};

/// ValueError where something cannot be read as numbers.
template <class T>
Array<T> array_of(const py::object& given, const char* name) {
  auto array = Array<T>::ensure(given);
  if (!array) throw py::value_error(std::string(name) + " is not an array of numbers");
  return array;
}

/// ValueError where an array is not of this shape; -1 is any.
inline void check_shape(const py::array& array, const std::vector<py::ssize_t>& shape,
                        const char* name) {
  bool fits = array.ndim() == static_cast<py::ssize_t>(shape.size());
  for (std::size_t i = 0; fits && i < shape.size(); ++i)
    fits = shape[i] < 0 || array.shape(static_cast<py::ssize_t>(i)) == shape[i];
  if (fits) return;
  std::string wanted;
  for (const py::ssize_t n : shape)
    wanted += (wanted.empty() ? "" : ", ") + (n < 0 ? std::string("N") : std::to_string(n));
  std::string given;
  for (py::ssize_t i = 0; i < array.ndim(); ++i)
    given += (i == 0 ? "" : ", ") + std::to_string(array.shape(i));
  throw py::value_error(std::string(name) + " has the shape [" + given + "], not [" + wanted + "]");
}

inline py::bytes bytes_of(const std::vector<std::uint8_t>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace slf::python
