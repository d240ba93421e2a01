#include "text/control_character.hpp"

#include <algorithm>
#include <cstdint>

namespace jointid::text {

namespace {

/// In bytes only, so that a vector holds many of them. 9 to 13 are tab and the ends of lines and
/// pages.
std::uint8_t is_control(char sign) {
  const auto byte = static_cast<std::uint8_t>(sign);
  const auto from_tab = static_cast<std::uint8_t>(byte - 9U);
  const std::uint8_t low = byte < 32 ? 1 : 0;
  const std::uint8_t other = from_tab > 4 ? 1 : 0;
  const std::uint8_t erased = byte == 127 ? 1 : 0;
  return static_cast<std::uint8_t>((low & other) | erased);
}

std::uint8_t any_control(const char* signs, std::size_t count) {
  std::uint8_t any = 0;
  for (std::size_t k = 0; k < count; ++k) {
    any = static_cast<std::uint8_t>(any | is_control(signs[k]));
  }
  return any;
}

}  // namespace

std::size_t find_control_character(std::string_view text) {
  constexpr std::size_t kBlock = 4096;
  for (std::size_t begin = 0; begin < text.size(); begin += kBlock) {
    const std::string_view block = text.substr(begin, kBlock);
    if (any_control(block.data(), block.size()) == 0) continue;
    const auto* const found = std::find_if(block.data(), block.data() + block.size(),
                                           [](char sign) { return is_control(sign) != 0; });
    return begin + static_cast<std::size_t>(found - block.data());
  }
  return std::string_view::npos;
}

}  // namespace jointid::text
