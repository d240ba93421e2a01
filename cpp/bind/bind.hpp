#pragma once
// Shared by all bindings: the includes, and the return into Python during long work.

#include <Python.h>
#include <pybind11/eigen.h>
#include <pybind11/functional.h>
#include <pybind11/native_enum.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <chrono>
#include <optional>
#include <string>
#include <utility>

#include "base/input_error.hpp"
#include "bind/value.hpp"

namespace jointid::bind {

namespace py = pybind11;

/// Raises the package's InputError. A null value is not shown.
[[noreturn]] void refuse(const std::string& reason, const std::string& argument,
                         const py::handle& value = {});

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
