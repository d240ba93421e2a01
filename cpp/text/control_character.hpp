#pragma once
// Control characters, which text does not contain in any encoding.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace jointid::text {

/// The place of the first control character other than tab and the ends of lines and pages; npos
/// without one.
inline std::size_t find_control_character(std::string_view text) {
  constexpr std::size_t kBlock = 4096;
  // In bytes only, so that a vector takes many of them at once: 9 to 13 are tab and ends.
  const auto is_control = [](char sign) {
    const auto byte = static_cast<std::uint8_t>(sign);
    const auto from_tab = static_cast<std::uint8_t>(byte - 9U);
    const std::uint8_t low = byte < 32 ? 1 : 0;
    const std::uint8_t other = from_tab > 4 ? 1 : 0;
    const std::uint8_t erased = byte == 127 ? 1 : 0;
    return static_cast<std::uint8_t>((low & other) | erased);
  };
  for (std::size_t begin = 0; begin < text.size(); begin += kBlock) {
    const std::string_view block = text.substr(begin, kBlock);
    std::uint8_t any = 0;
    const char* const signs = block.data();
    const std::size_t size = block.size();
    for (std::size_t k = 0; k < size; ++k)
      any = static_cast<std::uint8_t>(any | is_control(signs[k]));
    if (any == 0) continue;
    const auto found = std::find_if(block.begin(), block.end(), is_control);
    return begin + static_cast<std::size_t>(found - block.begin());
  }
  return std::string_view::npos;
}

}  // namespace jointid::text
