// Terms: bases and their derivatives, keys and names.

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "check.hpp"
#include "identify/balance/terms.hpp"

namespace jointid::tests {
namespace {

using model::SpeedBasis;

CHECK_CASE("terms: the general decay's derivatives are its differences") {
  const double shapes[] = {0.13, 1.7};
  for (const double v : {0.0, 0.01, 0.13, 0.9}) {
    for (int which = 0; which < 2; ++which) {
      double above[] = {shapes[0], shapes[1]};
      double below[] = {shapes[0], shapes[1]};
      above[which] += 1e-6;
      below[which] -= 1e-6;
      const auto value = [&](const double* s) {
        return model::basis_value(SpeedBasis::general, v, s);
      };
      CHECK_CLOSE(model::basis_slope(SpeedBasis::general, v, shapes, which),
                  (value(above) - value(below)) / 2e-6, 1e-8);
    }
  }
  const double gaussian[] = {0.1, 2.0};
  const double shape = 100.0;  // 1 / 0.1^2: exponent 2 is (4-1)
  CHECK_CLOSE(model::basis_value(SpeedBasis::general, 0.07, gaussian),
              model::basis_value(SpeedBasis::gaussian, 0.07, &shape), 1e-15);
}

CHECK_CASE("terms: the general decay and its derivatives are those of long double") {
  for (const double d : {0.1, 0.5, 1.0, 1.37, 2.0, 4.0, 8.0}) {
    for (double ratio = 1e-9; ratio < 60.0; ratio *= 1.21) {
      const double velocity = 0.037;
      const double speed = velocity * ratio;
      const long double logarithm = std::log(static_cast<long double>(speed) / velocity);
      const long double power = std::exp(d * logarithm);
      const long double value = std::exp(-power);
      const double shapes[] = {velocity, d};
      const auto slope = [&](int which) {
        return model::basis_slope(SpeedBasis::general, speed, shapes, which);
      };
      // Relative to 1, which the samples at rest have.
      CHECK_CLOSE(model::basis_value(SpeedBasis::general, speed, shapes),
                  static_cast<double>(value), 2e-15 * std::max(1.0, 0.5 * d));
      CHECK_CLOSE(slope(0), static_cast<double>(value * power * d / velocity),
                  1e-14 * std::max(1.0, d) * d / velocity);
      CHECK_CLOSE(slope(1), static_cast<double>(-value * power * logarithm), 4e-14);
    }
  }
  const double shapes[] = {0.037, 0.5};
  for (const double speed : {0.0, 1e-320}) {
    CHECK(model::basis_value(SpeedBasis::general, speed, shapes) == 1.0);
    CHECK_CLOSE(model::basis_slope(SpeedBasis::general, speed, shapes, 0), 0.0, 1e-200);
    CHECK_CLOSE(model::basis_slope(SpeedBasis::general, speed, shapes, 1), 0.0, 1e-200);
  }
  const double sudden[] = {1e-6, 4.0};  // the power overflows
  CHECK_CLOSE(model::basis_value(SpeedBasis::general, 1e6, sudden), 0.0, 1e-200);
  CHECK_CLOSE(model::basis_slope(SpeedBasis::general, 1e6, sudden, 1), 0.0, 1e-200);
}

CHECK_CASE("terms: the rise is a hyperbolic tangent, and its derivatives are its differences") {
  const double least = 1e-7;
  for (const double width : {0.01, 0.13, 2.0}) {
    for (const double v : {0.0, 0.003, 0.13, 0.9, 50.0}) {
      const auto value = [&](double speed, double w) {
        return model::basis_value(SpeedBasis::rising, speed, &w);
      };
      CHECK_CLOSE(value(v, width), std::tanh(v / width), 4e-16);
      CHECK_CLOSE(model::basis_slope(SpeedBasis::rising, v, &width, 0),
                  (value(v, width + least) - value(v, width - least)) / (2.0 * least), 1e-4);
      CHECK_CLOSE(model::basis_rate(SpeedBasis::rising, v, &width),
                  (value(v + least, width) - value(v - least, width)) / (2.0 * least), 1e-4);
    }
  }
}

// The rows below are read from the table, so a new row is checked automatically.

CHECK_CASE(
    "terms: every row has a meaning, a motion that determines it, and an option that adds it") {
  std::set<std::string> keys;
  for (const auto& term : identify::term_table()) {
    CHECK_WITH(keys.insert(term.key).second, term.key + " is there twice");
    CHECK_WITH(!term.meaning.empty() && !term.advice.empty(), term.key);
    CHECK_WITH(!term.unit.empty() && !term.unit_prismatic.empty(), term.key);
    CHECK_WITH(!term.option.empty() || term.key == "inertia", term.key);
    for (const auto& shape : term.shapes) CHECK(identify::find_shape(shape).name == shape);
  }
  for (const auto& shape : identify::shape_table()) {
    CHECK_WITH(!shape.meaning.empty() && !shape.advice.empty(), shape.name);
    CHECK_WITH(shape.speed_power != 0.0 || shape.lower < shape.upper, shape.name + " has no room");
  }
  CHECK_REFUSED(identify::find_shape("width"), "unknown shape 'width'");
}

CHECK_CASE("terms: capabilities are refused by default") {
  const identify::Term bare{};
  CHECK(!bare.simulated);
  CHECK(bare.control == identify::Control::refused);
}

CHECK_CASE("terms: the terms of every model exist for both directions separately") {
  for (const auto& model : identify::model_table()) {
    CHECK(identify::model_terms(model.name, false) == model.terms);
    const auto apart = identify::model_terms(model.name, true);
    CHECK(apart.size() == 2 * model.terms.size());
    for (std::size_t i = 0; i < apart.size(); ++i) {
      const auto base = identify::find_term(model.terms[i / 2]);
      const auto row = identify::find_term(apart[i]);
      CHECK_WITH(base.option == "name", base.key);
      CHECK(row.direction ==
            (i % 2 == 0 ? model::Direction::positive : model::Direction::negative));
      CHECK(row.shapes == base.shapes && row.unit == base.unit && row.advice == base.advice);
      CHECK(row.simulated == base.simulated && row.control == base.control);
    }
  }
  CHECK_REFUSED(identify::model_terms("dahl", false), "dahl");
}

CHECK_CASE("terms: friction of each direction is that of both, and odd in the velocity") {
  const Eigen::VectorXd speed = Eigen::VectorXd::LinSpaced(40, 0.01, 2.0);
  for (const auto& term : identify::term_table()) {
    if (!identify::is_friction(term) || term.direction != model::Direction::both) continue;
    const Eigen::VectorXd shapes =
        Eigen::VectorXd::Constant(static_cast<Eigen::Index>(term.shapes.size()), 0.7);
    const auto at = [&](const identify::Term& row, const Eigen::VectorXd& velocity) {
      return identify::friction_basis(row, velocity, shapes, 3.0);
    };
    const Eigen::VectorXd forward = at(term, speed);
    CHECK_WITH(forward.minCoeff() > 0.0, term.key);
    CHECK_WITH(at(term, -speed) == -forward, term.key);
    CHECK_WITH(at(term, Eigen::VectorXd::Zero(1))[0] == 0.0, term.key);
    if (identify::needs_load(term)) continue;
    const auto positive = identify::find_term(term.key + "_positive");
    const auto negative = identify::find_term(term.key + "_negative");
    CHECK_WITH(at(positive, speed) == forward && at(positive, -speed).isZero(0.0), term.key);
    CHECK_WITH(at(negative, -speed) == -forward && at(negative, speed).isZero(0.0), term.key);
  }
}

CHECK_CASE("terms: a general decay with the exponent 2 is the Gaussian one") {
  const Eigen::VectorXd velocity = Eigen::VectorXd::LinSpaced(41, -2.0, 2.0);
  for (const std::string side : {"", "_positive", "_negative"}) {
    const auto general = identify::find_term("static_general" + side);
    const auto gaussian = identify::find_term("static" + side);
    const Eigen::VectorXd expected =
        identify::friction_basis(gaussian, velocity, Eigen::VectorXd::Constant(1, 1.0 / 0.49));
    const Eigen::VectorXd found =
        identify::friction_basis(general, velocity, Eigen::Vector2d(0.7, 2.0));
    CHECK_WITH((found - expected).cwiseAbs().maxCoeff() < 1e-15, side);
    const Eigen::VectorXd near =
        identify::friction_basis(general, velocity, Eigen::Vector2d(0.7, 2.0 + 1e-12));
    CHECK_WITH((near - found).cwiseAbs().maxCoeff() < 1e-11, side);
    const Eigen::VectorXd slow = identify::friction_basis(general, Eigen::Vector3d(-1.0, 0.0, 1.0),
                                                          Eigen::Vector2d(1e-160, 2.0));
    CHECK_WITH(slow.isZero(0.0), side);
  }
}

CHECK_CASE("terms: load friction grows with the load, whatever its sign") {
  const auto term = identify::find_term("load_friction");
  const Eigen::Vector3d velocity(-2.0, 0.0, 0.5);
  const Eigen::VectorXd none;
  CHECK(identify::is_friction(term) && identify::needs_load(term));
  CHECK(identify::friction_basis(term, velocity, none).isZero(0.0));
  for (const double load : {-40.0, 40.0}) {
    CHECK(identify::friction_basis(term, velocity, none, load) ==
          Eigen::Vector3d(-40.0, 0.0, 40.0));
  }
  CHECK_REFUSED(identify::friction_basis(identify::find_term("inertia"), velocity, none),
                "'inertia' is not a friction term");
}

CHECK_CASE("terms: the slope of every basis is the difference of its values") {
  for (const auto& term : identify::term_table()) {
    for (std::size_t which = 0; which < term.shapes.size(); ++which) {
      std::vector<double> above(term.shapes.size(), 0.9);
      std::vector<double> below(term.shapes.size(), 0.9);
      above[which] += 1e-6;
      below[which] -= 1e-6;
      const std::vector<double> middle(term.shapes.size(), 0.9);
      const double difference = (model::basis_value(term.basis, 0.6, above.data()) -
                                 model::basis_value(term.basis, 0.6, below.data())) /
                                2e-6;
      CHECK_CLOSE(model::basis_slope(term.basis, 0.6, middle.data(), static_cast<int>(which)),
                  difference, 1e-8);
    }
  }
}

CHECK_CASE("terms: keys and names") {
  CHECK(identify::find_term("static_general").name == "static");
  CHECK(identify::find_term("ripple_cos_2").order == 2.0);
  CHECK(identify::find_term("ripple_cos_1e-05").order == 1e-05);
  CHECK(identify::find_term("ripple_cos_0.1234567890123456789").order == 0.1234567890123456789);
  for (const char* bad :
       {"ripple_cos", "ripple_cos_", "ripple_cos_x", "ripple_cos_-2", "coulom", "", "ripple_cos_ 2",
        "ripple_cos_+2", "ripple_cos_0x2", "ripple_cos_2,5", "ripple_cos_2e", "ripple_cos_1.2.3",
        "ripple_cos_inf", "ripple_cos_nan", "ripple_cos_1e999", "ripple_cos_0", "ripple_cos_1e6"}) {
    CHECK_REFUSED(identify::find_term(bad), "choose one of inertia, ");
  }
  for (const char* good :
       {"inertia", "stribeck", "stribeck_exponent", "ripple_sin_2.5", "torque_offset[12]"}) {
    CHECK(identify::is_parameter(good));
  }
  for (const char* bad :
       {"static_general", "ripple_sin", "torque_offset[]", "torque_offset[x]", "x[1]", ""}) {
    CHECK(!identify::is_parameter(bad));
  }
}

}  // namespace
}  // namespace jointid::tests
