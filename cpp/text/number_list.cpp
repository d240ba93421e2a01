#include "text/number_list.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <version>

namespace jointid::text {

namespace {

#if defined(__cpp_lib_to_chars)

// Python writes no exponent for numbers from 1e-4 to below 1e16.
constexpr int kLeast = -4;
constexpr int kMost = 16;

/// Appends a finite number from its digits and exponent in the form d.ddde-xx.
void append(std::string_view written, std::string& text) {
  if (written.front() == '-') {
    text += '-';
    written.remove_prefix(1);
  }
  const std::size_t mark = written.find('e');
  const char* from = written.data() + mark + 1;
  if (*from == '+') ++from;
  int exponent = 0;
  std::from_chars(from, written.data() + written.size(), exponent);
  if (exponent < kLeast || exponent >= kMost) {  // with at least two digits, as Python writes it
    text += written;
    return;
  }
  const char first = written.front();
  const std::string_view rest = mark > 1 ? written.substr(2, mark - 2) : std::string_view();
  if (exponent < 0) {
    text += "0.";
    text.append(static_cast<std::size_t>(-exponent - 1), '0');
    text += first;
    text += rest;
    return;
  }
  const auto whole = static_cast<std::size_t>(exponent);
  text += first;
  text += rest.substr(0, whole);
  if (rest.size() <= whole) {
    text.append(whole - rest.size(), '0');
    text += ".0";
    return;
  }
  text += '.';
  text += rest.substr(whole);
}

#endif

}  // namespace

std::optional<std::string> number_list([[maybe_unused]] std::span<const double> values) {
#if defined(__cpp_lib_to_chars)
  std::string text = "[";
  text.reserve(20 * values.size() + 2);
  std::array<char, 32> written;
  for (const double value : values) {
    if (!std::isfinite(value)) return std::nullopt;
    if (text.size() > 1) text += ", ";
    const std::to_chars_result end = std::to_chars(written.data(), written.data() + written.size(),
                                                   value, std::chars_format::scientific);
    append({written.data(), static_cast<std::size_t>(end.ptr - written.data())}, text);
  }
  text += ']';
  return text;
#else
  return std::nullopt;
#endif
}

}  // namespace jointid::text
