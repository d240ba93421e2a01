#pragma once
// Shared by the bindings of the simulator: casters of choices and small tuples.

#include <pybind11/numpy.h>

#include "bind/bind.hpp"
#include "bind/choices.hpp"
#include "simulate/simulator.hpp"

namespace jointid::bind {

/// A field that a struct inherits from its base.
template <class T, class M, class Base>
Field<T, M> inherited(const char* name, M Base::* member, const char* text) {
  return {name, static_cast<M T::*>(member), text};
}

void bind_sensors(py::module_& m);
void bind_controllers(py::module_& m);
void bind_servo(py::module_& m);

}  // namespace jointid::bind

namespace pybind11::detail {

template <>
struct type_caster<jointid::model::SpeedBasis>
    : jointid::bind::ChoiceCaster<jointid::model::SpeedBasis> {};
template <>
struct type_caster<jointid::simulate::VelocityEstimate>
    : jointid::bind::ChoiceCaster<jointid::simulate::VelocityEstimate> {};
template <>
struct type_caster<jointid::simulate::FrictionVelocity>
    : jointid::bind::ChoiceCaster<jointid::simulate::FrictionVelocity> {};

template <>
struct type_caster<jointid::model::Friction> {
  PYBIND11_TYPE_CASTER(jointid::model::Friction,
                       const_name("tuple[str, float, float, Sequence[float]]"));

  bool load(handle given, bool) {
    if (!isinstance<tuple>(given) || len(given) != 4) return false;
    const auto four = reinterpret_borrow<tuple>(given);
    value = {four[0].cast<jointid::model::SpeedBasis>(), four[1].cast<double>(),
             four[2].cast<double>()};
    const auto shapes = four[3].cast<std::vector<double>>();
    if (shapes.size() > value.shapes.size()) return false;
    value.shapes.fill(1.0);  // valid values for shapes that the basis does not have
    std::copy(shapes.begin(), shapes.end(), value.shapes.begin());
    return true;
  }
  static handle cast(const jointid::model::Friction& friction, return_value_policy, handle) {
    return pybind11::make_tuple(friction.basis, friction.positive, friction.negative,
                                friction.shapes)
        .release();
  }
};

template <>
struct type_caster<jointid::model::Weight> {
  PYBIND11_TYPE_CASTER(jointid::model::Weight, const_name("tuple[float, float]"));

  bool load(handle given, bool) {
    if (!isinstance<tuple>(given) || len(given) != 2) return false;
    const auto pair = reinterpret_borrow<tuple>(given);
    value = {pair[0].cast<double>(), pair[1].cast<double>()};
    return true;
  }
  static handle cast(const jointid::model::Weight& weight, return_value_policy, handle) {
    return make_tuple(weight.torque, weight.angle).release();
  }
};

template <>
struct type_caster<jointid::model::Harmonic> {
  PYBIND11_TYPE_CASTER(jointid::model::Harmonic, const_name("tuple[float, float, float]"));

  bool load(handle given, bool) {
    if (!isinstance<tuple>(given) || len(given) != 3) return false;
    const auto three = reinterpret_borrow<tuple>(given);
    value = {three[0].cast<double>(), three[1].cast<double>(), three[2].cast<double>()};
    return true;
  }
  static handle cast(const jointid::model::Harmonic& harmonic, return_value_policy, handle) {
    return make_tuple(harmonic.order, harmonic.cos, harmonic.sin).release();
  }
};

}  // namespace pybind11::detail
