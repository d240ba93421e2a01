#include "base/digits.hpp"

#include <version>

#if defined(__cpp_lib_to_chars)
#include <array>
#include <charconv>
#include <system_error>
#else
#include <locale>
#include <sstream>
#endif

namespace jointid::base {

std::string with_digits(double number, int digits) {
#if defined(__cpp_lib_to_chars)
  std::array<char, 64> text{};  // -1.2345678901234567e-308 has 24
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), number,
                                          std::chars_format::general, digits);
  return error == std::errc() ? std::string(text.data(), end) : std::string("?");
#else
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text.precision(digits);
  text << number;
  return text.str();
#endif
}

}  // namespace jointid::base
