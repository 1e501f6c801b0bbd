// SPDX-License-Identifier: Apache-2.0
// Progress of long work, told to Python, which may end it.
#pragma once

#include <pybind11/pybind11.h>

#include <exception>

#include "slf/capture.h"

namespace slf::python {

namespace py = pybind11;

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

}  // namespace slf::python
