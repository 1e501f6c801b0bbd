// SPDX-License-Identifier: Apache-2.0
// Methods of objects that Python can make without their contents, by cls.__new__(cls).
#pragma once

#include <pybind11/pybind11.h>

#include <string>
#include <utility>

namespace slf::python {

/// The T within a Python object. Pybind11 itself hands out uninitialised memory where __init__ did
/// not run.
/// @throws pybind11::type_error  another class, or an object without contents
template <class T>
T& contents_of(const pybind11::object& self) {
  const std::string name = pybind11::str(pybind11::type::of<T>().attr("__name__"));
  if (!pybind11::isinstance<T>(self)) throw pybind11::type_error("self is no " + name);
  auto* instance = reinterpret_cast<pybind11::detail::instance*>(self.ptr());
  auto held = instance->get_value_and_holder();
  if (!held.holder_constructed())
    throw pybind11::type_error(name + ": made without its contents, as __init__ did not run");
  return *static_cast<T*>(held.value_ptr());
}

/// A method whose `self` is checked.
template <class T, class R, class... A>
auto checked(R (T::*method)(A...)) {
  return [method](const pybind11::object& self, A... args) -> R {
    return (contents_of<T>(self).*method)(std::forward<A>(args)...);
  };
}

template <class T, class R, class... A>
auto checked(R (T::*method)(A...) const) {
  return [method](const pybind11::object& self, A... args) -> R {
    return (contents_of<T>(self).*method)(std::forward<A>(args)...);
  };
}

}  // namespace slf::python
