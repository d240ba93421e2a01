#pragma once
// Refuses a number that cannot be used. The message has its owner, its name, its value and the
// limit.

#include <cmath>
#include <string>

#include "base/input_error.hpp"

namespace jointid::base {

class Requirement {
 public:
  constexpr explicit Requirement(const char* owner) : owner_(owner) {}

  /// Throws InputError unless the condition holds.
  template <class Number>
  void that(bool holds, const char* name, Number value, const char* limit) const {
    if (holds) return;
    throw InputError(std::string("must be ") + limit, std::string(owner_) + "." + name,
                     as_value(value));
  }
  void finite(const char* name, double value) const {
    that(std::isfinite(value), name, value, "finite");
  }
  void at_least_zero(const char* name, double value) const {
    that(value >= 0.0 && std::isfinite(value), name, value, "finite and at least 0");
  }
  void above_zero(const char* name, double value) const {
    that(value > 0.0 && std::isfinite(value), name, value, "finite and above 0");
  }

 private:
  const char* owner_;
};

}  // namespace jointid::base
