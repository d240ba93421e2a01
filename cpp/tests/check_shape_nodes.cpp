// The nodes of the compressed penalty: the models and bounds that have nodes, and their number.

#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "check.hpp"
#include "identify/compressed/compressed_penalty.hpp"
#include "identify/compressed/sliding_penalty.hpp"
#include "synthetic.hpp"

namespace jointid::tests {
namespace shape_nodes {

using identify::CompressedPenalty;
using identify::Penalty;
using identify::Residual;
using Names = std::vector<std::string>;

const Names kGeneral{"inertia", "coulomb", "static_general", "viscous"};

identify::Recording recorded(const Truth& truth, double noise) {
  auto r = moving(3000, 0.001, true, 1);
  add_torque(r, truth, false);
  add_noise(r, noise, 1);
  return r;
}

Penalty penalty_of(const Names& names, const Truth& truth = {}, double noise = 0.5) {
  return Penalty({recorded(truth, noise)}, names, {0, 0.02}, Residual::torque, true);
}

/// Coefficients up to 50, and these bounds of the shapes.
search::Domain domain_of(const Penalty& penalty, const std::vector<std::array<double, 2>>& shapes) {
  search::Domain domain{Eigen::VectorXd::Zero(penalty.parameters()),
                        Eigen::VectorXd::Constant(penalty.parameters(), 50.0)};
  Eigen::Index i = penalty.coefficients();
  for (const auto& [low, high] : shapes) {
    domain.lower[i] = low;
    domain.upper[i++] = high;
  }
  CHECK(i == penalty.parameters());
  return domain;
}

CHECK_CASE("compressed: decays with shapes of their own are left to the direct sum") {
  base::Pool pool(1);
  const std::array<double, 2> rate{0.0, 200.0};
  const std::array<double, 2> velocity{0.05, 1.5};
  const std::array<double, 2> exponent{0.5, 4.0};
  const auto gaussian = penalty_of({"inertia", "static_positive", "static_general_negative"});
  const auto general = penalty_of({"inertia", "static_general_positive", "static_negative"});
  for (const auto& [penalty, shapes] :
       {std::pair{&gaussian, std::vector{rate, velocity, exponent}},
        std::pair{&general, std::vector{velocity, exponent, rate}}}) {
    const CompressedPenalty compressed(*penalty, domain_of(*penalty, shapes), pool);
    CHECK(!compressed.exact());
    CHECK_WITH(contains(compressed.reason(), "shapes of their own"), compressed.reason());
  }
}

CHECK_CASE("compressed: a velocity from 0 on has no nodes") {
  base::Pool pool(1);
  const auto penalty = penalty_of(kGeneral);
  const CompressedPenalty none(penalty, domain_of(penalty, {{0.0, 1.0}, {2.0, 2.0}}), pool);
  CHECK(!none.exact() && contains(none.reason(), "above 0"));
  const CompressedPenalty some(penalty, domain_of(penalty, {{0.05, 1.0}, {2.0, 2.0}}), pool);
  CHECK_WITH(some.exact(), some.reason());
}

CHECK_CASE("shape nodes: with a fixed exponent the usual number of nodes suffices") {
  // The sliding penalty makes no second, denser attempt.
  const auto r = recorded({}, 0.5);
  const auto penalty = penalty_of(kGeneral);
  for (const double exponent : {0.5, 2.0, 6.0}) {
    const auto domain = domain_of(penalty, {{0.001, 5.0}, {exponent, exponent}});
    identify::SlidingPenalty sliding(kGeneral, Residual::torque, 1.0, 0.02, true,
                                     identify::motion_scale(r), domain, 4.5);
    sliding.append(r, 0, r.samples() - 1);
    const auto compressed = sliding.compressed();
    CHECK(compressed.has_value());
    if (compressed) CHECK_WITH(compressed->exact(), compressed->reason());
  }
}

CHECK_CASE("compressed: never negative where a shaped term equals another term") {
  // Without decay the static column is Coulomb's, so nothing of it remains.
  base::Pool pool(1);
  Truth truth;
  truth.static_excess = 0.0;
  const auto penalty = penalty_of({"inertia", "coulomb", "static", "viscous"}, truth, 0.0);
  const CompressedPenalty compressed(penalty, domain_of(penalty, {{0.0, 200.0}}), pool);
  CHECK_WITH(compressed.exact(), compressed.reason());
  const double size = penalty.target().squaredNorm();
  base::Random random(4, 0, 0, 0);
  for (int i = 0; i < 2000; ++i) {
    const double part = truth.coulomb * random.uniform();
    const double rate = std::pow(10.0, -14.0 * random.uniform());
    Eigen::VectorXd theta(5);
    theta << truth.inertia, truth.coulomb - part, part, truth.viscous, rate;
    CHECK(compressed(theta) >= 0.0);
    CHECK_CLOSE(compressed(theta), penalty(theta), 1e-10 * penalty(theta) + 1e-14 * size);
  }
}

}  // namespace shape_nodes
}  // namespace jointid::tests
