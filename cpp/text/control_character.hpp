#pragma once
// Control characters, which no text contains in any encoding.

#include <cstddef>
#include <string_view>

namespace jointid::text {

/// The index of the first control character other than tab and the ends of lines and pages; npos if
/// there is none.
std::size_t find_control_character(std::string_view text);

}  // namespace jointid::text
