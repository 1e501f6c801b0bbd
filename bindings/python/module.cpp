// SPDX-License-Identifier: Apache-2.0
#include "module.h"

#include "failure.h"

namespace py = pybind11;

namespace {

/// Sets the Python exception that slf._errors makes of a failure.
void raise(const slf::python::Failure& failure) {
  const py::object made = py::module_::import("slf._errors")
                              .attr("make")(failure.code, failure.message, failure.element,
                                            failure.unit, failure.bit_offset);
  PyErr_SetObject(reinterpret_cast<PyObject*>(Py_TYPE(made.ptr())), made.ptr());
}

}  // namespace

PYBIND11_MODULE(_slf, m) {
  py::register_exception_translator([](std::exception_ptr error) {
    try {
      if (error) std::rethrow_exception(error);
    } catch (const slf::python::Failure& failure) {
      raise(failure);
    }
  });
  slf::python::add_decoding(m);
  slf::python::add_frames(m);
  slf::python::add_rendering(m);
  slf::python::add_encoding(m);
  slf::python::add_files(m);
  slf::python::add_evaluation(m);
}
