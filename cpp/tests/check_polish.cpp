// The local search in a box, compared with exhaustive answers and known minima.

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/random.hpp"
#include "check.hpp"
#include "identify/penalty/penalty.hpp"
#include "reference.hpp"
#include "search/polish.hpp"
#include "synthetic.hpp"

namespace jointid::tests {
namespace {

using search::Domain;
using search::polish;
using search::ResidualFunction;

Domain box(std::initializer_list<double> lower, std::initializer_list<double> upper) {
  return {Eigen::Map<const Eigen::VectorXd>(std::data(lower), std::ssize(lower)),
          Eigen::Map<const Eigen::VectorXd>(std::data(upper), std::ssize(upper))};
}

void rosenbrock(const Eigen::VectorXd& x, Eigen::VectorXd& residual, Eigen::MatrixXd* jacobian) {
  residual.resize(2);
  residual << 10.0 * (x[1] - x[0] * x[0]), 1.0 - x[0];
  if (jacobian == nullptr) return;
  jacobian->resize(2, 2);
  *jacobian << -20.0 * x[0], 10.0, -1.0, 0.0;
}

CHECK_CASE("polish: bounded linear least squares, from inside, from bounds and from corners") {
  base::Pool pool(1);
  for (std::uint32_t trial = 0; trial < 200; ++trial) {
    base::Random random(1, 0, 0, trial);
    const Eigen::Index n = 1 + random.below(4);
    const Eigen::MatrixXd a = drawn(random, n + 5 + random.below(10), n);
    const Eigen::VectorXd b = drawn(random, a.rows(), 1);
    const Eigen::VectorXd lower = drawn(random, n, 1);
    const Domain domain{lower, lower + (drawn(random, n, 1).array() + 1.01).matrix()};
    const ResidualFunction linear = [&](const Eigen::VectorXd& x, Eigen::VectorXd& residual,
                                        Eigen::MatrixXd* jacobian) {
      residual = a * x - b;
      if (jacobian != nullptr) *jacobian = a;
    };
    const Eigen::VectorXd expected = box_reference(a, b, domain.lower, domain.upper);
    const double least = (a * expected - b).squaredNorm();
    const Eigen::VectorXd middle = 0.5 * (domain.lower + domain.upper);
    Eigen::VectorXd mixed = middle;
    mixed[0] = domain.upper[0];
    for (const auto& start : {domain.lower, domain.upper, middle, mixed}) {
      const auto result = polish(linear, domain, start, pool);
      CHECK_CLOSE(result.penalty, least, 1e-12 * (1.0 + least));
      CHECK_CLOSE((result.best - expected).norm(), 0.0, 1e-6);
      CHECK(result.converged);
      CHECK((result.best.array() >= domain.lower.array()).all());
      CHECK((result.best.array() <= domain.upper.array()).all());
    }
  }
}

CHECK_CASE("polish: the first step of a linear problem does almost everything") {
  base::Pool pool(1);
  base::Random random(8, 0, 0, 0);
  const Eigen::MatrixXd a = drawn(random, 12, 3);
  const Eigen::VectorXd answer = drawn(random, 3, 1);
  const Eigen::VectorXd b = a * answer;
  const ResidualFunction linear = [&](const Eigen::VectorXd& x, Eigen::VectorXd& residual,
                                      Eigen::MatrixXd* jacobian) {
    residual = a * x - b;
    if (jacobian != nullptr) *jacobian = a;
  };
  const Domain wide = box({-50.0, -50.0, -50.0}, {50.0, 50.0, 50.0});
  const auto once = polish(linear, wide, Eigen::VectorXd::Constant(3, 3.0), pool, 1);
  CHECK_CLOSE((once.best - answer).norm(), 0.0, 1e-4);
  CHECK(!once.converged);
  // One step without gain may be rounding; the second one ends the search.
  CHECK(polish(linear, wide, answer, pool, 100).iterations == 2);
}

CHECK_CASE("polish: ends where no step gains") {
  base::Pool pool(1);
  const Domain wide = box({-50.0}, {50.0});
  double level = 1.0;
  double growth = 1.0 + 1e-15;  // by rounding alone
  const ResidualFunction rising = [&](const Eigen::VectorXd&, Eigen::VectorXd& residual,
                                      Eigen::MatrixXd* jacobian) {
    residual = Eigen::VectorXd::Constant(1, level);
    if (jacobian != nullptr) *jacobian = Eigen::MatrixXd::Constant(1, 1, 1.0);
    level *= growth;
  };
  const auto rounded = polish(rising, wide, Eigen::VectorXd::Zero(1), pool, 100);
  CHECK(rounded.converged);
  CHECK(rounded.iterations == 2);
  growth = 1.01;
  const auto uphill = polish(rising, wide, Eigen::VectorXd::Zero(1), pool, 100);
  CHECK(uphill.converged);
  CHECK_WITH(uphill.iterations <= 16, std::to_string(uphill.iterations));
}

CHECK_CASE("polish: Rosenbrock's valley") {
  base::Pool pool(1);
  const Domain wide = box({-5.0, -5.0}, {5.0, 5.0});
  base::Random random(2, 0, 0, 0);
  for (int trial = 0; trial < 50; ++trial) {
    Eigen::Vector2d start = 5.0 * drawn(random, 2, 1);
    if (trial == 0) start << -1.2, 1.0;
    const auto result = polish(rosenbrock, wide, start, pool);
    CHECK_CLOSE((result.best - Eigen::Vector2d(1.0, 1.0)).norm(), 0.0, 1e-9);
    CHECK(result.converged);
  }
  // With x <= 1/2 the minimum lies on that bound: (1/2, 1/4), penalty 1/4; with y <= 0 at x, where
  // 400 x^3 + 2 x = 2.
  for (int trial = 0; trial < 50; ++trial) {
    const Eigen::VectorXd start = 5.0 * drawn(random, 2, 1);
    const auto left = polish(rosenbrock, box({-5.0, -5.0}, {0.5, 5.0}), start, pool);
    CHECK_CLOSE((left.best - Eigen::Vector2d(0.5, 0.25)).norm(), 0.0, 1e-7);
    CHECK_CLOSE(left.penalty, 0.25, 1e-12);
    CHECK(left.best[0] == 0.5);
    const auto below = polish(rosenbrock, box({-5.0, -5.0}, {5.0, 0.0}), start, pool);
    CHECK(below.best[1] == 0.0);
    CHECK_CLOSE(400.0 * std::pow(below.best[0], 3) + 2.0 * below.best[0], 2.0, 1e-5);
  }
}

CHECK_CASE("polish: never worse than the start, whatever the function does") {
  base::Pool pool(1);
  for (std::uint32_t trial = 0; trial < 100; ++trial) {
    base::Random random(3, 0, 0, trial);
    const Eigen::MatrixXd a = 4.0 * drawn(random, 6, 3);
    const Eigen::MatrixXd wrong = drawn(random, 6, 3);
    const ResidualFunction wild = [&](const Eigen::VectorXd& x, Eigen::VectorXd& residual,
                                      Eigen::MatrixXd* jacobian) {
      residual = (a * x).array().sin() + 0.3 * (a * x).array().abs();
      if (trial % 3 == 1 && x[0] > 0.2) residual[0] = std::numeric_limits<double>::quiet_NaN();
      if (trial % 3 == 2 && x[1] > 0.2) residual[0] = std::numeric_limits<double>::infinity();
      if (jacobian != nullptr)
        *jacobian = trial % 2 == 0 ? wrong : a;  // no derivative of the function
    };
    const Domain domain = box({-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0});
    Eigen::VectorXd start = drawn(random, 3, 1);
    if (trial % 3 != 0) start.head(2) = -start.head(2).cwiseAbs();
    Eigen::VectorXd residual;
    wild(start, residual, nullptr);
    const auto result = polish(wild, domain, start, pool);
    CHECK_WITH(result.penalty <= residual.squaredNorm(), "trial " + std::to_string(trial));
    wild(result.best, residual, nullptr);
    CHECK(result.penalty == residual.squaredNorm());
    CHECK((result.best.array().abs() <= 1.0).all());
  }
}

CHECK_CASE("polish: fixed parameters stay, starts outside are moved in, limits are kept") {
  base::Pool pool(1);
  const auto fixed = polish(rosenbrock, box({2.0, -5.0}, {2.0, 5.0}), Eigen::Vector2d(9, 9), pool);
  CHECK(fixed.best[0] == 2.0);
  CHECK_CLOSE(fixed.best[1], 4.0, 1e-9);
  const Domain point = box({0.3, 0.4}, {0.3, 0.4});
  CHECK(polish(rosenbrock, point, point.lower, pool).converged);
  const auto few =
      polish(rosenbrock, box({-5.0, -5.0}, {5.0, 5.0}), Eigen::Vector2d(-1.2, 1.0), pool, 3);
  CHECK(few.iterations == 3);
  CHECK(!few.converged);
  base::Pool loud(1, [] { throw std::runtime_error("interrupted"); });
  CHECK(message_of<std::runtime_error>([&] { polish(rosenbrock, point, point.lower, loud); },
                                       "poll", __FILE__, __LINE__) == "interrupted");
}

CHECK_CASE("polish: parameters without influence and identical ones do no harm") {
  base::Pool pool(1);
  const ResidualFunction flat = [](const Eigen::VectorXd& x, Eigen::VectorXd& residual,
                                   Eigen::MatrixXd* jacobian) {
    residual = Eigen::Vector2d(x[0] + x[1] - 1.0, 2.0 * (x[0] + x[1]) - 2.0);
    if (jacobian == nullptr) return;
    jacobian->resize(2, 3);
    *jacobian << 1.0, 1.0, 0.0, 2.0, 2.0, 0.0;
  };
  const auto result =
      polish(flat, box({-5.0, -5.0, -5.0}, {5.0, 5.0, 5.0}), Eigen::Vector3d(3, 1, 2), pool);
  CHECK_CLOSE(result.best[0] + result.best[1], 1.0, 1e-9);
  CHECK(result.best[2] == 2.0);
}

CHECK_CASE("polish: finds a joint's parameters, with both residuals") {
  const Truth truth;
  auto r = moving(2000, 0.001, true, 8);
  add_torque(r, truth, true);
  Eigen::VectorXd theta(7);
  theta << truth.inertia, truth.coulomb, truth.static_excess, truth.viscous, truth.sensor_gain,
      truth.sensor_offset, truth.stribeck;
  const Domain domain{theta - 0.9 * theta.cwiseAbs(), theta + 0.9 * theta.cwiseAbs()};
  base::Pool pool(1);
  for (const auto residual : {identify::Residual::torque, identify::Residual::sensor}) {
    const identify::Penalty penalty(
        {r}, {"inertia", "coulomb", "static", "viscous", "sensor_gain", "sensor_offset"}, {0, 0.02},
        residual, true);
    // The sensor's penalty also falls towards an infinite gain, so the start must be near enough.
    base::Random random(4, 0, 0, 0);
    for (int trial = 0; trial < 10; ++trial) {
      const Eigen::VectorXd start =
          theta.array() * (1.0 + 0.2 * drawn(random, 7, 1).array().col(0));
      const auto result =
          polish([&](const Eigen::VectorXd& x, Eigen::VectorXd& value,
                     Eigen::MatrixXd* jacobian) { penalty.residuals(x, value, jacobian); },
                 domain, start, pool);
      for (Eigen::Index i = 0; i < 7; ++i) {
        CHECK_CLOSE(result.best[i], theta[i], 1e-7 * std::fabs(theta[i]));
      }
    }
  }
}

}  // namespace
}  // namespace jointid::tests
