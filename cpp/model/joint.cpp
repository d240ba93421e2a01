#include "model/joint.hpp"

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace jointid::model {

namespace {

void require(bool holds, const char* name, double value, const char* limit) {
  if (holds) return;
  std::ostringstream text;
  text.precision(15);
  text << name << " must be " << limit << ", got " << value;
  throw std::invalid_argument(text.str());
}

void at_least_zero(const char* name, double value) {
  require(value >= 0.0 && std::isfinite(value), name, value, "finite and at least 0");
}

void finite(const char* name, double value) {
  require(std::isfinite(value), name, value, "finite");
}

void above_zero(const char* name, double value) {
  require(value > 0.0 && std::isfinite(value), name, value, "finite and above 0");
}

}  // namespace

template <>
void Joint::validate() const {
  above_zero("inertia", inertia);
  at_least_zero("link_inertia", link_inertia);
  finite("load", load);
  finite("torque_offset", torque_offset);
  above_zero("torque_limit", torque_limit);
  at_least_zero("coulomb_positive", coulomb_positive);
  at_least_zero("coulomb_negative", coulomb_negative);
  // A static excess below zero is friction that rises from rest: allowed while some remains.
  const bool excess = decay != Decay::none;
  require(!excess || coulomb_positive + static_positive >= 0.0, "static_positive", static_positive,
          "at least -coulomb_positive");
  require(!excess || coulomb_negative + static_negative >= 0.0, "static_negative", static_negative,
          "at least -coulomb_negative");
  at_least_zero("viscous_positive", viscous_positive);
  at_least_zero("viscous_negative", viscous_negative);
  at_least_zero("stribeck", stribeck);
  above_zero("stribeck_velocity", stribeck_velocity);
  above_zero("stribeck_exponent", stribeck_exponent);
  at_least_zero("load_friction", load_friction);
  if (bristles) {
    above_zero("bristle_stiffness", bristle_stiffness);
    at_least_zero("bristle_damping", bristle_damping);
    above_zero("coulomb_positive (with bristles)", coulomb_positive);
    above_zero("coulomb_negative (with bristles)", coulomb_negative);
  }
  for (const auto& weight : weights) {
    finite("weights.torque", weight.torque);
    finite("weights.angle", weight.angle);
  }
  for (const auto& harmonic : harmonics) {
    above_zero("harmonics.order", harmonic.order);
    finite("harmonics.cos", harmonic.cos);
    finite("harmonics.sin", harmonic.sin);
  }
}

bool same_structure(const Joint& a, const Joint& b) {
  bool same = a.decay == b.decay && a.bristles == b.bristles &&
              a.weights.size() == b.weights.size() && a.harmonics.size() == b.harmonics.size();
  for (std::size_t i = 0; same && i < a.harmonics.size(); ++i) {
    same = a.harmonics[i].order == b.harmonics[i].order;
  }
  return same;
}

}  // namespace jointid::model
