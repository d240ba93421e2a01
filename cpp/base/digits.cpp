#include "base/digits.hpp"

#include <array>
#include <clocale>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>

namespace jointid::base {

std::string with_point(std::string_view printed) {
  constexpr std::string_view kKept = "0123456789+-e";
  std::string text;
  bool inside = false;  // within a decimal mark
  for (const char each : printed) {
    const bool mark = kKept.find(each) == std::string_view::npos;
    if (!mark) {
      text += each;
    } else if (!inside) {
      text += '.';
    }
    inside = mark;
  }
  return text;
}

std::string with_digits(double number, int digits) {
  std::array<char, 64> text{};  // -1.2345678901234567e-308 has 24
  const int length = std::snprintf(text.data(), text.size(), "%.*g", digits, number);
  if (length < 0 || static_cast<std::size_t>(length) >= text.size()) return "?";
  const std::string_view printed(text.data(), static_cast<std::size_t>(length));
  return std::isfinite(number) ? with_point(printed) : std::string(printed);
}

std::optional<double> read_digits(std::string_view text) {
  constexpr std::string_view kKnown = "0123456789.eE+-";
  constexpr std::string_view kFirst = kKnown.substr(0, 11);
  if (text.empty() || kFirst.find(text.front()) == std::string_view::npos ||
      text.find_first_not_of(kKnown) != std::string_view::npos) {
    return std::nullopt;
  }
  std::string written(text);
  if (const auto point = written.find('.'); point != std::string::npos) {
    written.replace(point, 1, std::localeconv()->decimal_point);
  }
  char* end = nullptr;
  const double number = std::strtod(written.c_str(), &end);
  if (end != written.c_str() + written.size() || !std::isfinite(number)) return std::nullopt;
  return number;
}

}  // namespace jointid::base
