#include "base/digits.hpp"

#include <array>
#include <charconv>
#include <system_error>

namespace jointid::base {

std::string with_digits(double number, int digits) {
  std::array<char, 64> text{};  // -1.2345678901234567e-308 has 24
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), number,
                                          std::chars_format::general, digits);
  return error == std::errc() ? std::string(text.data(), end) : std::string("?");
}

}  // namespace jointid::base
