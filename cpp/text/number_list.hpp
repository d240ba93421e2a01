#pragma once
// Numbers as text in Python's notation: the fewest digits that read back as the same double.

#include <optional>
#include <span>
#include <string>

namespace jointid::text {

/// "[1.0, -2.5e-05]", as Python's json writes a list of floats. Nothing if a number is not finite,
/// or if the standard library cannot write the shortest digits: Python writes the list then.
std::optional<std::string> number_list(std::span<const double> values);

}  // namespace jointid::text
