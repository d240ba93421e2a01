#pragma once
// Choices with names: an enumeration whose values are told, and asked for, by a word.

#include <array>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>

namespace jointid::base {

/// Specialised for each enumeration: `field`, the option it belongs to, and `all`, its words in the
/// order of its values.
template <class Choice>
struct Words;

template <class Choice>
std::string_view word(Choice choice) {
  return Words<Choice>::all.at(static_cast<std::size_t>(choice));
}

/// Throws std::invalid_argument naming the known words.
template <class Choice>
Choice chosen(std::string_view asked) {
  std::string known;
  for (std::size_t i = 0; i < Words<Choice>::all.size(); ++i) {
    if (Words<Choice>::all[i] == asked) return static_cast<Choice>(i);
    known.append(known.empty() ? "" : ", ").append(Words<Choice>::all[i]);
  }
  throw std::invalid_argument(std::string(Words<Choice>::field)
                                  .append(" '")
                                  .append(asked)
                                  .append("' is not known; known are ")
                                  .append(known));
}

}  // namespace jointid::base
