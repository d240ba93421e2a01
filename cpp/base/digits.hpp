#pragma once
// Numbers in messages. The library's streams would do the same, but a wheel that brings its C++
// library with it would bring all their locales, too; and std::to_chars' tables of powers, or a
// stream again where a library has no std::to_chars of doubles.

#include <string>
#include <string_view>

namespace jointid::base {

/// A number with at most so many digits, as printf's %g; with a point in every locale.
std::string with_digits(double number, int digits);

/// A finite number that printf wrote: what the process's locale puts between the digits (a comma,
/// or a mark of several bytes) is a point.
std::string with_point(std::string_view printed);

}  // namespace jointid::base
