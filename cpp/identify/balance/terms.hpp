#pragma once
// The regressor is a list of named terms: each is a coefficient times a basis, integrated over each
// window, in the torque balance  integral(torque) = sum of terms.  A new term is one row of the
// table in terms.cpp (and a new way to integrate, if it needs one, in quadrature.cpp); bounds,
// report, JSON, plots and CLI follow from the row.

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "model/friction.hpp"

namespace jointid::identify {

/// What a term's basis integrates to over a window.
enum class Integral {
  velocity_change,  ///< [v]: no acceleration needed
  friction,         ///< integral of sgn v h(|v|), h a SpeedBasis, in one Direction or both
  load_friction,    ///< integral of sgn v |torque|
  displacement,     ///< [q] = integral of v
  duration,         ///< T
  cosine,           ///< integral of cos(frequency q)
  sine,             ///< integral of sin(frequency q)
  sensor,           ///< integral of the raw sensor reading
};

/// What the order of a harmonic counts: turns of the joint, or of the motor in front of the gear.
enum class Harmonic { none, joint, motor };

/// One row: a coefficient and its basis. Rows with a Harmonic stand for a family, one term an
/// order.
struct Term {
  std::string key;   ///< unique: what a model lists
  std::string name;  ///< the parameter's name; two bases of the same quantity share it
  Integral integral;
  model::SpeedBasis basis = model::SpeedBasis::one;     ///< for Integral::friction
  model::Direction direction = model::Direction::both;  ///< for Integral::friction
  std::vector<std::string> shapes{};                    ///< names of the basis's shape parameters
  Harmonic harmonic = Harmonic::none;
  double order = 1.0;         ///< of the harmonic
  bool non_negative = false;  ///< a negative value has no physical meaning
  std::string unit;           ///< revolute
  std::string unit_prismatic;
  std::string meaning;  ///< one line for reports
};

struct Shape {
  std::string name;
  std::string unit;
  std::string unit_prismatic;
  std::string meaning;
};

/// A friction model by name, as the keys of the terms it consists of.
struct Model {
  std::string name;
  std::string equation;  ///< of the thesis
  std::vector<std::string> terms;
};

const std::vector<Term>& term_table();
const std::vector<Shape>& shape_table();
const std::vector<Model>& model_table();

/// True for the terms that make up the friction map f(v).
bool is_friction(const Term& term);

/// The friction term's basis at each velocity: what its coefficient multiplies. 0 at rest.
Eigen::VectorXd friction_basis(const Term& term, const Eigen::VectorXd& velocity,
                               const Eigen::VectorXd& shapes);

/// The term of that key; "ripple_sin_2" is order 2 of the family "ripple_sin". Throws
/// std::invalid_argument that lists the known keys.
Term find_term(std::string_view key);
const Model& find_model(std::string_view name);

/// Whether a parameter can have this name: a coefficient, a shape, or a coefficient that each
/// recording has for itself, as in "torque_offset[1]".
bool is_parameter(std::string_view name);

}  // namespace jointid::identify
