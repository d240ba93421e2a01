#pragma once
// Bad input of the user: an error with the argument, its value and the reason. Any other
// std::invalid_argument is a bug of the caller.

#include <cstdint>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <variant>

namespace jointid::base {

/// Not inlined: it is thrown in many places, and never in time-critical ones.
class InputError : public std::invalid_argument {
 public:
  using Value = std::variant<std::monostate, std::int64_t, double, std::string>;

  /// `reason`: why the value cannot be used; `argument`: its name, empty if there is none; `value`:
  /// the value, if it helps.
  explicit InputError(std::string reason, std::string argument = {}, Value value = {});

  [[nodiscard]] const std::string& reason() const { return reason_; }
  [[nodiscard]] const std::string& argument() const { return argument_; }
  [[nodiscard]] const Value& value() const { return value_; }

 private:
  std::string reason_;
  std::string argument_;
  Value value_;
};

/// A number as an error's value: whole numbers stay whole.
template <class Number>
InputError::Value as_value(Number number) {
  static_assert(std::is_arithmetic_v<Number>);
  if constexpr (std::is_integral_v<Number>) {
    return static_cast<std::int64_t>(number);
  } else {
    return static_cast<double>(number);
  }
}

}  // namespace jointid::base
