#pragma once
// Enumerations pass between C++ and Python as words: selection="roulette".

#include "base/choices.hpp"
#include "bind/bind.hpp"
#include "search/genetic_options.hpp"

namespace jointid::bind {

template <class Choice>
struct ChoiceCaster {
  PYBIND11_TYPE_CASTER(Choice, py::detail::const_name("str"));

  bool load(py::handle given, bool) {
    if (!py::isinstance<py::str>(given)) return false;
    value = base::chosen<Choice>(given.cast<std::string>());
    return true;
  }
  static py::handle cast(Choice choice, py::return_value_policy, py::handle) {
    const auto text = base::word(choice);
    return py::str(text.data(), text.size()).release();
  }
};

}  // namespace jointid::bind

namespace pybind11::detail {
template <>
struct type_caster<jointid::search::Coding> : jointid::bind::ChoiceCaster<jointid::search::Coding> {
};
template <>
struct type_caster<jointid::search::Selection>
    : jointid::bind::ChoiceCaster<jointid::search::Selection> {};
template <>
struct type_caster<jointid::search::Fitness>
    : jointid::bind::ChoiceCaster<jointid::search::Fitness> {};
template <>
struct type_caster<jointid::search::Crossover>
    : jointid::bind::ChoiceCaster<jointid::search::Crossover> {};
template <>
struct type_caster<jointid::search::BitCrossover>
    : jointid::bind::ChoiceCaster<jointid::search::BitCrossover> {};
template <>
struct type_caster<jointid::search::Uncrossed>
    : jointid::bind::ChoiceCaster<jointid::search::Uncrossed> {};
template <>
struct type_caster<jointid::search::Mutation>
    : jointid::bind::ChoiceCaster<jointid::search::Mutation> {};
template <>
struct type_caster<jointid::search::MutationUnit>
    : jointid::bind::ChoiceCaster<jointid::search::MutationUnit> {};
template <>
struct type_caster<jointid::search::Diversity>
    : jointid::bind::ChoiceCaster<jointid::search::Diversity> {};
}  // namespace pybind11::detail
