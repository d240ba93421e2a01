#pragma once
// The regressor is a list of named terms in the torque balance  integral(torque) = sum of terms.
// Each term is a coefficient times a basis, integrated over each window. A new term is one row of
// the table in terms.cpp. A new function of the speed is a basis in model/friction.hpp; any other
// new integral is a case in quadrature.cpp. Bounds, report, JSON, plots, advice, command line,
// robots, servos, simulation, design and exports follow from the row.

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "model/friction.hpp"

namespace jointid::identify {

/// Integral of a term's basis over a window.
enum class Integral {
  velocity_change,  ///< [v]: no acceleration needed
  friction,         ///< integral of sgn v h(|v|), h a SpeedBasis, in one Direction or both
  load_friction,    ///< none: it acts on the sum of all other terms, see load_friction.hpp
  link_friction,    ///< none: the same, for the torque behind the gear
  displacement,     ///< [q] = integral of v
  duration,         ///< T
  cosine,           ///< integral of cos(frequency q)
  sine,             ///< integral of sin(frequency q)
  sensor,           ///< integral of the raw sensor reading
  own,              ///< rise of a series of the recording, see OwnSeries
};

/// Angle that the order of a harmonic counts: revolutions of the joint, or of the motor in front of
/// the gear.
enum class Harmonic { none, joint, motor };

/// Treatment of a term by a model-based controller. The default is `refused`, because a controller
/// must not omit a term without a decision.
enum class Control {
  refused,      ///< no controller has the term, and it must not be omitted
  feedback,     ///< omitted: the controller's feedback corrects it
  compensated,  ///< the controllers have the term
};

/// One row: a coefficient and its basis. A row with a Harmonic represents a family with one term
/// per order. A row with Integral::own represents a family with one term per named signal.
struct Term {
  std::string key;   ///< unique key by which a model lists the term
  std::string name;  ///< the parameter's name; two bases of the same quantity share it
  Integral integral;
  model::SpeedBasis basis = model::SpeedBasis::constant;  ///< for Integral::friction
  model::Direction direction = model::Direction::both;    ///< for Integral::friction
  std::vector<std::string> shapes{};                      ///< names of the basis's shape parameters
  Harmonic harmonic = Harmonic::none;
  double order = 1.0;         ///< angle of the harmonic
  bool non_negative = false;  ///< a negative value has no physical meaning
  std::string unit;           ///< revolute
  std::string unit_prismatic;
  std::string meaning;  ///< one line for reports
  std::string advice;   ///< motion that determines the coefficient
  /// Option that adds the term. "name": a friction model lists it. Any other text: the option or
  /// property of the joint's model that switches it on. Empty: every balance has it.
  std::string option{};
  bool given = false;      ///< the gain of a known quantity: 1, unless a call frees it
  bool simulated = false;  ///< the simulated joint has it
  Control control = Control::refused;
};

/// A parameter of a basis. Its default bounds are (share * peak speed)^speed_power for two shares
/// of the peak speed. If speed_power is 0, they are `lower` and `upper`.
struct Shape {
  std::string name;
  std::string unit;
  std::string unit_prismatic;
  std::string meaning;
  std::string advice;  ///< motion that determines the parameter
  double speed_power = 0.0;
  double lower = 0.0;
  double upper = 0.0;
  double typical = 0.0;  ///< if speed_power is 0
};

/// A friction model: its name and the keys of its terms.
struct Model {
  std::string name;
  std::string equation;  ///< equation of the thesis
  std::vector<std::string> terms;
};

const std::vector<Term>& term_table();
const std::vector<Shape>& shape_table();
const std::vector<Model>& model_table();

/// Whether a row represents one term per named signal, as "viscous_of" for "viscous_of_q6".
bool is_own(const Term& term);
/// Whether a term opposes motion, and so belongs to the friction map f(v, load).
bool is_friction(const Term& term);
/// Whether the friction also depends on the torque that the drive transmits.
bool needs_load(const Term& term);
/// 1 or -1 for friction of only one direction of motion, otherwise 0.
inline int side_of(const Term& term) {
  if (term.direction == model::Direction::both) return 0;
  return term.direction == model::Direction::positive ? 1 : -1;
}
/// The friction's basis for exports, as a product in the notation of C: `speed`, `load_size` and
/// shape parameters by their names; empty: 1.
std::string expression_of(const Term& term);

/// The friction term's basis, the factor of its coefficient, at each velocity; 0 at rest. `load` is
/// the torque that the drive transmits [N·m or N].
Eigen::VectorXd friction_basis(const Term& term, const Eigen::VectorXd& velocity,
                               const Eigen::VectorXd& shapes, double load = 0.0);

/// The term with this key. "ripple_sin_2" is order 2 of the family "ripple_sin"; "viscous_of_q6" is
/// the term of signal q6. Throws std::invalid_argument that lists the known keys.
Term find_term(std::string_view key);
const Shape& find_shape(std::string_view name);
const Model& find_model(std::string_view name);

/// Keys of a friction model's terms. `asymmetric`: two per term, one for each direction of motion.
std::vector<std::string> model_terms(std::string_view name, bool asymmetric);

/// Whether a parameter can have this name: a coefficient, a shape, or a coefficient per recording,
/// as in "torque_offset[1]".
bool is_parameter(std::string_view name);

}  // namespace jointid::identify
