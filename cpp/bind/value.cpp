#include "bind/value.hpp"

#include "bind/bind.hpp"

namespace jointid::bind {

namespace {

void* place(const FieldAccess& field, void* value) {
  return static_cast<std::byte*>(value) + field.offset;
}

py::object read(const FieldAccess& field, const void* value) {
  return field.get(static_cast<const std::byte*>(value) + field.offset);
}

/// Refuses a Python integer that a field cannot hold. Names the range of the struct's own check, or
/// the range of the field's type if that check names none.
[[noreturn]] void refuse_beyond(const ValueShape& shape, const FieldAccess& field, void* value,
                                const std::string& argument, const py::handle& given) {
  const bool low = py::reinterpret_borrow<py::object>(given) < py::int_(0);
  const std::string end = field.extreme(place(field, value), low);
  try {
    shape.validate(value);
  } catch (const base::InputError& error) {
    if (error.argument() == argument) refuse(error.reason(), argument, given);
  }
  refuse((low ? "must be at least " : "must be at most ") + end, argument, given);
}

void assign(const ValueShape& shape, void* value, const std::string& key, const py::handle& given) {
  const std::string argument = std::string(shape.name) + "." + key;
  for (const FieldAccess& field : shape.fields) {
    if (key != field.name) continue;
    try {
      field.set(place(field, value), given);
    } catch (const py::cast_error&) {
      if (field.extreme != nullptr && PyLong_CheckExact(given.ptr())) {
        refuse_beyond(shape, field, value, argument, given);
      }
      refuse(field.kind, argument, given);
    }
    return;
  }
  std::string known;
  for (const FieldAccess& field : shape.fields) {
    known.append(known.empty() ? "" : ", ").append(field.name);
  }
  refuse("no such field; fields are " + known, argument);
}

}  // namespace

void change(const ValueShape& shape, void* value, const py::dict& changes) {
  for (const auto& item : changes) {
    assign(shape, value, std::string(py::str(item.first)), item.second);
  }
  shape.validate(value);
}

py::dict fields_of(const ValueShape& shape, const void* value) {
  py::dict result;
  for (const FieldAccess& field : shape.fields) result[field.name] = read(field, value);
  return result;
}

std::string text_of(const ValueShape& shape, const void* value) {
  std::string inner;
  for (const FieldAccess& field : shape.fields) {
    inner.append(inner.empty() ? "" : ", ").append(field.name).append("=");
    inner.append(std::string(py::repr(read(field, value))));
  }
  return std::string(shape.name).append("(").append(inner).append(")");
}

std::string described(const ValueShape& shape, const void* defaults, std::string text) {
  text += "\n\nParameters\n----------\n";
  for (const FieldAccess& field : shape.fields) {
    text.append(field.name).append(" : default ");
    text.append(std::string(py::repr(read(field, defaults)))).append("\n    ");
    text.append(field.text).append("\n");
  }
  return text;
}

}  // namespace jointid::bind
