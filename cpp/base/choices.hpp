#pragma once
// Named choices: enumerations with values that are written as words.

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

#include "base/input_error.hpp"

namespace jointid::base {

/// Specialised for each enumeration: `field` is the option that takes the choice, `all` the words
/// in the order of the values.
template <class Choice>
struct Words;

template <class Choice>
std::string_view word(Choice choice) {
  return Words<Choice>::all.at(static_cast<std::size_t>(choice));
}

/// Throws InputError that lists the known words.
template <class Choice>
Choice chosen(std::string_view asked) {
  std::string known;
  for (std::size_t i = 0; i < Words<Choice>::all.size(); ++i) {
    if (Words<Choice>::all[i] == asked) return static_cast<Choice>(i);
    known.append(known.empty() ? "" : ", ").append(Words<Choice>::all[i]);
  }
  throw InputError("choose one of " + known, std::string(Words<Choice>::field), std::string(asked));
}

}  // namespace jointid::base
