// Linear least squares under inequalities, compared with every combination of active constraints.

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "base/random.hpp"
#include "check.hpp"
#include "reference.hpp"
#include "search/least_squares.hpp"

namespace jointid::tests {
namespace {

using search::box_minimum;
using search::constrained_least_squares;
using search::non_negative_least_squares;

struct Box {
  Eigen::MatrixXd g;
  Eigen::VectorXd h;
};

Box box(const Eigen::VectorXd& lower, const Eigen::VectorXd& upper) {
  const Eigen::Index n = lower.size();
  Box result{Eigen::MatrixXd(2 * n, n), Eigen::VectorXd(2 * n)};
  result.g << Eigen::MatrixXd::Identity(n, n), -Eigen::MatrixXd::Identity(n, n);
  result.h << lower, -upper;
  return result;
}

CHECK_CASE("least squares: random boxes of up to four variables") {
  for (std::uint32_t trial = 0; trial < 600; ++trial) {
    base::Random random(1, 0, 0, trial);
    const Eigen::Index n = 1 + random.below(4);
    const Eigen::Index rows = n + random.below(20);
    const Eigen::MatrixXd a = drawn(random, rows, n);
    const Eigen::VectorXd b = drawn(random, rows, 1);
    const Eigen::VectorXd lower = drawn(random, n, 1);
    const Eigen::VectorXd upper = lower + 0.5 * (drawn(random, n, 1).array() + 1.0).matrix();
    const auto [g, h] = box(lower, upper);
    const auto found = constrained_least_squares(a, b, g, h);
    const Eigen::VectorXd expected = box_reference(a, b, lower, upper);
    CHECK_WITH(found.feasible, "trial " + std::to_string(trial));
    CHECK(((found.x - lower).array() >= -1e-10).all());
    CHECK(((upper - found.x).array() >= -1e-10).all());
    CHECK_CLOSE((a * found.x - b).squaredNorm(), (a * expected - b).squaredNorm(), 1e-10);
    CHECK_CLOSE((a * (found.x - expected)).norm(), 0.0, 1e-8);
  }
}

CHECK_CASE("least squares: badly scaled columns, as joints have them") {
  for (std::uint32_t trial = 0; trial < 200; ++trial) {
    base::Random random(2, 0, 0, trial);
    const Eigen::VectorXd scale = Eigen::Vector4d(1e-4, 1.0, 1e3, 1e6);
    const Eigen::MatrixXd a = drawn(random, 30, 4) * scale.asDiagonal();
    const Eigen::VectorXd b = drawn(random, 30, 1);
    const Eigen::VectorXd unit = scale.cwiseInverse();
    const Eigen::VectorXd lower = (0.2 * drawn(random, 4, 1)).cwiseProduct(unit);
    const Eigen::VectorXd upper = lower + 0.1 * unit;
    const auto [g, h] = box(lower, upper);
    const auto found = constrained_least_squares(a, b, g, h);
    const Eigen::VectorXd expected = box_reference(a, b, lower, upper);
    CHECK(found.feasible);
    CHECK_CLOSE((found.x - expected).cwiseProduct(scale).norm(), 0.0, 1e-8);
  }
}

CHECK_CASE("least squares: the units of the data change nothing") {
  for (std::uint32_t trial = 0; trial < 100; ++trial) {
    base::Random random(9, 0, 0, trial);
    const Eigen::MatrixXd a = drawn(random, 12, 3);
    const Eigen::VectorXd b = drawn(random, 12, 1);
    const Eigen::VectorXd lower = drawn(random, 3, 1);
    const Eigen::VectorXd upper = lower + 0.3 * (drawn(random, 3, 1).array() + 1.01).matrix();
    const Eigen::VectorXd expected = box_reference(a, b, lower, upper);
    for (const double unit : {1e-9, 1e-3, 1e3, 1e6, 1e9}) {  // newtons, counts of an ADC
      const auto [g, h] = box(unit * lower, unit * upper);
      const auto found = constrained_least_squares(a, unit * b, g, h);
      CHECK_WITH(found.feasible, "trial " + std::to_string(trial) + std::to_string(unit));
      CHECK_CLOSE((found.x / unit - expected).norm(), 0.0, 1e-8);
    }
  }
}

CHECK_CASE("least squares: the units of a parameter change nothing") {
  const Eigen::VectorXd unit{{1e-12, 1.0, 1e12}};
  for (std::uint32_t trial = 0; trial < 100; ++trial) {
    base::Random random(11, 0, 0, trial);
    const Eigen::MatrixXd a = drawn(random, 12, 3);
    const Eigen::VectorXd b = drawn(random, 12, 1);
    const Eigen::VectorXd lower = drawn(random, 3, 1);
    const Eigen::VectorXd upper = lower + 0.3 * (drawn(random, 3, 1).array() + 1.01).matrix();
    const auto [g, h] = box(lower.cwiseQuotient(unit), upper.cwiseQuotient(unit));
    const auto found = constrained_least_squares(a * unit.asDiagonal(), b, g, h);
    CHECK_WITH(found.feasible, "trial " + std::to_string(trial));
    const Eigen::VectorXd expected = box_reference(a, b, lower, upper);
    CHECK_CLOSE((found.x.cwiseProduct(unit) - expected).norm(), 0.0, 1e-8);
  }
}

CHECK_CASE("least squares: thin boxes, near the unconstrained answer and far from it") {
  for (std::uint32_t trial = 0; trial < 200; ++trial) {
    base::Random random(10, 0, 0, trial);
    const Eigen::MatrixXd a = drawn(random, 12, 3);
    const Eigen::VectorXd b = drawn(random, 12, 1);
    const double width = std::pow(10.0, -12.0 * random.uniform());
    const double away = std::pow(10.0, 6.0 * random.uniform() - 3.0);
    const Eigen::VectorXd lower = away * drawn(random, 3, 1);
    const Eigen::VectorXd upper = lower + Eigen::VectorXd::Constant(3, width * away);
    const auto [g, h] = box(lower, upper);
    const auto found = constrained_least_squares(a, b, g, h);
    const Eigen::VectorXd expected = box_reference(a, b, lower, upper);
    CHECK_WITH(found.feasible, "trial " + std::to_string(trial));
    CHECK_CLOSE((found.x - expected).norm() / away, 0.0, 1e-8);
  }
}

CHECK_CASE("least squares: random half-spaces") {
  int active = 0;
  for (std::uint32_t trial = 0; trial < 600; ++trial) {
    base::Random random(3, 0, 0, trial);
    const Eigen::Index n = 1 + random.below(4);
    const Eigen::Index m = 1 + random.below(6);
    const Eigen::MatrixXd a = drawn(random, n + 3 + random.below(10), n);
    const Eigen::VectorXd b = drawn(random, a.rows(), 1);
    const Eigen::MatrixXd g = drawn(random, m, n);
    // Some point is inside by a margin, so that rounding does not decide about feasibility.
    const Eigen::VectorXd inside = drawn(random, n, 1);
    const Eigen::VectorXd h = g * inside - 0.3 * (drawn(random, m, 1).array() + 1.01).matrix();
    const auto found = constrained_least_squares(a, b, g, h);
    const auto expected = constrained_reference(a, b, g, h);
    CHECK_WITH(found.feasible, "trial " + std::to_string(trial));
    CHECK(((g * found.x - h).array() >= -1e-9).all());
    CHECK_CLOSE((a * found.x - b).squaredNorm(), expected.square, 1e-9);
    active += ((g * found.x - h).array() < 1e-9).any() ? 1 : 0;
  }
  CHECK_WITH(active > 200, std::to_string(active) + " trials met a constraint");
}

CHECK_CASE("least squares: unsatisfiable constraints are reported") {
  base::Random random(4, 0, 0, 0);
  const Eigen::MatrixXd a = drawn(random, 8, 2);
  const Eigen::VectorXd b = drawn(random, 8, 1);
  for (const double apart : {1e-5, 1e-3, 1.0, 1e3, 1e6}) {
    // x0 >= apart and x0 <= 0
    Eigen::MatrixXd g(2, 2);
    g << 1.0, 0.0, -1.0, 0.0;
    CHECK(!constrained_least_squares(a, b, g, Eigen::Vector2d(apart, 0.0)).feasible);
    CHECK(constrained_least_squares(a, b, g, Eigen::Vector2d(-apart, 0.0)).feasible);
    // Three half-planes around an empty triangle.
    Eigen::MatrixXd triangle(3, 2);
    triangle << 1.0, 0.0, 0.0, 1.0, -1.0, -1.0;
    CHECK(!constrained_least_squares(a, b, triangle, Eigen::Vector3d(apart, 0.0, 0.0)).feasible);
  }
}

CHECK_CASE("least squares: without a binding constraint, the unconstrained answer") {
  base::Random random(5, 0, 0, 0);
  const Eigen::MatrixXd a = drawn(random, 20, 3);
  const Eigen::VectorXd b = drawn(random, 20, 1);
  const auto wide = Eigen::Vector3d::Constant(1e6);
  const Eigen::VectorXd plain = box_reference(a, b, -wide, wide);
  const auto none = constrained_least_squares(a, b, Eigen::MatrixXd(0, 3), Eigen::VectorXd(0));
  CHECK(none.feasible);
  CHECK_CLOSE((none.x - plain).norm(), 0.0, 1e-13);
  const auto [g, h] = box(Eigen::Vector3d::Constant(-10.0), Eigen::Vector3d::Constant(10.0));
  CHECK_CLOSE((constrained_least_squares(a, b, g, h).x - plain).norm(), 0.0, 1e-13);
}

CHECK_CASE(
    "least squares: collinear columns share, columns of zeros stay as near to 0 as allowed") {
  base::Random random(6, 0, 0, 0);
  Eigen::MatrixXd a = drawn(random, 20, 3);
  a.col(2) = a.col(0);
  const Eigen::VectorXd b = 4.0 * a.col(0) + a.col(1);
  const auto [g, h] = box(Eigen::Vector3d::Constant(-10.0), Eigen::Vector3d::Constant(10.0));
  const Eigen::VectorXd shared = constrained_least_squares(a, b, g, h).x;
  CHECK_CLOSE((shared - Eigen::Vector3d(2.0, 1.0, 2.0)).norm(), 0.0, 1e-5);
  // One of the twins is fixed: the other takes the rest.
  const auto held = box(Eigen::Vector3d(-10.0, -10.0, 3.0), Eigen::Vector3d::Constant(10.0));
  const Eigen::VectorXd rest = constrained_least_squares(a, b, held.g, held.h).x;
  CHECK_CLOSE((rest - Eigen::Vector3d(1.0, 1.0, 3.0)).norm(), 0.0, 1e-5);
  a.col(2).setZero();
  CHECK_CLOSE(constrained_least_squares(a, b, g, h).x[2], 0.0, 1e-12);
  const Eigen::VectorXd asked = constrained_least_squares(a, b, held.g, held.h).x;
  CHECK_CLOSE((asked - Eigen::Vector3d(4.0, 1.0, 3.0)).norm(), 0.0, 1e-5);
}

CHECK_CASE("least squares: fewer rows than columns stays finite and fits") {
  base::Random random(7, 0, 0, 0);
  const Eigen::MatrixXd a = drawn(random, 2, 4);
  const Eigen::VectorXd b = drawn(random, 2, 1);
  const auto [g, h] = box(Eigen::Vector4d::Constant(-100.0), Eigen::Vector4d::Constant(100.0));
  const auto found = constrained_least_squares(a, b, g, h);
  CHECK(found.x.allFinite());
  CHECK_CLOSE((a * found.x - b).norm(), 0.0, 1e-7);
}

CHECK_CASE("least squares: non-negative, against the exhaustive search") {
  for (std::uint32_t trial = 0; trial < 300; ++trial) {
    base::Random random(8, 0, 0, trial);
    const Eigen::Index n = 1 + random.below(4);
    const Eigen::MatrixXd a = drawn(random, n + 1 + random.below(10), n);
    const Eigen::VectorXd b = drawn(random, a.rows(), 1);
    const Eigen::VectorXd x = non_negative_least_squares(a, b);
    const auto expected =
        constrained_reference(a, b, Eigen::MatrixXd::Identity(n, n), Eigen::VectorXd::Zero(n));
    CHECK(x.minCoeff() >= 0.0);
    CHECK_CLOSE((a * x - b).squaredNorm(), expected.square, 1e-11);
  }
}

CHECK_CASE("least squares: inside a box, against the exhaustive search") {
  for (std::uint32_t trial = 0; trial < 300; ++trial) {
    base::Random random(9, 0, 0, trial);
    const Eigen::Index n = 1 + random.below(4);
    const Eigen::MatrixXd a = drawn(random, n + 1 + random.below(10), n);
    const Eigen::VectorXd b = drawn(random, a.rows(), 1);
    const Eigen::VectorXd lower = Eigen::VectorXd::Constant(n, -0.2);
    const Eigen::VectorXd upper = Eigen::VectorXd::Constant(n, 0.3);
    const auto [g, h] = box(lower, upper);
    const Eigen::VectorXd x = box_minimum(a.transpose() * a, -a.transpose() * b, lower, upper);
    const auto expected = constrained_reference(a, b, g, h);
    CHECK((x - lower).minCoeff() >= 0.0);
    CHECK((upper - x).minCoeff() >= 0.0);
    CHECK_CLOSE((a * x - b).squaredNorm(), expected.square, 1e-11);
  }
}

CHECK_CASE("least squares: inside a box of many values, as by non-negative least squares") {
  for (std::uint32_t trial = 0; trial < 200; ++trial) {
    base::Random random(10, 0, 0, trial);
    const Eigen::Index n = 30 + random.below(40);
    const Eigen::MatrixXd mixed = drawn(random, n + 20, n / 3) * drawn(random, n / 3, n);
    const Eigen::MatrixXd a = mixed + 0.01 * drawn(random, n + 20, n);
    const Eigen::VectorXd b = drawn(random, n + 20, 1);
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(n);
    const Eigen::VectorXd far =
        Eigen::VectorXd::Constant(n, std::numeric_limits<double>::infinity());
    const Eigen::VectorXd x = box_minimum(a.transpose() * a, -a.transpose() * b, none, far);
    const Eigen::VectorXd y = non_negative_least_squares(a, b);
    CHECK(x.minCoeff() >= 0.0);
    CHECK_CLOSE((a * x - b).squaredNorm(), (a * y - b).squaredNorm(), 1e-8);
  }
}

CHECK_CASE("least squares: a direction that is lacking gets the shortest solution") {
  const Eigen::Matrix2d square = Eigen::Matrix2d::Ones();
  const Eigen::Vector2d far = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
  const Eigen::VectorXd x = box_minimum(square, Eigen::Vector2d(-2.0, -2.0), -far, far);
  CHECK_CLOSE(x[0], 1.0, 1e-6);
  CHECK_CLOSE(x[1], 1.0, 1e-6);
  CHECK(box_minimum(square, Eigen::Vector2d(2.0, 2.0), 0.0 * square.col(0), far).norm() == 0.0);
}

}  // namespace
}  // namespace jointid::tests
