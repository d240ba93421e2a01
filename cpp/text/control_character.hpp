#pragma once
// Control characters, which text does not contain in any encoding.

#include <cstddef>
#include <string_view>

namespace jointid::text {

/// The place of the first control character other than tab and the ends of lines and pages; npos
/// without one.
std::size_t find_control_character(std::string_view text);

}  // namespace jointid::text
