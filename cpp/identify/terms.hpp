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
  friction,         ///< integral of sgn v h(|v|), h a SpeedBasis
  displacement,     ///< [q] = integral of v
  duration,         ///< T
  cosine,           ///< integral of cos q
  sine,             ///< integral of sin q
  sensor,           ///< integral of the raw sensor reading
};

/// One row: a coefficient, or a shape parameter that bends another row's basis.
struct Term {
  std::string_view name;
  Integral integral;
  model::SpeedBasis basis;  ///< for Integral::friction
  std::string_view shape;   ///< name of the shape parameter, empty without
  bool non_negative;        ///< a negative value has no physical meaning
  std::string_view unit;    ///< revolute
  std::string_view unit_prismatic;
  std::string_view meaning;  ///< one line for reports
};

struct Shape {
  std::string_view name;
  std::string_view unit;
  std::string_view unit_prismatic;
  std::string_view meaning;
};

/// A friction model by name, as the terms it consists of.
struct Model {
  std::string_view name;
  std::string_view equation;  ///< of the thesis
  std::vector<std::string_view> terms;
};

const std::vector<Term>& term_table();
const std::vector<Shape>& shape_table();
const std::vector<Model>& model_table();

/// True for the terms that make up the friction map f(v).
bool is_friction(const Term& term);

/// The friction term's basis at each velocity, odd in it: what its coefficient multiplies. 0 at
/// rest.
Eigen::VectorXd friction_basis(const Term& term, const Eigen::VectorXd& velocity, double shape);

/// Row of that name; throws std::invalid_argument that lists the known names.
const Term& find_term(std::string_view name);
const Model& find_model(std::string_view name);

}  // namespace jointid::identify
