#include "identify/terms.hpp"

#include <cmath>
#include <stdexcept>

namespace jointid::identify {

namespace {

using model::SpeedBasis;

template <class Row>
const Row& find(const std::vector<Row>& table, std::string_view name, const char* what) {
  std::string known;
  for (const auto& row : table) {
    if (row.name == name) return row;
    known += (known.empty() ? "" : ", ") + std::string(row.name);
  }
  throw std::invalid_argument("unknown " + std::string(what) + " '" + std::string(name) +
                              "'; known: " + known);
}

}  // namespace

const std::vector<Term>& term_table() {
  static const std::vector<Term> table{
      {"inertia", Integral::velocity_change, SpeedBasis::one, "", true, "kg·m²", "kg",
       "reflected inertia"},
      {"coulomb", Integral::friction, SpeedBasis::one, "", true, "N·m", "N", "Coulomb friction"},
      {"static", Integral::friction, SpeedBasis::stribeck, "stribeck", true, "N·m", "N",
       "static friction in excess of Coulomb"},
      {"viscous", Integral::displacement, SpeedBasis::one, "", true, "N·m·s/rad", "N·s/m",
       "viscous friction"},
      {"torque_offset", Integral::duration, SpeedBasis::one, "", false, "N·m", "N",
       "constant offset of the torque"},
      {"gravity_cos", Integral::cosine, SpeedBasis::one, "", false, "N·m", "N",
       "gravity torque, cos q part"},
      {"gravity_sin", Integral::sine, SpeedBasis::one, "", false, "N·m", "N",
       "gravity torque, sin q part"},
      {"sensor_gain", Integral::sensor, SpeedBasis::one, "", false, "N·m/unit", "N/unit",
       "gain of the torque sensor"},
      {"sensor_offset", Integral::duration, SpeedBasis::one, "", false, "N·m", "N",
       "offset of the torque sensor"},
  };
  return table;
}

const std::vector<Shape>& shape_table() {
  static const std::vector<Shape> table{
      {"stribeck", "s²/rad²", "s²/m²", "how fast static friction decays with speed"},
  };
  return table;
}

const std::vector<Model>& model_table() {
  static const std::vector<Model> table{
      {"coulomb_viscous", "(2-1)", {"coulomb", "viscous"}},
      {"stribeck", "(4-1)", {"coulomb", "static", "viscous"}},
  };
  return table;
}

bool is_friction(const Term& term) {
  return term.integral == Integral::friction || term.integral == Integral::displacement;
}

Eigen::VectorXd friction_basis(const Term& term, const Eigen::VectorXd& velocity, double shape) {
  if (!is_friction(term))
    throw std::invalid_argument("'" + std::string(term.name) + "' is not a friction term");
  if (term.integral == Integral::displacement) return velocity;
  return velocity.unaryExpr([&](double v) {
    return v == 0.0 ? 0.0 : std::copysign(model::basis_value(term.basis, std::fabs(v), shape), v);
  });
}

const Term& find_term(std::string_view name) {
  return find(term_table(), name, "term");
}

const Model& find_model(std::string_view name) {
  return find(model_table(), name, "friction model");
}

}  // namespace jointid::identify
