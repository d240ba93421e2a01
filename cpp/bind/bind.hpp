#pragma once
// What all bindings share: the include set, frozen option values, and the way back into Python
// during long work.

#include <Python.h>
#include <pybind11/eigen.h>
#include <pybind11/functional.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <chrono>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include "base/input_error.hpp"
#include "bind/enumeration.hpp"

namespace jointid::bind {

namespace py = pybind11;

/// Raises the package's InputError; a value of null is not shown.
[[noreturn]] void refuse(const std::string& reason, const std::string& argument,
                         const py::handle& value = {});

template <class T, class M>
struct Field {
  const char* name;
  M T::* member;
  const char* text;  ///< unit and meaning, for the docstring
};
template <class T, class M>
Field(const char*, M T::*, const char*) -> Field<T, M>;

/// What a field of this type takes, for a message.
template <class V>
constexpr const char* kind_of() {
  if constexpr (std::is_same_v<V, bool>) return "True or False is expected";
  if constexpr (std::is_integral_v<V>) return "a whole number is expected";
  if constexpr (std::is_floating_point_v<V>) return "a number is expected";
  return "it is of the wrong type";
}

/// Refuses a Python integer that a field cannot hold, with the range that the struct's own check
/// names; with the range of the field's type where the check names none.
template <class V, class T>
[[noreturn]] void refuse_beyond(T target, V T::* member, const std::string& argument,
                                const py::handle& given) {
  using Limits = std::numeric_limits<V>;
  const bool low = py::reinterpret_borrow<py::object>(given) < py::int_(0);
  target.*member = low ? Limits::min() : Limits::max();
  try {
    target.validate();
  } catch (const base::InputError& error) {
    if (error.argument() == argument) refuse(error.reason(), argument, given);
  }
  refuse(low ? "must be at least " + std::to_string(Limits::min())
             : "must be at most " + std::to_string(Limits::max()),
         argument, given);
}

/// A plain struct as a frozen Python value: keyword-only constructor that validates, replace,
/// asdict, repr, ==, hash, pickle.
template <class T, class... M>
py::class_<T> value(py::module_& m, const char* name, std::string text, Field<T, M>... fields) {
  const T defaults{};
  const auto assign = [=](T& target, const std::string& key, const py::handle& given) {
    const auto one = [&](const auto& field) {
      if (key != field.name) return false;
      using V = std::remove_reference_t<decltype(target.*field.member)>;
      try {
        if (py::isinstance<py::bool_>(given) != std::is_same_v<V, bool>) throw py::cast_error();
        target.*field.member = given.cast<V>();
      } catch (const py::cast_error&) {
        if constexpr (std::is_integral_v<V> && !std::is_same_v<V, bool>) {
          if (PyLong_CheckExact(given.ptr())) {
            refuse_beyond(target, field.member, std::string(name) + "." + key, given);
          }
        }
        refuse(kind_of<V>(), std::string(name) + "." + key, given);
      }
      return true;
    };
    if (!(one(fields) || ...)) {
      std::string known;
      (known.append(known.empty() ? "" : ", ").append(fields.name), ...);
      refuse("no such field; fields are " + known, std::string(name) + "." + key);
    }
  };
  const auto with = [=](T target, const py::dict& changes) {
    for (const auto& item : changes) assign(target, std::string(py::str(item.first)), item.second);
    target.validate();
    return target;
  };
  const auto asdict = [=](const T& target) {
    py::dict result;
    ((result[fields.name] = target.*fields.member), ...);
    return result;
  };
  const auto as_text = [=](const T& target) {
    std::string inner;
    for (const auto& item : asdict(target)) {
      inner.append(inner.empty() ? "" : ", ").append(std::string(py::str(item.first))).append("=");
      inner.append(std::string(py::repr(item.second)));
    }
    return std::string(name).append("(").append(inner).append(")");
  };
  text += "\n\nParameters\n----------\n";
  (text.append(fields.name)
       .append(" : default ")
       .append(std::string(py::repr(py::cast(defaults.*fields.member))))
       .append("\n    ")
       .append(fields.text)
       .append("\n"),
   ...);
  py::class_<T> bound(m, name, text.c_str());
  (bound.def_readonly(fields.name, fields.member, fields.text), ...);
  bound.def(py::init([=](const py::kwargs& given) { return with(T{}, given); }));
  bound.def(
      "replace", [=](const T& self, const py::kwargs& given) { return with(self, given); },
      "A copy with the given fields changed.");
  bound.def("asdict", asdict, "The fields as a dictionary.");
  bound.def("__repr__", as_text);
  bound.def("__eq__", [=](const T& self, const py::object& other) {
    return py::isinstance<T>(other) && asdict(self).equal(asdict(other.cast<const T&>()));
  });
  bound.def("__hash__", [=](const T& self) { return py::hash(py::str(as_text(self))); });
  bound.def(py::pickle(asdict, [=](const py::dict& state) { return with(T{}, state); }));
  return bound;
}

/// Lets Python's signal handlers run (Ctrl-C) at most every 50 ms; called without the GIL.
class SignalPoll {
 public:
  void operator()() {
    const auto now = std::chrono::steady_clock::now();
    if (now - last_ < std::chrono::milliseconds(50)) return;
    last_ = now;
    const py::gil_scoped_acquire gil;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

void bind_input_error();
void bind_distributions(py::module_& m);
void bind_terms(py::module_& m);
void bind_recording(py::module_& m);
void bind_penalty(py::module_& m);
void bind_genetic(py::module_& m);
void bind_search(py::module_& m);
void bind_online(py::module_& m);
void bind_diagnose(py::module_& m);
void bind_signals(py::module_& m);
void bind_shifts(py::module_& m);
void bind_regression(py::module_& m);
void bind_simulate(py::module_& m);
void bind_text(py::module_& m);
void bind_design(py::module_& m);

}  // namespace jointid::bind
