#pragma once
// Numbers in messages. The library's streams would do the same, but a wheel that brings its C++
// library with it would bring all their locales, too.

#include <string>

namespace jointid::base {

/// A number with at most so many digits, as printf's %g; with a point in every locale.
std::string with_digits(double number, int digits);

}  // namespace jointid::base
