// The compressed penalty against the direct sum.

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "check.hpp"
#include "identify/compressed/compressed_penalty.hpp"
#include "identify/solve/separable.hpp"
#include "synthetic.hpp"

namespace jointid::tests {
namespace {

using identify::CompressedPenalty;
using identify::Penalty;
using identify::Residual;
using identify::WindowOptions;
using search::Domain;

using Names = std::vector<std::string>;
const Names kCoulomb{"inertia", "coulomb", "viscous", "sensor_gain", "sensor_offset"};
const Names kStribeck{"inertia", "coulomb", "static", "viscous", "sensor_gain", "sensor_offset"};
const Names kGeneral{"inertia", "coulomb",     "static_general",
                     "viscous", "sensor_gain", "sensor_offset"};
constexpr double kExponent = 1.3;  // of the general decay, fixed: a table has only one shape
const Names kDirections{"inertia",          "coulomb_positive", "coulomb_negative",
                        "static_positive",  "static_negative",  "viscous_positive",
                        "viscous_negative", "sensor_gain"};

Penalty penalty_of(const Names& names, Residual residual, WindowOptions windows = {0, 0.02},
                   double noise = 0.5, int samples = 3000) {
  std::vector<identify::Recording> recordings;
  for (const std::uint64_t seed : {1U, 2U}) {
    auto r = moving(samples, 0.001, true, seed);
    add_torque(r, {}, true);
    add_noise(r, noise, seed);
    recordings.push_back(std::move(r));
  }
  return Penalty(std::move(recordings), names, windows, residual, true);
}

Domain domain_of(const Penalty& penalty) {
  Domain domain{Eigen::VectorXd::Zero(penalty.parameters()),
                Eigen::VectorXd::Zero(penalty.parameters())};
  for (Eigen::Index i = 0; i < penalty.parameters(); ++i) {
    const auto& name = penalty.names()[static_cast<std::size_t>(i)];
    if (name == "sensor_gain") {
      domain.lower[i] = 0.1;
      domain.upper[i] = 5.0;
    } else if (name == "sensor_offset") {
      domain.lower[i] = -30.0;
      domain.upper[i] = 30.0;
    } else if (name == "stribeck") {
      domain.upper[i] = 200.0;
    } else if (name == "stribeck_velocity") {
      domain.lower[i] = 0.05;
      domain.upper[i] = 1.5;
    } else if (name == "stribeck_exponent") {
      domain.lower[i] = domain.upper[i] = kExponent;
    } else {
      domain.upper[i] = 50.0;
    }
  }
  return domain;
}

/// Random candidates; a quarter of them lie near the optimum, which is the first.
Eigen::MatrixXd candidates_of(const Penalty& penalty, const Domain& domain, Eigen::Index count,
                              base::Pool& pool) {
  base::Random random(7, 0, 0, 0);
  const Eigen::VectorXd best = identify::minimise_separable(penalty, domain, pool).best;
  Eigen::MatrixXd result(domain.size(), count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const double reach = i < count / 4 ? std::pow(10.0, -8.0 * random.uniform()) : 1.0;
    for (Eigen::Index j = 0; j < domain.size(); ++j) {
      const double anywhere =
          domain.lower[j] + random.uniform() * (domain.upper[j] - domain.lower[j]);
      result(j, i) = best[j] + reach * (anywhere - best[j]);
    }
  }
  result.col(0) = best;
  return result.array()
      .max(domain.lower.replicate(1, count).array())
      .min(domain.upper.replicate(1, count).array());
}

void check_equal(const Names& names, Residual residual, const WindowOptions& windows,
                 Eigen::Index count) {
  base::Pool pool(2);
  const auto direct = penalty_of(names, residual, windows);
  const auto domain = domain_of(direct);
  const CompressedPenalty compressed(direct, domain, pool);
  CHECK_WITH(compressed.exact(), compressed.reason());
  const auto candidates = candidates_of(direct, domain, count, pool);
  Eigen::VectorXd expected(count);
  Eigen::VectorXd found(count);
  direct.evaluate(candidates, expected, pool);
  compressed.evaluate(candidates, found, pool);
  double worst = 0.0;
  for (Eigen::Index i = 0; i < count; ++i) {
    const double gain = residual == Residual::sensor ? candidates(direct.gain_index(), i) : 1.0;
    const double allowed =
        1e-10 * expected[i] + 1e-14 * direct.target().squaredNorm() / (gain * gain);
    worst = std::max(worst, std::fabs(found[i] - expected[i]) / allowed);
    CHECK(found[i] >= 0.0);
  }
  CHECK_WITH(worst <= 1.0, names.back() + ": " + std::to_string(worst) + " of the tolerance");
}

CHECK_CASE("compressed: equal to the direct sum on random candidates and at the optimum") {
  for (const auto residual : {Residual::sensor, Residual::torque}) {
    check_equal(kCoulomb, residual, {0, 0.02}, 2000);
    check_equal(kStribeck, residual, {0, 0.02}, 2000);
    check_equal(kDirections, residual, {0, 0.02}, 1000);
  }
}

CHECK_CASE("compressed: equal for the general decay with a fixed exponent") {
  check_equal(kGeneral, Residual::sensor, {0, 0.05}, 400);
}

CHECK_CASE("compressed: equal with running integrals") {
  check_equal(kStribeck, Residual::sensor, {0, 0.05, 1.0, true}, 1000);
}

CHECK_CASE("compressed: running integrals continue from one block of rows to the next") {
  base::Pool pool(2);
  const auto direct = penalty_of(kStribeck, Residual::sensor, {0, 0.001, 1.0, true}, 0.5, 20'000);
  const auto domain = domain_of(direct);
  CHECK(direct.window_count() > 3 * 4096);
  const CompressedPenalty compressed(direct, domain, pool);
  CHECK_WITH(compressed.exact(), compressed.reason());
  const double size = direct.target().squaredNorm();
  for (const double share : {0.2, 0.5, 0.9}) {
    const Eigen::VectorXd theta = domain.lower + share * (domain.upper - domain.lower);
    const double gain = theta[direct.gain_index()];
    const double expected = direct(theta);
    CHECK_CLOSE(compressed(theta), expected, 1e-10 * expected + 1e-14 * size / (gain * gain));
  }
}

CHECK_CASE("compressed: stops on request, also without shapes") {
  const auto direct = penalty_of(kCoulomb, Residual::sensor);
  base::Cancel cancel;
  const identify::Stretch all{0, direct.windows().size()};
  CHECK(identify::digest_part(direct, all, {}, &cancel).nodes() == 0);
  cancel.request();
  bool stopped = false;
  try {
    identify::digest_part(direct, all, {}, &cancel);
  } catch (const base::Cancelled&) {
    stopped = true;
  }
  CHECK(stopped);
}

CHECK_CASE("compressed: an exponent that is searched is left to the direct sum") {
  base::Pool pool(2);
  const auto direct = penalty_of(kGeneral, Residual::sensor, {0, 0.05});
  for (const double velocity : {0.05, 1.5}) {  // the other shape searched, or fixed
    auto domain = domain_of(direct);
    domain.lower.tail(2) << velocity, 0.5;
    domain.upper.tail(2) << 1.5, 4.0;
    const CompressedPenalty compressed(direct, domain, pool);
    CHECK(!compressed.exact() && compressed.passes() == 0);
    CHECK(contains(compressed.reason(), "stribeck_exponent is searched"));
    CHECK_REFUSED(compressed(domain.upper), "not compressed: stribeck_exponent");
  }
}

CHECK_CASE("compressed: accurate and never negative where the penalty almost vanishes") {
  base::Pool pool(1);
  const auto direct = penalty_of(kStribeck, Residual::torque, {0, 0.02}, 0.0);
  const auto domain = domain_of(direct);
  const CompressedPenalty compressed(direct, domain, pool);
  CHECK_WITH(compressed.exact(), compressed.reason());
  const Eigen::VectorXd best = identify::minimise_separable(direct, domain, pool).best;
  const double size = direct.target().squaredNorm();
  base::Random random(3, 0, 0, 0);
  for (int i = 0; i < 2000; ++i) {
    Eigen::VectorXd theta = best;
    for (double& value : theta) {
      value *= 1.0 + std::pow(10.0, -1.0 - 12.0 * random.uniform()) * (random.uniform() - 0.5);
    }
    const double expected = direct(theta);
    const double found = compressed(theta);
    CHECK(found >= 0.0);
    CHECK_CLOSE(found, expected, 1e-10 * expected + 1e-14 * size);
  }
}

CHECK_CASE("compressed: the same bits for any number of threads") {
  const auto direct = penalty_of(kStribeck, Residual::sensor, {0, 0.02}, 0.5, 20'000);
  const auto domain = domain_of(direct);
  std::vector<double> values;
  for (const int threads : {1, 2, 5}) {
    base::Pool pool(threads);
    const CompressedPenalty compressed(direct, domain, pool);
    values.push_back(compressed(0.3 * domain.lower + 0.7 * domain.upper));
  }
  CHECK(values[0] == values[1] && values[0] == values[2]);
}

CHECK_CASE("compressed: its residuals are the penalty's root, with correct derivatives") {
  base::Pool pool(1);
  for (const auto& names : {kCoulomb, kStribeck, kDirections, kGeneral}) {
    const auto direct = penalty_of(names, Residual::sensor, {0, 0.05}, 0.5, 1000);
    const auto domain = domain_of(direct);
    const CompressedPenalty compressed(direct, domain, pool);
    const Eigen::VectorXd theta = 0.6 * domain.lower + 0.4 * domain.upper;
    Eigen::VectorXd residual;
    Eigen::MatrixXd jacobian;
    compressed.residuals(theta, residual, &jacobian);
    CHECK_CLOSE(residual.squaredNorm(), compressed(theta), 1e-12 * compressed(theta));
    for (Eigen::Index j = 0; j < theta.size(); ++j) {
      const double step = 1e-6 * (domain.upper[j] - domain.lower[j]);
      if (step == 0.0) continue;
      Eigen::VectorXd up = theta;
      Eigen::VectorXd down = theta;
      up[j] += step;
      down[j] -= step;
      Eigen::VectorXd above;
      Eigen::VectorXd below;
      compressed.residuals(up, above, nullptr);
      compressed.residuals(down, below, nullptr);
      const Eigen::VectorXd slope = (above - below) / (2.0 * step);
      CHECK_CLOSE((slope - jacobian.col(j)).norm(), 0.0, 1e-6 * (1e-3 + jacobian.col(j).norm()));
    }
  }
}

CHECK_CASE("compressed: refuses shapes outside its bounds, and says why it is not exact") {
  base::Pool pool(1);
  const auto direct = penalty_of(kStribeck, Residual::sensor);
  auto domain = domain_of(direct);
  const CompressedPenalty compressed(direct, domain, pool);
  Eigen::VectorXd theta = domain.upper;
  theta[theta.size() - 1] = 201.0;
  CHECK_REFUSED(compressed(theta), "stribeck must lie within");
  theta[theta.size() - 1] = std::nan("");
  CHECK_REFUSED(compressed(theta), "stribeck must lie within");
  domain.lower[theta.size() - 1] = -1e6;
  const CompressedPenalty impossible(direct, domain, pool);
  CHECK(!impossible.exact() && contains(impossible.reason(), "too far below 0"));
  CHECK_REFUSED(CompressedPenalty(direct, {domain.lower.head(2), domain.upper.head(2)}, pool),
                "domain must have 7 parameters");
}

CHECK_CASE("compressed: finds the same optimum, by elimination and near a start") {
  base::Pool pool(2);
  for (const auto residual : {Residual::sensor, Residual::torque}) {
    const auto direct = penalty_of(kStribeck, residual);
    const auto domain = domain_of(direct);
    const CompressedPenalty compressed(direct, domain, pool);
    const auto expected = identify::minimise_separable(direct, domain, pool);
    const auto found = identify::minimise_separable(compressed, domain, pool);
    const auto near = identify::refine_separable(
        compressed, domain, (0.9 * expected.best).cwiseMax(domain.lower), pool, false);
    for (const auto& result : {found, near}) {
      CHECK_CLOSE(direct(result.best), expected.penalty, 1e-9 * expected.penalty);
    }
  }
}

}  // namespace
}  // namespace jointid::tests
