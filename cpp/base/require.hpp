#pragma once
// One sentence for a number that cannot be used: whose, which, the limit, and what it is.

#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>

namespace jointid::base {

class Requirement {
 public:
  constexpr explicit Requirement(const char* owner) : owner_(owner) {}

  void that(bool holds, const char* name, double value, const char* limit) const {
    if (holds) return;
    std::ostringstream text;
    text.precision(15);
    text << owner_ << "." << name << " must be " << limit << ", got " << value;
    throw std::invalid_argument(text.str());
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
