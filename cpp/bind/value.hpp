#pragma once
// Plain structs as frozen Python values. Operations on all fields are written once, behind
// functions that know a field's type but not its struct. Templates for each struct and field made
// an eighth of the compiled extension.

#include <pybind11/eigen.h>
#include <pybind11/functional.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cstddef>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

namespace jointid::bind {

namespace py = pybind11;

template <class T, class M>
struct Field {
  const char* name;
  M T::* member;
  const char* text;  ///< unit and meaning, for the docstring
};
template <class T, class M>
Field(const char*, M T::*, const char*) -> Field<T, M>;

/// A field, accessed through functions of its type.
struct FieldAccess {
  const char* name;
  const char* text;
  const char* kind;       ///< accepted kind of value, for a message
  std::ptrdiff_t offset;  ///< [bytes] from the start of the struct
  py::object (*get)(const void* field);
  void (*set)(void* field, const py::handle& given);  ///< throws py::cast_error
  /// Stores the end of the type's range and returns it as text; null for a type without whole
  /// numbers.
  std::string (*extreme)(void* field, bool low);
};

struct ValueShape {
  const char* name;
  std::vector<FieldAccess> fields;
  void (*validate)(const void* value);
};

/// Sets these fields and validates. Do not use the value after an exception.
void change(const ValueShape& shape, void* value, const py::dict& changes);

py::dict fields_of(const ValueShape& shape, const void* value);

/// Name(field=value, ...)
std::string text_of(const ValueShape& shape, const void* value);

/// Returns the docstring: the text, then each field with its default.
std::string described(const ValueShape& shape, const void* defaults, std::string text);

/// The kind of value that a field of this type accepts, for a message.
template <class V>
constexpr const char* kind_of() {
  if constexpr (std::is_same_v<V, bool>) return "True or False is expected";
  if constexpr (std::is_integral_v<V>) return "a whole number is expected";
  if constexpr (std::is_floating_point_v<V>) return "a number is expected";
  return "it is of the wrong type";
}

template <class V>
FieldAccess access_to(const char* name, const char* text, std::ptrdiff_t offset) {
  FieldAccess access{name, text, kind_of<V>(), offset, nullptr, nullptr, nullptr};
  access.get = [](const void* field) { return py::cast(*static_cast<const V*>(field)); };
  access.set = [](void* field, const py::handle& given) {
    if (py::isinstance<py::bool_>(given) != std::is_same_v<V, bool>) throw py::cast_error();
    *static_cast<V*>(field) = given.cast<V>();
  };
  if constexpr (std::is_integral_v<V> && !std::is_same_v<V, bool>) {
    access.extreme = [](void* field, bool low) {
      using Limits = std::numeric_limits<V>;
      const V end = low ? Limits::min() : Limits::max();
      *static_cast<V*>(field) = end;
      return std::to_string(end);
    };
  }
  return access;
}

template <class T, class... M>
ValueShape shape_of(const char* name, const Field<T, M>&... fields) {
  const T defaults{};
  const auto offset = [&](const auto& member) {
    return reinterpret_cast<const std::byte*>(&member) -
           reinterpret_cast<const std::byte*>(&defaults);
  };
  return {name,
          {access_to<M>(fields.name, fields.text, offset(defaults.*fields.member))...},
          [](const void* value) { static_cast<const T*>(value)->validate(); }};
}

/// Binds a plain struct as a frozen Python value: keyword-only constructor that validates, replace,
/// asdict, repr, ==, hash, pickle.
template <class T, class... M>
py::class_<T> value(py::module_& m, const char* name, std::string text, Field<T, M>... fields) {
  static const ValueShape shape = shape_of(name, fields...);
  const T defaults{};
  py::class_<T> bound(m, name, described(shape, &defaults, std::move(text)).c_str());
  (bound.def_readonly(fields.name, fields.member, fields.text), ...);
  bound.def(py::init([](const py::kwargs& given) {
    T made{};
    change(shape, &made, given);
    return made;
  }));
  bound.def(
      "replace",
      [](const T& self, const py::kwargs& given) {
        T changed = self;
        change(shape, &changed, given);
        return changed;
      },
      "Return a copy with these fields changed.");
  const auto asdict = [](const T& self) { return fields_of(shape, &self); };
  bound.def("asdict", asdict, "Return the fields as a dictionary.");
  bound.def("__repr__", [](const T& self) { return text_of(shape, &self); });
  bound.def("__eq__", [](const T& self, const py::object& other) {
    return py::isinstance<T>(other) &&
           fields_of(shape, &self).equal(fields_of(shape, &other.cast<const T&>()));
  });
  bound.def("__hash__", [](const T& self) { return py::hash(py::str(text_of(shape, &self))); });
  bound.def(py::pickle(asdict, [](const py::dict& state) {
    T made{};
    change(shape, &made, state);
    return made;
  }));
  return bound;
}

}  // namespace jointid::bind
