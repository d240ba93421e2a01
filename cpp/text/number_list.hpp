#pragma once
// Numbers as text, written as Python writes them: the fewest digits that read back as the same
// double.

#include <optional>
#include <span>
#include <string>

namespace jointid::text {

/// "[1.0, -2.5e-05]", as Python's json writes a list of floats. Nothing where a number is not
/// finite, or where the standard library cannot write the shortest digits: Python does it then.
std::optional<std::string> number_list(std::span<const double> values);

}  // namespace jointid::text
