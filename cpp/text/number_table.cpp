#include "text/number_table.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <optional>
#include <system_error>
#include <version>

namespace jointid::text {

namespace {

/// The next line without its end, which is removed from the text.
std::string_view next_line(std::string_view& text) {
  const std::size_t end = std::min(text.find('\n'), text.size());
  std::string_view line = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line;
}

bool starts_number(const char* at, const char* end) {
  if (at != end && *at == '-') ++at;
  return at != end && ((*at >= '0' && *at <= '9') || *at == '.');  // neither inf nor nan
}

/// Value of a digit; more than 9 for any other character.
unsigned digit(char sign) {
  return static_cast<unsigned>(sign) - static_cast<unsigned>('0');
}

/// Reads up to eight digits from eight characters at once, without a branch that depends on their
/// number. Neighbours are joined to pairs, pairs to fours, fours to all eight (after D. Lemire,
/// "Quickly parsing eight digits", 2018). Returns the number of digits.
std::size_t take_some(const char* at, std::uint64_t& number) {
  constexpr std::array<std::uint64_t, 9> kPowers = {
      1, 10, 100, 1'000, 10'000, 100'000, 1'000'000, 10'000'000, 100'000'000};
  std::uint64_t signs = 0;
  std::memcpy(&signs, at, sizeof signs);
  const std::uint64_t digits =
      signs ^ 0x3030303030303030U;  // 0 to 9 for a digit, more for any other character
  const std::uint64_t others = ((digits + 0x7676767676767676U) | digits) & 0x8080808080808080U;
  const std::size_t count =
      static_cast<std::size_t>(std::countr_zero(others)) / 8;  // 8 if all are digits
  if (count == 0) return 0;
  std::uint64_t value = digits << (8 * (8 - count));  // leading zeros
  value = value * 10 + (value >> 8U);
  constexpr std::uint64_t kPairs = 0x000000ff000000ffU;
  constexpr std::uint64_t kFirst = 100U + (1'000'000ULL << 32U);
  constexpr std::uint64_t kSecond = 1U + (10'000ULL << 32U);
  value = ((value & kPairs) * kFirst + ((value >> 16U) & kPairs) * kSecond) >> 32U;
  number = number * kPowers[count] + value;
  return count;
}

/// Appends the following digits to a number.
const char* take_digits(const char* at, const char* end, std::uint64_t& number) {
  if constexpr (std::endian::native == std::endian::little) {
    while (end - at >= 8) {
      const std::size_t count = take_some(at, number);
      at += count;
      if (count < 8) return at;
    }
  }
  while (at != end && digit(*at) < 10) number = number * 10 + digit(*at++);
  return at;
}

/// Reads a short number such as -12.3456 exactly. Its digits and a power of ten both fit a double,
/// so their quotient is the nearest double. Null if the number is longer, or has an exponent.
const char* read_short(const char* at, const char* end, double& value) {
  constexpr std::array<double, 16> kPowers = {1e0, 1e1, 1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                              1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};
  const bool negative = *at == '-';
  if (negative) ++at;
  const char* const first = at;
  std::uint64_t digits = 0;
  while (at != end && digit(*at) < 10) digits = digits * 10 + digit(*at++);
  auto count = at - first;
  std::ptrdiff_t decimals = 0;
  if (at != end && *at == '.') {
    const char* const point = at++;
    at = take_digits(at, end, digits);
    decimals = at - point - 1;
    count += decimals;
  }
  // Fifteen digits are below 2^53; with more, `digits` may have overflowed.
  if (count == 0 || count > 15 || (at != end && (*at == 'e' || *at == 'E'))) return nullptr;
  const double size = static_cast<double>(digits) / kPowers[static_cast<std::size_t>(decimals)];
  value = negative ? -size : size;
  return at;
}

const char* read_long([[maybe_unused]] const char* at, [[maybe_unused]] const char* end,
                      [[maybe_unused]] double& value) {
#if defined(__cpp_lib_to_chars)
  const std::from_chars_result read = std::from_chars(at, end, value);
  return read.ec == std::errc() ? read.ptr : nullptr;
#else
  return nullptr;  // this standard library reads no doubles: the caller's own parser does
#endif
}

/// Reads one cell up to the separator or the end of the line; null if it is no plain number.
const char* read_cell(const char* at, const char* end, char separator, double& value) {
  while (at != end && *at == ' ') ++at;
  if (end - at > 1 && *at == '+' && at[1] != '-') ++at;
  if (!starts_number(at, end)) return nullptr;
  const char* behind = read_short(at, end, value);
  if (behind == nullptr) behind = read_long(at, end, value);
  if (behind == nullptr) return nullptr;
  while (behind != end && *behind == ' ') ++behind;
  return behind == end || *behind == separator ? behind : nullptr;
}

}  // namespace

std::optional<Eigen::MatrixXd> number_table(std::string_view text, std::size_t below,
                                            char separator, std::size_t columns) {
  if (columns == 0) return std::nullopt;
  for (std::size_t k = 0; k < below; ++k) {
    // A \r alone also ends a line for the other parser.
    if (next_line(text).find('\r') != std::string_view::npos) return std::nullopt;
  }
  // A row has at least two characters per column, so many empty lines do not reserve much memory.
  const bool ended = text.ends_with('\n');
  const auto lines =
      static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')) + (ended ? 0U : 1U);
  const std::size_t rows = std::min(lines, text.size() / (2 * columns) + 1);
  Eigen::MatrixXd table(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(columns));
  Eigen::Index row = 0;
  while (!text.empty()) {
    const std::string_view line = next_line(text);
    if (line.empty()) continue;
    if (row == table.rows()) return std::nullopt;
    const char* at = line.data();
    const char* const end = at + line.size();
    for (std::size_t column = 0; column < columns; ++column) {
      at = read_cell(at, end, separator, table(row, static_cast<Eigen::Index>(column)));
      const bool last = column + 1 == columns;
      if (at == nullptr || (at == end) != last) return std::nullopt;
      if (!last) ++at;
    }
    ++row;
  }
  if (row == 0) return std::nullopt;
  if (row != table.rows()) table.conservativeResize(row, Eigen::NoChange);
  return table;
}

}  // namespace jointid::text
