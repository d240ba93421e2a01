#include "model/joint.hpp"

#include "base/require.hpp"

namespace jointid::model {

template <>
void Joint::validate() const {
  const base::Requirement require("joint");
  require.above_zero("inertia", inertia);
  require.at_least_zero("link_inertia", link_inertia);
  require.finite("load", load);
  require.finite("torque_offset", torque_offset);
  require.above_zero("torque_limit", torque_limit);
  require.at_least_zero("coulomb_positive", coulomb_positive);
  require.at_least_zero("coulomb_negative", coulomb_negative);
  require.at_least_zero("static_positive", static_positive);
  require.at_least_zero("static_negative", static_negative);
  require.at_least_zero("viscous_positive", viscous_positive);
  require.at_least_zero("viscous_negative", viscous_negative);
  require.at_least_zero("stribeck", stribeck);
  require.above_zero("stribeck_velocity", stribeck_velocity);
  require.above_zero("stribeck_exponent", stribeck_exponent);
  require.at_least_zero("load_friction", load_friction);
  if (bristles) {
    require.above_zero("bristle_stiffness", bristle_stiffness);
    require.at_least_zero("bristle_damping", bristle_damping);
    require.above_zero("coulomb_positive (with bristles)", coulomb_positive);
    require.above_zero("coulomb_negative (with bristles)", coulomb_negative);
  }
  for (const auto& weight : weights) {
    require.finite("weights.torque", weight.torque);
    require.finite("weights.angle", weight.angle);
  }
  for (const auto& harmonic : harmonics) {
    require.above_zero("harmonics.order", harmonic.order);
    require.finite("harmonics.cos", harmonic.cos);
    require.finite("harmonics.sin", harmonic.sin);
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
