#include "identify/balance/terms.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/digits.hpp"
#include "base/input_error.hpp"

namespace jointid::identify {

namespace {

using model::Direction;
using model::SpeedBasis;

constexpr const char* kLoads = "motion that drives a load and is driven by it, such as up and down";
constexpr const char* kSlow = "slow motion through speeds near zero, in both directions";

// A new row is neither simulated nor accepted by controllers, unless `simulated` sets both.

Term torque(std::string name, std::string option, Integral integral, std::string meaning,
            std::string advice) {
  return {.key = name,
          .name = name,
          .integral = integral,
          .unit = "N·m",
          .unit_prismatic = "N",
          .meaning = std::move(meaning),
          .advice = std::move(advice),
          .option = std::move(option)};
}

Term friction(std::string key, std::string name, SpeedBasis basis, std::vector<std::string> shapes,
              std::string meaning, std::string advice) {
  const auto& facts = model::facts_of(basis);
  return {.key = std::move(key),
          .name = std::move(name),
          .integral = Integral::friction,
          .basis = basis,
          .shapes = std::move(shapes),
          .non_negative = true,
          .unit = facts.unit,
          .unit_prismatic = facts.unit_prismatic,
          .meaning = std::move(meaning),
          .advice = std::move(advice),
          .option = "name"};
}

Term harmonic(std::string key, std::string option, Integral integral, Harmonic counts,
              std::string meaning, std::string advice) {
  Term term =
      torque(std::move(key), std::move(option), integral, std::move(meaning), std::move(advice));
  term.harmonic = counts;
  return term;
}

/// A term of a signal of the recording; its name follows the key.
Term own(std::string key, std::string unit, std::string unit_prismatic, std::string meaning) {
  Term term = torque(std::move(key), "terms", Integral::own, std::move(meaning),
                     "motion in which this signal changes apart from the others");
  term.unit = std::move(unit);
  term.unit_prismatic = std::move(unit_prismatic);
  term.given = term.key.starts_with("known");
  return term;
}

Term simulated(Term term, Control control) {
  term.simulated = true;
  term.control = control;
  return term;
}

/// The row of one direction of motion.
Term directed(Term row, Direction direction) {
  const std::string side = direction == Direction::positive ? "positive" : "negative";
  row.key += "_" + side;
  row.name += "_" + side;
  row.meaning += ", " + side + " velocity";
  row.integral = Integral::friction;  // travel in one direction is not the displacement
  row.direction = direction;
  return row;
}

/// The written rows: friction in both directions.
std::vector<Term> base_rows() {
  const std::string angles = "motion through a wider range of angles";
  const std::string turns = "motion through several turns of the motor";
  const std::string link = "motion of the link through a wider range of gravity torque";
  const auto inertia = [] {
    return Term{.key = "inertia",
                .name = "inertia",
                .integral = Integral::velocity_change,
                .non_negative = true,
                .unit = "kg·m²",
                .unit_prismatic = "kg",
                .meaning = "reflected inertia",
                .advice = "harder acceleration"};
  };
  const auto viscous = [] {
    Term term = friction("viscous", "viscous", SpeedBasis::linear, {}, "viscous friction",
                         "faster motion, at several speeds");
    term.integral = Integral::displacement;  // the same integral, without a sum over samples
    return term;
  };
  const auto load_friction = [] {
    return Term{.key = "load_friction",
                .name = "load_friction",
                .integral = Integral::load_friction,
                .non_negative = true,
                .unit = "1",
                .unit_prismatic = "1",
                .meaning = "friction per torque of the drive",
                .advice = kLoads,
                .option = "load_friction"};
  };
  const auto link_friction = [&] {
    Term term = load_friction();
    term.key = "load_friction_link";
    term.integral = Integral::link_friction;
    term.meaning = "friction per torque behind the gear";
    return term;
  };
  const auto gain = [&] {
    Term term =
        torque("sensor_gain", "sensor", Integral::sensor, "gain of the torque sensor", link);
    term.unit = "N·m/unit";
    term.unit_prismatic = "N/unit";
    return term;
  };
  return {
      simulated(inertia(), Control::compensated),
      simulated(friction("coulomb", "coulomb", SpeedBasis::constant, {}, "Coulomb friction",
                         "motion in both directions, at several speeds"),
                Control::compensated),
      simulated(friction("coulomb_rising", "coulomb", SpeedBasis::rising, {"rise_velocity"},
                         "Coulomb friction", "motion in both directions, at several speeds"),
                Control::refused),
      simulated(friction("static", "static", SpeedBasis::gaussian, {"stribeck"},
                         "static (above Coulomb)", kSlow),
                Control::compensated),
      simulated(
          friction("static_general", "static", SpeedBasis::general,
                   {"stribeck_velocity", "stribeck_exponent"}, "static (above Coulomb)", kSlow),
          Control::refused),
      simulated(viscous(), Control::compensated),
      simulated(load_friction(), Control::refused),
      link_friction(),
      simulated(torque("torque_offset", "torque_offset", Integral::duration,
                       "constant offset of the torque",
                       "as much motion in one direction as in the other"),
                Control::feedback),
      simulated(
          torque("gravity_cos", "gravity", Integral::cosine, "gravity torque, cos q part", angles),
          Control::feedback),
      simulated(
          torque("gravity_sin", "gravity", Integral::sine, "gravity torque, sin q part", angles),
          Control::feedback),
      simulated(harmonic("position_cos", "harmonics", Integral::cosine, Harmonic::joint,
                         "torque over the joint's angle", angles),
                Control::feedback),
      simulated(harmonic("position_sin", "harmonics", Integral::sine, Harmonic::joint,
                         "torque over the joint's angle", angles),
                Control::feedback),
      simulated(harmonic("ripple_cos", "ripple", Integral::cosine, Harmonic::motor,
                         "ripple over the motor's angle", turns),
                Control::feedback),
      simulated(harmonic("ripple_sin", "ripple", Integral::sine, Harmonic::motor,
                         "ripple over the motor's angle", turns),
                Control::feedback),
      simulated(gain(), Control::compensated),
      simulated(torque("sensor_offset", "sensor", Integral::duration, "offset of the torque sensor",
                       link),
                Control::compensated),
      own("viscous_of", "N·m/[]", "N/[]", "torque in proportion to"),
      own("coulomb_of", "N·m", "N", "torque by the sign of"),
      own("coupling_of", "N·m·s/[]", "N·s/[]", "torque in proportion to the change of"),
      own("known_of", "1", "1", "known torque"),
      own("scale_of", "1", "1", "gain of the torque"),
      own("known_inertia_of", "1", "1", "known inertia"),
      own("scale_inertia_of", "1", "1", "gain of the inertia"),
      own("inertia_cos_of", "kg·m²", "kg", "inertia, cosine over"),
      own("inertia_sin_of", "kg·m²", "kg", "inertia, sine over"),
      own("torque_cos_of", "N·m", "N", "torque, cosine over"),
      own("torque_sin_of", "N·m", "N", "torque, sine over"),
  };
}

/// Each friction that depends only on the velocity is followed by one row per direction.
std::vector<Term> make_terms() {
  std::vector<Term> table;
  for (auto& row : base_rows()) {
    table.push_back(row);
    if (!is_friction(row) || needs_load(row)) continue;
    table.push_back(directed(row, Direction::positive));
    table.push_back(directed(row, Direction::negative));
  }
  return table;
}

/// The number after the last underscore of a harmonic's key.
bool read_order(std::string_view text, double& order) {
  order = base::read_digits(text).value_or(0.0);
  return order > 0.0 && order < 1e6;
}

/// The name of the signal after an own row's key and an underscore; empty if there is none.
std::string_view signal_of(const Term& row, std::string_view key) {
  const auto size = row.key.size();
  if (!is_own(row) || key.size() < size + 2 || !key.starts_with(row.key) || key[size] != '_') {
    return {};
  }
  const auto signal = key.substr(size + 1);
  const auto digit = [](char c) { return c >= '0' && c <= '9'; };
  const bool name = !digit(signal[0]) && std::all_of(signal.begin(), signal.end(), [&](char c) {
    return c == '_' || digit(c) || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
  });
  return name ? signal : std::string_view{};
}

/// The term of one signal.
Term of_signal(Term row, std::string_view signal) {
  row.key += "_" + std::string(signal);
  row.name = row.key;
  row.meaning += " " + std::string(signal);
  for (auto* unit : {&row.unit, &row.unit_prismatic}) {
    if (const auto at = unit->find("[]"); at != std::string::npos) unit->insert(at + 1, signal);
  }
  return row;
}

}  // namespace

const std::vector<Term>& term_table() {
  static const std::vector<Term> table = make_terms();
  return table;
}

const std::vector<Shape>& shape_table() {
  static const std::vector<Shape> table{
      {.name = "stribeck",
       .unit = "s²/rad²",
       .unit_prismatic = "s²/m²",
       .meaning = "how fast static friction decays with speed",
       .advice = kSlow,
       .speed_power = -2.0},
      {.name = "stribeck_velocity",
       .unit = "rad/s",
       .unit_prismatic = "m/s",
       .meaning = "speed at which static friction has decayed",
       .advice = kSlow,
       .speed_power = 1.0},
      // Bounds: exponents published for real joints (Armstrong-Helouvry 1991).
      {.name = "stribeck_exponent",
       .unit = "1",
       .unit_prismatic = "1",
       .meaning = "how abruptly static friction decays",
       .advice = kSlow,
       .lower = 0.5,
       .upper = 4.0,
       .typical = 2.0},
      {.name = "rise_velocity",
       .unit = "rad/s",
       .unit_prismatic = "m/s",
       .meaning = "speed at which Coulomb friction has risen to 76 %",
       .advice = kSlow,
       .speed_power = 1.0},
      // At 1 a joint locks in one quadrant.
      {.name = "load_friction",
       .unit = "1",
       .unit_prismatic = "1",
       .meaning = "friction per load",
       .advice = kLoads,
       .lower = 0.0,
       .upper = 0.95},
      {.name = "link_share",
       .unit = "1",
       .unit_prismatic = "1",
       .meaning = "share of the inertia behind the gear",
       .advice = "hard acceleration against different loads",
       .lower = 0.0,
       .upper = 1.0},
  };
  return table;
}

const std::vector<Model>& model_table() {
  static const std::vector<Model> table{
      {"coulomb_viscous", "(2-1)", {"coulomb", "viscous"}},
      {"stribeck", "(4-1)", {"coulomb", "static", "viscous"}},
      {"stribeck_general", "(2-3)", {"coulomb", "static_general", "viscous"}},
      {"smooth_coulomb_viscous", "", {"coulomb_rising", "viscous"}},
  };
  return table;
}

bool is_own(const Term& term) {
  return term.integral == Integral::own;
}

bool is_friction(const Term& term) {
  return term.integral == Integral::friction || term.integral == Integral::displacement ||
         needs_load(term);
}

bool needs_load(const Term& term) {
  return term.integral == Integral::load_friction || term.integral == Integral::link_friction;
}

std::string expression_of(const Term& term) {
  if (needs_load(term)) return "load_size";
  std::string text = model::facts_of(term.basis).expression;
  for (std::size_t i = 0; i < term.shapes.size(); ++i) {
    const std::string place = "{" + std::to_string(i) + "}";
    if (const auto at = text.find(place); at != std::string::npos) {
      text.replace(at, place.size(), term.shapes[i]);
    }
  }
  return text;
}

Term find_term(std::string_view key) {
  for (const auto& row : term_table()) {
    if (row.harmonic == Harmonic::none) {
      if (!is_own(row) && row.key == key) return row;
      if (const auto signal = signal_of(row, key); !signal.empty()) return of_signal(row, signal);
      continue;
    }
    double order = row.order;
    if (key.size() > row.key.size() + 1 && key.starts_with(row.key) && key[row.key.size()] == '_' &&
        read_order(key.substr(row.key.size() + 1), order)) {
      Term term = row;
      term.order = order;
      term.key = term.name = std::string(key);
      return term;
    }
  }
  std::string known;
  for (const auto& row : term_table()) {
    known += (known.empty() ? "" : ", ") + row.key;
    if (row.harmonic != Harmonic::none) known += "_<order>";
    if (is_own(row)) known += "_<signal>";
  }
  throw base::InputError("choose one of " + known, "term", std::string(key));
}

const Shape& find_shape(std::string_view name) {
  std::string known;
  for (const auto& row : shape_table()) {
    if (row.name == name) return row;
    known += (known.empty() ? "" : ", ") + row.name;
  }
  throw std::invalid_argument("unknown shape '" + std::string(name) + "'; known: " + known);
}

const Model& find_model(std::string_view name) {
  std::string known;
  for (const auto& row : model_table()) {
    if (row.name == name) return row;
    known += (known.empty() ? "" : ", ") + row.name;
  }
  throw base::InputError("choose one of " + known, "model", std::string(name));
}

std::vector<std::string> model_terms(std::string_view name, bool asymmetric) {
  std::vector<std::string> keys;
  for (const auto& key : find_model(name).terms) {
    if (!asymmetric) {
      keys.push_back(find_term(key).key);
      continue;
    }
    keys.push_back(find_term(key + "_positive").key);
    keys.push_back(find_term(key + "_negative").key);
  }
  return keys;
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
    if (is_own(term)) return !signal_of(term, name).empty();
    if (term.harmonic == Harmonic::none) return term.name == name;
    double order = 0.0;
    return name.size() > term.key.size() + 1 && name.starts_with(term.key) &&
           name[term.key.size()] == '_' && read_order(name.substr(term.key.size() + 1), order);
  });
}

}  // namespace jointid::identify
