#pragma once
// Numbers in messages and names. The library's streams would do the same, but a wheel that brings
// its C++ library with it would bring all their locales, too; and tables of powers for
// std::to_chars and std::from_chars of doubles, or a stream again where a library has none.

#include <optional>
#include <string>
#include <string_view>

namespace jointid::base {

/// A number with at most so many digits, as printf's %g; with a point in every locale.
std::string with_digits(double number, int digits);

/// A finite number that printf wrote: what the process's locale puts between the digits (a comma,
/// or a mark of several bytes) is a point.
std::string with_point(std::string_view printed);

/// The nearest double of a number without a sign such as 2.5 or 1e-05, in every locale; nothing
/// else: no space, hexadecimal digits, inf or nan.
std::optional<double> read_digits(std::string_view text);

}  // namespace jointid::base
