#pragma once
// The regressor is a list of named terms: each is a coefficient times a basis, integrated over each
// window, in the torque balance  integral(torque) = sum of terms.  A new term is one row of the
// table in terms.cpp; a new function of the speed is a basis in model/friction.hpp, any other new
// way to integrate a case in quadrature.cpp. Bounds, report, JSON, plots, advice, command line,
// robots, servos, simulation, design and exports follow from the row.

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
  load_friction,    ///< none: it acts on the sum of all other terms, see load_friction.hpp
  link_friction,    ///< none: the same, by the torque behind the gear
  displacement,     ///< [q] = integral of v
  duration,         ///< T
  cosine,           ///< integral of cos(frequency q)
  sine,             ///< integral of sin(frequency q)
  sensor,           ///< integral of the raw sensor reading
  own,              ///< how far a series of the recording rises, see OwnSeries
};

/// What the order of a harmonic counts: turns of the joint, or of the motor in front of the gear.
enum class Harmonic { none, joint, motor };

/// What a model-based controller does about a term. Refused unless the row says otherwise: a
/// controller must not omit a term without a decision.
enum class Control {
  refused,      ///< no controller has it, and it must not be omitted
  feedback,     ///< omitted: the controller's feedback corrects it
  compensated,  ///< the controllers have it
};

/// One row: a coefficient and its basis. Rows with a Harmonic stand for a family, one term an
/// order; rows with Integral::own for a family, too, one term a named signal.
struct Term {
  std::string key;   ///< unique: what a model lists
  std::string name;  ///< the parameter's name; two bases of the same quantity share it
  Integral integral;
  model::SpeedBasis basis = model::SpeedBasis::constant;  ///< for Integral::friction
  model::Direction direction = model::Direction::both;    ///< for Integral::friction
  std::vector<std::string> shapes{};                      ///< names of the basis's shape parameters
  Harmonic harmonic = Harmonic::none;
  double order = 1.0;         ///< of the harmonic
  bool non_negative = false;  ///< a negative value has no physical meaning
  std::string unit;           ///< revolute
  std::string unit_prismatic;
  std::string meaning;  ///< one line for reports
  std::string advice;   ///< which motion determines the coefficient
  /// What adds the term: "name" is a friction model that lists it, any other text the option or
  /// property of the joint's model that switches it on; empty: every balance has it.
  std::string option{};
  bool given = false;      ///< the gain of something known: 1, unless a call frees it
  bool simulated = false;  ///< the simulated joint has it
  Control control = Control::refused;
};

/// A parameter of a basis. Its default bounds are (share * peak speed)^speed_power for two shares
/// of the peak speed, or, where speed_power is 0, lower to upper.
struct Shape {
  std::string name;
  std::string unit;
  std::string unit_prismatic;
  std::string meaning;
  std::string advice;  ///< which motion determines it
  double speed_power = 0.0;
  double lower = 0.0;
  double upper = 0.0;
  double typical = 0.0;  ///< where speed_power is 0
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

/// Whether a row stands for a term a named signal, as "viscous_of" for "viscous_of_q6".
bool is_own(const Term& term);
/// Whether a term opposes motion, and so belongs to the friction map f(v, load).
bool is_friction(const Term& term);
/// Whether the friction depends on the torque that the drive transmits, too.
bool needs_load(const Term& term);
/// 1 or -1 for friction of one direction of motion alone, else 0.
inline int side_of(const Term& term) {
  if (term.direction == model::Direction::both) return 0;
  return term.direction == model::Direction::positive ? 1 : -1;
}
/// How an export writes the friction, as a product in the notation of C: `speed`, `load_size` and
/// shape parameters by their names; empty: 1.
std::string expression_of(const Term& term);

/// The friction term's basis at each velocity: what its coefficient multiplies. 0 at rest. `load`
/// is the torque that the drive transmits [N·m or N].
Eigen::VectorXd friction_basis(const Term& term, const Eigen::VectorXd& velocity,
                               const Eigen::VectorXd& shapes, double load = 0.0);

/// The term of that key; "ripple_sin_2" is order 2 of the family "ripple_sin", "viscous_of_q6" the
/// term of the signal q6. Throws
/// std::invalid_argument that lists the known keys.
Term find_term(std::string_view key);
const Shape& find_shape(std::string_view name);
const Model& find_model(std::string_view name);

/// Keys of a friction model's terms; `asymmetric`: two for each, one for each direction of motion.
std::vector<std::string> model_terms(std::string_view name, bool asymmetric);

/// Whether a parameter can have this name: a coefficient, a shape, or a coefficient that each
/// recording has for itself, as in "torque_offset[1]".
bool is_parameter(std::string_view name);

}  // namespace jointid::identify
