// SPDX-License-Identifier: Apache-2.0
// Sources that are read in parts: objects with `size` and `read_at(offset, size)`, slf/_ranges.py.
#pragma once

#include <pybind11/pybind11.h>

#include <algorithm>
#include <cstdint>
#include <exception>
#include <span>
#include <string_view>
#include <utility>

namespace slf::python {

namespace py = pybind11;

class RangesView {
 public:
  explicit RangesView(py::object source)
      : source_(std::move(source)), size_(source_.attr("size").cast<std::uint64_t>()) {}
  ~RangesView() {
    const py::gil_scoped_acquire gil;
    source_ = py::object();
    failed_ = nullptr;
  }
  RangesView(const RangesView&) = delete;
  RangesView& operator=(const RangesView&) = delete;

  static bool is(const py::object& source) { return py::hasattr(source, "read_at"); }

  std::uint64_t size() const { return size_; }

  /// Called without Python's lock. False: it could not be read, rethrow() says why.
  bool read(std::uint64_t offset, std::span<std::uint8_t> to) {
    const py::gil_scoped_acquire gil;
    try {
      const auto bytes = source_.attr("read_at")(offset, to.size()).cast<py::bytes>();
      const auto given = static_cast<std::string_view>(bytes);
      if (given.size() != to.size()) return false;
      std::copy(given.begin(), given.end(), to.begin());
      return true;
    } catch (...) {
      failed_ = std::current_exception();
      return false;
    }
  }

  /// With Python's lock.
  void rethrow() {
    if (failed_) std::rethrow_exception(std::exchange(failed_, nullptr));
  }

 private:
  py::object source_;
  std::uint64_t size_;
  std::exception_ptr failed_;
};

}  // namespace slf::python
