#pragma once
// Enumerations cross the border as members of Python's own Enum. pybind11's native_enum does the
// same, but it reads the name of the base class by a stream, and with that a wheel that brings its
// C++ library with it brings all locales (.3 MB of objects).
// All bindings see the casters below, so that none converts one of these types in another way.

#include <pybind11/pybind11.h>

#include <initializer_list>
#include <utility>

namespace jointid::diagnose {
enum class SpikeRule;
}
namespace jointid::identify {
enum class Control;
enum class Hold;
enum class Residual;
}  // namespace jointid::identify
namespace jointid::search {
enum class Stop;
}

namespace jointid::bind {

namespace py = pybind11;

/// How a docstring's signature shows the type.
template <class Choice>
inline constexpr auto kShown = py::detail::const_name("enum.Enum");
template <>
inline constexpr auto kShown<diagnose::SpikeRule> =
    py::detail::const_name("jointid._core.SpikeRule");
template <>
inline constexpr auto kShown<identify::Control> = py::detail::const_name("jointid._core.Control");
template <>
inline constexpr auto kShown<identify::Hold> = py::detail::const_name("jointid._core.Hold");
template <>
inline constexpr auto kShown<identify::Residual> = py::detail::const_name("jointid._core.Residual");
template <>
inline constexpr auto kShown<search::Stop> = py::detail::const_name("jointid._core.Stop");

template <class Choice>
struct EnumerationCaster {
  PYBIND11_TYPE_CASTER(Choice, kShown<Choice>);

  bool load(py::handle given, bool) {
    if (!kind() || !py::isinstance(given, kind())) return false;
    value = static_cast<Choice>(given.attr("value").cast<int>());
    return true;
  }
  static py::handle cast(Choice choice, py::return_value_policy, py::handle) {
    return kind()(static_cast<int>(choice)).release();
  }
  /// The Python class; it lives as long as the process, as the classes of pybind11 do.
  static py::handle& kind() {
    static py::handle made;
    return made;
  }
};

/// Makes the Python class in the module.
template <class Choice>
void enumeration(py::module_& m, const char* name, const char* text,
                 std::initializer_list<std::pair<const char*, Choice>> members) {
  py::list listed;
  for (const auto& [word, choice] : members) {
    listed.append(py::make_tuple(word, static_cast<int>(choice)));
  }
  py::object made = py::module_::import("enum").attr("Enum")(
      name, listed, py::arg("module") = m.attr("__name__"));
  made.attr("__doc__") = text;
  m.attr(name) = made;
  EnumerationCaster<Choice>::kind() = made.release();
}

}  // namespace jointid::bind

namespace pybind11::detail {
template <>
struct type_caster<jointid::diagnose::SpikeRule>
    : jointid::bind::EnumerationCaster<jointid::diagnose::SpikeRule> {};
template <>
struct type_caster<jointid::identify::Control>
    : jointid::bind::EnumerationCaster<jointid::identify::Control> {};
template <>
struct type_caster<jointid::identify::Hold>
    : jointid::bind::EnumerationCaster<jointid::identify::Hold> {};
template <>
struct type_caster<jointid::identify::Residual>
    : jointid::bind::EnumerationCaster<jointid::identify::Residual> {};
template <>
struct type_caster<jointid::search::Stop>
    : jointid::bind::EnumerationCaster<jointid::search::Stop> {};
}  // namespace pybind11::detail
