// The projected search compared with the separable one over the same direct sums.

#include <Eigen/Core>
#include <cmath>
#include <string>
#include <vector>

#include "check.hpp"
#include "identify/penalty/penalty.hpp"
#include "identify/solve/projected_search.hpp"
#include "identify/solve/projection.hpp"
#include "identify/solve/separable.hpp"
#include "reference.hpp"
#include "synthetic.hpp"

namespace jointid::tests {
namespace projection {

using identify::minimise_projected;
using identify::Penalty;
using identify::Projection;
using identify::Residual;
using search::Domain;

using Names = std::vector<std::string>;
const Names kPlain{"coulomb", "static", "viscous", "sensor_gain", "sensor_offset"};
const Names kGeneral{"coulomb", "static_general", "viscous", "sensor_gain", "sensor_offset"};

Penalty penalty_of(const Names& terms, Residual residual, double noise, std::uint64_t seed) {
  Truth truth;
  truth.inertia = 0.0;
  auto r = moving(8000, 0.001, true, seed);
  add_torque(r, truth, true);
  add_noise(r, noise, seed);
  return Penalty({r}, terms, {0, 0.02}, residual, true);
}

Eigen::VectorXd vector(std::initializer_list<double> values) {
  return Eigen::Map<const Eigen::VectorXd>(std::data(values), std::ssize(values));
}

Domain plain_domain() {
  return {vector({0, 0, 0, 0.1, -30, 0}), vector({50, 40, 40, 5, 30, 2000})};
}

Domain general_domain() {
  return {vector({0, 0, 0, 0.1, -30, 0.01, 0.5}), vector({50, 40, 40, 5, 30, 1.0, 4.0})};
}

CHECK_CASE("projection: the value and derivatives of the penalty with the best coefficients") {
  const base::Cancel cancel;
  for (const auto residual : {Residual::torque, Residual::sensor}) {
    for (const bool general : {false, true}) {
      const auto penalty = penalty_of(general ? kGeneral : kPlain, residual, 0.5, 3);
      auto domain = general ? general_domain() : plain_domain();
      for (const int bound : {0, 1, 2}) {  // none, one that is active, a fixed coefficient
        if (bound == 1) domain.upper[0] = 12.0;
        if (bound == 2) domain.lower[2] = domain.upper[2] = 11.0;
        const Projection projection(penalty, domain, {}, cancel);
        const Eigen::VectorXd shapes = general ? vector({0.15, 1.7}) : vector({60.0});
        const auto point = projection.at(shapes);
        Eigen::VectorXd expected(penalty.parameters());
        expected << best_coefficients(penalty, shapes, domain), shapes;
        CHECK_CLOSE(point.value / penalty(expected), 1.0, 1e-10);
        CHECK_CLOSE(projection.value(shapes) / point.value, 1.0, 1e-12);
        CHECK((point.theta - expected).cwiseAbs().maxCoeff() < 1e-6);
        for (Eigen::Index i = 0; i < shapes.size(); ++i) {
          const double step = 1e-4 * shapes[i];
          Eigen::VectorXd before = shapes;
          Eigen::VectorXd behind = shapes;
          before[i] -= step;
          behind[i] += step;
          const double slope = (projection.value(behind) - projection.value(before)) / (2.0 * step);
          CHECK_CLOSE(point.gradient[i], slope, 1e-5 * std::fabs(slope) + 1e-6 * point.value);
          CHECK(point.curvature(i, i) > 0.0);
        }
      }
    }
  }
}

/// Whether the free shapes lie inside their ranges, away from the ends.
bool is_inside(const Eigen::VectorXd& theta, const Domain& domain, Eigen::Index coefficients) {
  for (Eigen::Index i = coefficients; i < theta.size(); ++i) {
    const double share = (theta[i] - domain.lower[i]) / (domain.upper[i] - domain.lower[i]);
    if (share < 1e-3 || share > 0.999) return false;
  }
  return true;
}

CHECK_CASE("projection: the optimum of the separable search, with and without bounds that hold") {
  base::Pool pool(2);
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    for (const auto residual : {Residual::torque, Residual::sensor}) {
      for (const bool general : {false, true}) {
        const auto penalty = penalty_of(general ? kGeneral : kPlain, residual, 0.05, seed);
        // Coulomb friction of 25: free, bounded slightly below, and bounded so far below that the
        // decaying friction replaces it, until its shape is at the end of the range.
        for (const double highest : {50.0, 24.5, 13.0}) {
          auto domain = general ? general_domain() : plain_domain();
          domain.upper[0] = highest;
          const auto projected = minimise_projected(penalty, domain, pool);
          const auto expected = minimise_separable(penalty, domain, pool);
          CHECK(projected.found.has_value() != !projected.reason.empty());
          const bool inside = is_inside(expected.best, domain, penalty.coefficients());
          CHECK(inside == (highest > 13.0));
          CHECK_WITH(projected.found.has_value() == inside, projected.reason);
          if (!projected.found) continue;
          const auto& found = *projected.found;
          CHECK_WITH(
              found.penalty <= expected.penalty * (1.0 + 1e-9),
              std::to_string(found.penalty) + " against " + std::to_string(expected.penalty));
          CHECK(found.penalty == penalty(found.best));
          CHECK((found.best.array() >= domain.lower.array()).all());
          CHECK((found.best.array() <= domain.upper.array()).all());
        }
      }
    }
  }
}

CHECK_CASE("projection: coefficients that nothing separates get some value within their bounds") {
  base::Pool pool(2);
  // The offset is half the difference of the directions' Coulomb frictions.
  const Names terms{"coulomb_positive", "coulomb_negative", "static",
                    "viscous",          "sensor_gain",      "sensor_offset"};
  const auto penalty = penalty_of(terms, Residual::torque, 0.5, 3);
  const Domain domain{vector({0, 0, 0, 0, 0.1, -30, 0}), vector({50, 50, 40, 40, 5, 30, 2000})};
  const auto projected = minimise_projected(penalty, domain, pool);
  CHECK_WITH(projected.found.has_value(), projected.reason);
  if (!projected.found) return;
  const auto expected = minimise_separable(penalty, domain, pool);
  CHECK_CLOSE(projected.found->penalty / expected.penalty, 1.0, 1e-9);
  CHECK_CLOSE(projected.found->best[6] / expected.best[6], 1.0, 1e-6);
  CHECK((projected.found->best.array() >= domain.lower.array()).all());
  CHECK((projected.found->best.array() <= domain.upper.array()).all());
}

CHECK_CASE("projection: the optimum is the limit of Newton's steps, finer than values show") {
  base::Pool pool(1);
  const auto penalty = penalty_of(kPlain, Residual::sensor, 0.5, 3);
  const auto domain = plain_domain();
  const auto projected = minimise_projected(penalty, domain, pool);
  CHECK_WITH(projected.found.has_value(), projected.reason);
  if (!projected.found) return;
  const Projection projection(penalty, domain, {}, pool.cancel());
  const auto point = projection.at(projected.found->best.tail(1));
  CHECK(std::fabs(point.gradient[0] / point.curvature(0, 0)) < 1e-10 * projected.found->best[5]);
}

CHECK_CASE("projection: the same bits for any number of threads") {
  const auto penalty = penalty_of(kPlain, Residual::sensor, 0.5, 4);
  base::Pool one(1);
  const auto expected = minimise_projected(penalty, plain_domain(), one);
  CHECK_WITH(expected.found.has_value(), expected.reason);
  if (!expected.found) return;
  for (const int threads : {2, 7}) {
    base::Pool pool(threads);
    CHECK(minimise_projected(penalty, plain_domain(), pool).found->best == expected.found->best);
  }
}

CHECK_CASE("projection: leaves to the compressed penalty what some windows cannot decide") {
  base::Pool pool(1);
  auto domain = plain_domain();
  const auto noisy = penalty_of(kPlain, Residual::sensor, 300.0, 4);
  CHECK(minimise_projected(noisy, domain, pool).reason ==
        "the penalty hardly depends on the shapes");
  const auto penalty = penalty_of(kPlain, Residual::sensor, 0.5, 4);
  domain.upper[5] = 10.0;  // the optimum lies at the end
  CHECK(minimise_projected(penalty, domain, pool).reason ==
        "the optimum lies near the end of a shape's range");
  domain.lower[5] = domain.upper[5];
  CHECK(minimise_projected(penalty, domain, pool).reason == "no shape is searched");
  CHECK_REFUSED(minimise_projected(penalty, {vector({0}), vector({1})}, pool),
                "6 parameters, got 1");
}

}  // namespace projection
}  // namespace jointid::tests
