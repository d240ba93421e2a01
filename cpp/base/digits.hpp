#pragma once
// Numbers in messages and names. The library's streams would do the same, but a wheel with its own
// C++ library would contain all its locales, too. std::to_chars and std::from_chars of doubles
// bring tables of powers, or a stream where a library lacks them.

#include <optional>
#include <string>
#include <string_view>

namespace jointid::base {

/// A number with at most `digits` digits, as printf's %g; with a point in every locale.
std::string with_digits(double number, int digits);

/// A finite number that printf wrote. A point replaces the mark of the process's locale between the
/// digits (a comma, or several bytes).
std::string with_point(std::string_view printed);

/// The nearest double of an unsigned number such as 2.5 or 1e-05, in every locale. Nothing for any
/// other text: no space, hexadecimal digits, inf or nan.
std::optional<double> read_digits(std::string_view text);

}  // namespace jointid::base
