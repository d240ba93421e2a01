// Elimination of the linear parameters, compared with known parameters and with an exhaustive
// search.

#include <Eigen/QR>
#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include "check.hpp"
#include "identify/penalty/penalty.hpp"
#include "identify/solve/separable.hpp"
#include "reference.hpp"
#include "synthetic.hpp"

namespace jointid::tests {
namespace separable {

using identify::minimise_separable;
using identify::Penalty;
using identify::Residual;
using search::Domain;

using Names = std::vector<std::string>;
const Names kStribeck{"coulomb", "static", "viscous", "sensor_gain", "sensor_offset"};
const Names kCoulomb{"inertia", "coulomb", "viscous", "sensor_gain", "sensor_offset"};

/// Without inertia: the command that remains, as for a joint with a known inertia.
Penalty stribeck_penalty(Truth truth, Residual residual, double noise) {
  truth.inertia = 0.0;
  auto r = moving(2000, 0.001, true, 4);
  add_torque(r, truth, true);
  add_noise(r, noise, 4);
  return Penalty({r}, kStribeck, {0, 0.02}, residual, true);
}

Penalty coulomb_penalty(Truth truth, Residual residual, double noise) {
  truth.static_excess = 0.0;
  auto r = moving(2000, 0.001, true, 5);
  add_torque(r, truth, true);
  add_noise(r, noise, 5);
  return Penalty({r}, kCoulomb, {0, 0.02}, residual, true);
}

Eigen::VectorXd vector(std::initializer_list<double> values) {
  return Eigen::Map<const Eigen::VectorXd>(std::data(values), std::ssize(values));
}

Domain around(const Eigen::VectorXd& truth) {
  const Eigen::VectorXd reach = truth.cwiseAbs() * 0.9;
  return {truth - reach, truth + reach};
}

/// The penalty's minimum over the coefficients for these shapes: exhaustive over the bounds, with
/// golden sections over 1/gain if the residual is divided by it.
Eigen::VectorXd exhaustive(const Penalty& penalty, const Eigen::VectorXd& shapes,
                           const Domain& domain) {
  Eigen::MatrixXd columns;
  penalty.columns(shapes, columns);
  const Eigen::Index p = penalty.coefficients();
  const Eigen::Index gain = penalty.gain_index();
  // Many rows, few columns: reduced to a square problem first.
  Eigen::MatrixXd all(columns.rows(), p + 1);
  all << columns, penalty.target();
  const Eigen::MatrixXd r =
      all.householderQr().matrixQR().topRows(p + 1).triangularView<Eigen::Upper>();
  const auto solve = [&](double fixed_gain, bool fix) {
    Eigen::VectorXd lower = domain.lower.head(p);
    Eigen::VectorXd upper = domain.upper.head(p);
    if (fix) lower[gain] = upper[gain] = fixed_gain;
    return box_reference(r.leftCols(p), r.col(p), lower, upper);
  };
  if (penalty.residual() == Residual::torque) return solve(0.0, false);
  const auto value = [&](double u) {
    return (r.leftCols(p) * solve(1.0 / u, true) - r.col(p)).squaredNorm() * u * u;
  };
  double left = std::min(1.0 / domain.lower[gain], 1.0 / domain.upper[gain]);
  double right = std::max(1.0 / domain.lower[gain], 1.0 / domain.upper[gain]);
  constexpr double kSection = 0.6180339887498949;
  for (int i = 0; i < 60; ++i) {
    const double a = right - kSection * (right - left);
    const double b = left + kSection * (right - left);
    if (value(a) <= value(b)) {
      right = b;
    } else {
      left = a;
    }
  }
  return solve(2.0 / (left + right), true);
}

void compare_at(const Penalty& penalty, const Eigen::VectorXd& shapes, const Domain& domain) {
  const Eigen::Index p = penalty.coefficients();
  Eigen::VectorXd expected(penalty.parameters());
  expected << exhaustive(penalty, shapes, domain), shapes;
  Eigen::VectorXd found(penalty.parameters());
  found << identify::best_coefficients(penalty, shapes, domain), shapes;
  const double least = penalty(expected);
  CHECK_WITH(penalty(found) <= least * (1.0 + 1e-9),
             std::to_string(penalty(found)) + " against " + std::to_string(least));
  for (Eigen::Index i = 0; i < p; ++i) {
    CHECK(found[i] >= domain.lower[i] && found[i] <= domain.upper[i]);
    CHECK_CLOSE(found[i], expected[i], 1e-4 * (domain.upper[i] - domain.lower[i]));
  }
}

CHECK_CASE("separable: recovers the truth without a shape, positive and negative gains") {
  base::Pool pool(2);
  for (const double gain : {1.4, -0.7}) {
    Truth truth;
    truth.sensor_gain = gain;
    const auto theta = vector(
        {truth.inertia, truth.coulomb, truth.viscous, truth.sensor_gain, truth.sensor_offset});
    for (const auto residual : {Residual::torque, Residual::sensor}) {
      const auto penalty = coulomb_penalty(truth, residual, 0.0);
      const auto result = minimise_separable(penalty, around(theta), pool);
      CHECK(result.evaluations == 1);
      for (Eigen::Index i = 0; i < theta.size(); ++i) {
        CHECK_CLOSE(result.best[i], theta[i], 1e-9 * std::fabs(theta[i]));
      }
    }
  }
}

CHECK_CASE("separable: recovers the truth with one shape, positive and negative gains") {
  base::Pool pool(2);
  for (const double gain : {1.4, -0.7}) {
    Truth truth;
    truth.sensor_gain = gain;
    const auto theta = vector({truth.coulomb, truth.static_excess, truth.viscous, truth.sensor_gain,
                               truth.sensor_offset, truth.stribeck});
    for (const auto residual : {Residual::torque, Residual::sensor}) {
      const auto penalty = stribeck_penalty(truth, residual, 0.0);
      auto domain = around(theta);
      domain.lower[5] = 0.0;
      domain.upper[5] = 200.0;
      const auto result = minimise_separable(penalty, domain, pool);
      CHECK_CLOSE(result.penalty / penalty.target().squaredNorm(), 0.0, 1e-16);
      for (Eigen::Index i = 0; i < theta.size(); ++i) {
        CHECK_CLOSE(result.best[i], theta[i], 1e-6 * std::fabs(theta[i]));
      }
    }
  }
}

CHECK_CASE("separable: active bounds, compared with the exhaustive search") {
  base::Random random(6, 0, 0, 0);
  for (int trial = 0; trial < 30; ++trial) {
    Truth truth;
    if (trial % 2 == 1) truth.sensor_gain = -1.4;
    const auto theta = vector({truth.coulomb, truth.static_excess, truth.viscous, truth.sensor_gain,
                               truth.sensor_offset});
    auto domain = around(theta);
    for (Eigen::Index i = 0; i < 5; ++i) {  // each side of the box may exclude the truth
      const double width = domain.upper[i] - domain.lower[i];
      const double cut = random.uniform();
      if (cut < 0.25) domain.upper[i] = theta[i] - width * (0.05 + 0.1 * random.uniform());
      if (cut > 0.75) domain.lower[i] = theta[i] + width * (0.05 + 0.1 * random.uniform());
    }
    for (const auto residual : {Residual::torque, Residual::sensor}) {
      compare_at(stribeck_penalty(truth, residual, 1.0), vector({20.0 + 60.0 * random.uniform()}),
                 domain);
    }
  }
}

CHECK_CASE("separable: a sensor that reads raw counts") {
  Truth truth;
  truth.sensor_gain = 1.4e-6;  // the reading in millionths
  const auto theta = vector(
      {truth.coulomb, truth.static_excess, truth.viscous, truth.sensor_gain, truth.sensor_offset});
  truth.inertia = 0.0;
  auto r = moving(2000, 0.001, true, 7);
  add_torque(r, truth, true, 1e6);
  add_noise(r, 1.0, 7);
  auto domain = around(theta);
  domain.upper[0] = 20.0;  // bounds are active
  domain.lower[4] = -2.0;
  domain.upper[4] = 10.0;
  for (const auto residual : {Residual::torque, Residual::sensor}) {
    compare_at(Penalty({r}, kStribeck, {0, 0.02}, residual, true), vector({truth.stribeck}),
               domain);
  }
}

CHECK_CASE("separable: fixed parameters stay, the others are the best for them") {
  const Truth truth;
  const auto theta = vector({truth.coulomb, truth.static_excess, truth.viscous, truth.sensor_gain,
                             truth.sensor_offset, truth.stribeck});
  base::Pool pool(1);
  for (const auto residual : {Residual::torque, Residual::sensor}) {
    const auto penalty = stribeck_penalty(truth, residual, 0.5);
    for (Eigen::Index i = 0; i < theta.size(); ++i) {
      auto domain = around(theta);
      domain.lower[i] = domain.upper[i] = 1.1 * theta[i];
      const auto result = minimise_separable(penalty, domain, pool);
      CHECK(result.best[i] == 1.1 * theta[i]);
      compare_at(penalty, result.best.tail(1), {domain.lower.head(5), domain.upper.head(5)});
    }
    const Domain fixed{theta, theta};
    CHECK(minimise_separable(penalty, fixed, pool).best == theta);
  }
}

CHECK_CASE("separable: a shape at its bound is the bound itself") {
  const Truth truth;
  const auto theta = vector({truth.coulomb, truth.static_excess, truth.viscous, truth.sensor_gain,
                             truth.sensor_offset, truth.stribeck});
  base::Pool pool(2);
  const auto penalty = stribeck_penalty(truth, Residual::sensor, 0.1);
  auto domain = around(theta);
  domain.upper[5] = 41.7;
  CHECK(minimise_separable(penalty, domain, pool).best[5] == 41.7);
  domain.lower[5] = 83.3;
  domain.upper[5] = 120.0;
  CHECK(minimise_separable(penalty, domain, pool).best[5] == 83.3);
}

CHECK_CASE("separable: the same bits for any number of threads") {
  const Truth truth;
  const auto penalty = stribeck_penalty(truth, Residual::sensor, 1.0);
  const Domain domain{vector({0, 0, 0, 0.1, -30, 0}), vector({50, 40, 40, 5, 30, 200})};
  base::Pool one(1);
  const auto expected = minimise_separable(penalty, domain, one);
  CHECK(expected.penalty == penalty(expected.best));
  for (const int threads : {2, 7}) {
    base::Pool pool(threads);
    CHECK(minimise_separable(penalty, domain, pool).best == expected.best);
  }
}

CHECK_CASE("separable: impossible domains are refused with a name") {
  base::Pool pool(2);
  const auto sensor = stribeck_penalty({}, Residual::sensor, 0.0);
  Domain domain{vector({0, 0, 0, -0.1, -30, 0}), vector({50, 40, 40, 5, 30, 200})};
  CHECK_REFUSED(minimise_separable(sensor, domain, pool), "sensor_gain: its bounds");
  domain.lower[3] = 0.0;
  CHECK_REFUSED(minimise_separable(sensor, domain, pool), "must not contain 0");
  domain.lower[3] = 6.0;
  CHECK_REFUSED(minimise_separable(sensor, domain, pool), "bounds of parameter 3");
  CHECK_REFUSED(minimise_separable(sensor, {vector({0}), vector({1})}, pool),
                "6 parameters, got 1");
}

}  // namespace separable
}  // namespace jointid::tests
