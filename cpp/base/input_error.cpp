#include "base/input_error.hpp"

#include <utility>

#include "base/digits.hpp"

namespace jointid::base {

namespace {

std::string shown(const InputError::Value& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return " is '" + *text + "'";
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return " is " + std::to_string(*whole);
  if (const auto* number = std::get_if<double>(&value)) return " is " + with_digits(*number, 15);
  return {};
}

std::string sentence(const std::string& reason, const std::string& argument,
                     const InputError::Value& value) {
  return argument + shown(value) + (argument.empty() ? "" : ": ") + reason;
}

}  // namespace

InputError::InputError(std::string reason, std::string argument, Value value)
    : std::invalid_argument(sentence(reason, argument, value)),
      reason_(std::move(reason)),
      argument_(std::move(argument)),
      value_(std::move(value)) {}

}  // namespace jointid::base
