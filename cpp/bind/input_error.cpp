#include "base/input_error.hpp"

#include "bind/bind.hpp"

namespace jointid::bind {

namespace {

/// Sets Python's error. The class is imported only here, because its package imports this module.
void set_error(const std::string& reason, const std::string& argument, const py::handle& value) {
  const py::object error = py::module_::import("jointid.base.errors").attr("InputError");
  py::dict keywords;
  keywords["argument"] = argument;
  if (value) keywords["value"] = value;
  PyErr_SetObject(error.ptr(), error(reason, **keywords).ptr());
}

py::object object_of(const base::InputError::Value& value) {
  return std::visit(
      [](const auto& known) -> py::object {
        if constexpr (std::is_same_v<std::remove_cvref_t<decltype(known)>, std::monostate>) {
          return {};
        } else {
          return py::cast(known);
        }
      },
      value);
}

}  // namespace

void refuse(const std::string& reason, const std::string& argument, const py::handle& value) {
  set_error(reason, argument, value);
  throw py::error_already_set();
}

void bind_input_error() {
  // Other exceptions of the core are bugs. They pass on to pybind11's own translators.
  py::register_local_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const base::InputError& error) {
      set_error(error.reason(), error.argument(), object_of(error.value()));
    }
  });
}

}  // namespace jointid::bind
