#pragma once
// Bad input of the user: an error that says which argument, its value and why it cannot be used.
// Any other std::invalid_argument is a bug of the caller.

#include <cstdint>
#include <sstream>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>

namespace jointid::base {

class InputError : public std::invalid_argument {
 public:
  using Value = std::variant<std::monostate, std::int64_t, double, std::string>;

  /// `reason`: why it cannot be used; `argument`: its name, empty if none can be named; `value`:
  /// what it was, if that says something.
  explicit InputError(std::string reason, std::string argument = {}, Value value = {})
      : std::invalid_argument(sentence(reason, argument, value)),
        reason_(std::move(reason)),
        argument_(std::move(argument)),
        value_(std::move(value)) {}

  [[nodiscard]] const std::string& reason() const { return reason_; }
  [[nodiscard]] const std::string& argument() const { return argument_; }
  [[nodiscard]] const Value& value() const { return value_; }

 private:
  static std::string sentence(const std::string& reason, const std::string& argument,
                              const Value& value) {
    std::ostringstream text;
    text.precision(15);
    text << argument;
    std::visit(
        [&](const auto& given) {
          using Given = std::remove_cvref_t<decltype(given)>;
          if constexpr (std::is_same_v<Given, std::string>) {
            text << " is '" << given << "'";
          } else if constexpr (!std::is_same_v<Given, std::monostate>) {
            text << " is " << given;
          }
        },
        value);
    if (!argument.empty()) text << ": ";
    text << reason;
    return text.str();
  }

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
