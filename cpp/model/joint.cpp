#include "model/joint.hpp"

#include "base/require.hpp"
#include "model/dry_friction.hpp"

namespace jointid::model {

template <>
void Joint::validate() const {
  const base::Requirement require("joint");
  require.above_zero("inertia", inertia);
  require.at_least_zero("link_inertia", link_inertia);
  require.finite("load", load);
  require.finite("torque_offset", torque_offset);
  require.above_zero("torque_limit", torque_limit);
  for (const auto& term : friction) {
    require.at_least_zero("friction.positive", term.positive);
    require.at_least_zero("friction.negative", term.negative);
    const bool above = facts_of(term.basis).shape_above;
    for (const double shape : term.shapes) {
      above ? require.above_zero("friction.shapes", shape)
            : require.at_least_zero("friction.shapes", shape);
    }
  }
  require.at_least_zero("load_friction", load_friction);
  if (bristles) {
    require.above_zero("bristle_stiffness", bristle_stiffness);
    require.at_least_zero("bristle_damping", bristle_damping);
    for (const bool forward : {true, false}) {
      require.above_zero("constant friction (with bristles)", directed(*this, forward, 0.0).dry);
    }
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
  bool same = a.friction.size() == b.friction.size() && a.bristles == b.bristles &&
              a.weights.size() == b.weights.size() && a.harmonics.size() == b.harmonics.size();
  for (std::size_t i = 0; same && i < a.friction.size(); ++i) {
    same = a.friction[i].basis == b.friction[i].basis;
  }
  for (std::size_t i = 0; same && i < a.harmonics.size(); ++i) {
    same = a.harmonics[i].order == b.harmonics[i].order;
  }
  return same;
}

}  // namespace jointid::model
