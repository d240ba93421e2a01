#include "identify/balance/terms.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

namespace jointid::identify {

namespace {

using model::Direction;
using model::SpeedBasis;

constexpr const char* kViscousUnit = "N·m·s/rad";
constexpr const char* kViscousUnitPrismatic = "N·s/m";

Term torque(std::string name, Integral integral, std::string meaning) {
  return {.key = name,
          .name = name,
          .integral = integral,
          .unit = "N·m",
          .unit_prismatic = "N",
          .meaning = std::move(meaning)};
}

Term friction(std::string key, std::string name, SpeedBasis basis, Direction direction,
              std::vector<std::string> shapes, std::string meaning) {
  const bool viscous = basis == SpeedBasis::speed;
  return {.key = std::move(key),
          .name = std::move(name),
          .integral = Integral::friction,
          .basis = basis,
          .direction = direction,
          .shapes = std::move(shapes),
          .non_negative = true,
          .unit = viscous ? kViscousUnit : "N·m",
          .unit_prismatic = viscous ? kViscousUnitPrismatic : "N",
          .meaning = std::move(meaning)};
}

Term harmonic(std::string key, Integral integral, Harmonic counts, std::string meaning) {
  Term term = torque(std::move(key), integral, std::move(meaning));
  term.harmonic = counts;
  return term;
}

std::vector<Term> make_terms() {
  const std::vector<std::string> general{"stribeck_velocity", "stribeck_exponent"};
  std::vector<Term> table{
      {.key = "inertia",
       .name = "inertia",
       .integral = Integral::velocity_change,
       .non_negative = true,
       .unit = "kg·m²",
       .unit_prismatic = "kg",
       .meaning = "reflected inertia"},
      friction("coulomb", "coulomb", SpeedBasis::one, Direction::both, {}, "Coulomb friction"),
      friction("coulomb_positive", "coulomb_positive", SpeedBasis::one, Direction::positive, {},
               "Coulomb friction, positive velocity"),
      friction("coulomb_negative", "coulomb_negative", SpeedBasis::one, Direction::negative, {},
               "Coulomb friction, negative velocity"),
      friction("static", "static", SpeedBasis::stribeck, Direction::both, {"stribeck"},
               "static friction in excess of Coulomb"),
      friction("static_positive", "static_positive", SpeedBasis::stribeck, Direction::positive,
               {"stribeck"}, "static excess, positive velocity"),
      friction("static_negative", "static_negative", SpeedBasis::stribeck, Direction::negative,
               {"stribeck"}, "static excess, negative velocity"),
      friction("static_general", "static", SpeedBasis::stribeck_general, Direction::both, general,
               "static friction in excess of Coulomb"),
      friction("static_general_positive", "static_positive", SpeedBasis::stribeck_general,
               Direction::positive, general, "static excess, positive velocity"),
      friction("static_general_negative", "static_negative", SpeedBasis::stribeck_general,
               Direction::negative, general, "static excess, negative velocity"),
      {.key = "viscous",
       .name = "viscous",
       .integral = Integral::displacement,
       .non_negative = true,
       .unit = kViscousUnit,
       .unit_prismatic = kViscousUnitPrismatic,
       .meaning = "viscous friction"},
      friction("viscous_positive", "viscous_positive", SpeedBasis::speed, Direction::positive, {},
               "viscous friction, positive velocity"),
      friction("viscous_negative", "viscous_negative", SpeedBasis::speed, Direction::negative, {},
               "viscous friction, negative velocity"),
      {.key = "load_friction",
       .name = "load_friction",
       .integral = Integral::load_friction,
       .non_negative = true,
       .unit = "1",
       .unit_prismatic = "1",
       .meaning = "friction per transmitted torque"},
      torque("torque_offset", Integral::duration, "constant offset of the torque"),
      torque("gravity_cos", Integral::cosine, "gravity torque, cos q part"),
      torque("gravity_sin", Integral::sine, "gravity torque, sin q part"),
      harmonic("position_cos", Integral::cosine, Harmonic::joint, "torque over the joint's angle"),
      harmonic("position_sin", Integral::sine, Harmonic::joint, "torque over the joint's angle"),
      harmonic("ripple_cos", Integral::cosine, Harmonic::motor, "ripple over the motor's angle"),
      harmonic("ripple_sin", Integral::sine, Harmonic::motor, "ripple over the motor's angle"),
      torque("sensor_gain", Integral::sensor, "gain of the torque sensor"),
      torque("sensor_offset", Integral::duration, "offset of the torque sensor"),
  };
  for (auto& term : table) {
    if (term.integral != Integral::sensor) continue;
    term.unit = "N·m/unit";
    term.unit_prismatic = "N/unit";
  }
  return table;
}

/// The number behind the last underscore, as written in a harmonic's key.
bool read_order(std::string_view text, double& order) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), order);
  return error == std::errc{} && end == text.data() + text.size() && order > 0.0 && order < 1e6;
}

}  // namespace

const std::vector<Term>& term_table() {
  static const std::vector<Term> table = make_terms();
  return table;
}

const std::vector<Shape>& shape_table() {
  static const std::vector<Shape> table{
      {"stribeck", "s²/rad²", "s²/m²", "how fast static friction decays with speed"},
      {"stribeck_velocity", "rad/s", "m/s", "speed at which static friction has decayed"},
      {"stribeck_exponent", "1", "1", "how abruptly static friction decays"},
  };
  return table;
}

const std::vector<Model>& model_table() {
  static const std::vector<Model> table{
      {"coulomb_viscous", "(2-1)", {"coulomb", "viscous"}},
      {"stribeck", "(4-1)", {"coulomb", "static", "viscous"}},
      {"stribeck_general", "(2-3)", {"coulomb", "static_general", "viscous"}},
  };
  return table;
}

bool is_friction(const Term& term) {
  return term.integral == Integral::friction || term.integral == Integral::displacement;
}

Eigen::VectorXd friction_basis(const Term& term, const Eigen::VectorXd& velocity,
                               const Eigen::VectorXd& shapes) {
  if (!is_friction(term)) {
    throw std::invalid_argument("'" + term.key + "' is not a friction term");
  }
  if (shapes.size() != static_cast<Eigen::Index>(term.shapes.size())) {
    throw std::invalid_argument("'" + term.key + "' has " + std::to_string(term.shapes.size()) +
                                " shape parameters, got " + std::to_string(shapes.size()));
  }
  if (term.integral == Integral::displacement) return velocity;
  return velocity.unaryExpr([&](double v) {
    if (v == 0.0 || (v > 0.0 && term.direction == Direction::negative) ||
        (v < 0.0 && term.direction == Direction::positive)) {
      return 0.0;
    }
    return std::copysign(model::basis_value(term.basis, std::fabs(v), shapes.data()), v);
  });
}

Term find_term(std::string_view key) {
  std::string known;
  for (const auto& row : term_table()) {
    if (row.harmonic == Harmonic::none && row.key == key) return row;
    Term term = row;
    if (row.harmonic != Harmonic::none && key.size() > row.key.size() + 1 &&
        key.starts_with(row.key) && key[row.key.size()] == '_' &&
        read_order(key.substr(row.key.size() + 1), term.order)) {
      term.key = term.name = std::string(key);
      return term;
    }
    known += (known.empty() ? "" : ", ") + row.key;
    if (row.harmonic != Harmonic::none) known += "_<order>";
  }
  throw std::invalid_argument("unknown term '" + std::string(key) + "'; known: " + known);
}

const Model& find_model(std::string_view name) {
  std::string known;
  for (const auto& row : model_table()) {
    if (row.name == name) return row;
    known += (known.empty() ? "" : ", ") + row.name;
  }
  throw std::invalid_argument("unknown friction model '" + std::string(name) +
                              "'; known: " + known);
}

bool is_parameter(std::string_view name) {
  if (const auto bracket = name.find('['); bracket != std::string_view::npos) {
    const auto digits = name.substr(bracket + 1, name.size() - bracket - 2);
    const bool number =
        name.ends_with(']') && !digits.empty() &&
        std::all_of(digits.begin(), digits.end(), [](char c) { return c >= '0' && c <= '9'; });
    return number && is_parameter(name.substr(0, bracket));
  }
  const auto& shapes = shape_table();
  if (std::any_of(shapes.begin(), shapes.end(), [&](const Shape& s) { return s.name == name; })) {
    return true;
  }
  const auto& terms = term_table();
  return std::any_of(terms.begin(), terms.end(), [&](const Term& term) {
    if (term.harmonic == Harmonic::none) return term.name == name;
    double order = 0.0;
    return name.size() > term.key.size() + 1 && name.starts_with(term.key) &&
           name[term.key.size()] == '_' && read_order(name.substr(term.key.size() + 1), order);
  });
}

}  // namespace jointid::identify
