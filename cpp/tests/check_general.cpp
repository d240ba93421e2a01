// The compressed penalty of the general decay: pieces of the speed, wide bounds, derivatives.

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "check.hpp"
#include "identify/compressed/compressed_penalty.hpp"
#include "identify/compressed/shape_table.hpp"
#include "identify/compressed/speed_pieces.hpp"
#include "model/friction.hpp"
#include "synthetic.hpp"

namespace jointid::tests {
namespace {

using identify::CompressedPenalty;
using identify::GeneralRange;
using identify::Penalty;
using identify::Residual;
using identify::WindowOptions;
using search::Domain;

Penalty penalty_of(bool directions, const WindowOptions& windows, int samples = 3000) {
  std::vector<identify::Recording> recordings;
  for (const std::uint64_t seed : {1U, 2U}) {
    auto r = moving(samples, 0.001, true, seed);
    add_torque(r, {}, true);
    add_noise(r, 0.5, seed);
    recordings.push_back(std::move(r));
  }
  const std::vector<std::string> one{"inertia", "coulomb", "static_general", "viscous"};
  const std::vector<std::string> two{"inertia", "coulomb", "static_general_positive",
                                     "static_general_negative", "viscous"};
  return Penalty(std::move(recordings), directions ? two : one, windows, Residual::torque, true);
}

Domain domain_of(const Penalty& penalty, const GeneralRange& range) {
  Domain domain{Eigen::VectorXd::Zero(penalty.parameters()),
                Eigen::VectorXd::Constant(penalty.parameters(), 50.0)};
  const Eigen::Index p = penalty.coefficients();
  domain.lower[p] = range.velocity_low;
  domain.upper[p] = range.velocity_high;
  domain.lower[p + 1] = range.exponent_low;
  domain.upper[p + 1] = range.exponent_high;
  return domain;
}

Eigen::MatrixXd candidates_of(const Domain& domain, Eigen::Index count) {
  base::Random random(11, 0, 0, 0);
  Eigen::MatrixXd result(domain.size(), count);
  for (Eigen::Index i = 0; i < count; ++i) {
    for (Eigen::Index j = 0; j < domain.size(); ++j) {
      result(j, i) = domain.lower[j] + random.uniform() * (domain.upper[j] - domain.lower[j]);
    }
  }
  return result.array()
      .max(domain.lower.replicate(1, count).array())
      .min(domain.upper.replicate(1, count).array());
}

/// Penalties and their gradients against the direct sum.
void check_equal(const Penalty& direct, const GeneralRange& range, const std::string& what) {
  base::Pool pool(2);
  const auto domain = domain_of(direct, range);
  const CompressedPenalty compressed(direct, domain, pool);
  CHECK_WITH(compressed.exact(), what + ": " + compressed.reason());
  constexpr Eigen::Index count = 200;
  const auto candidates = candidates_of(domain, count);
  Eigen::VectorXd expected(count);
  Eigen::VectorXd found(count);
  direct.evaluate(candidates, expected, pool);
  compressed.evaluate(candidates, found, pool);
  const double size = direct.target().squaredNorm();
  for (Eigen::Index i = 0; i < count; ++i) {
    CHECK_WITH(std::fabs(found[i] - expected[i]) <= 1e-11 * expected[i] + 1e-14 * size, what);
    Eigen::VectorXd residual;
    Eigen::MatrixXd jacobian;
    direct.residuals(candidates.col(i), residual, &jacobian);
    const Eigen::VectorXd gradient = jacobian.transpose() * residual;
    const Eigen::VectorXd scale = jacobian.colwise().norm() * residual.norm();
    compressed.residuals(candidates.col(i), residual, &jacobian);
    const Eigen::VectorXd own = jacobian.transpose() * residual;
    // By a shape that is fixed nothing is sought, and the compressed form may have no derivative.
    const auto sought = (domain.lower.array() < domain.upper.array()).cast<double>();
    const Eigen::ArrayXd apart = (own - gradient).cwiseAbs().array() * sought;
    CHECK_WITH((apart <= 1e-7 * scale.array() + 1e-12 * size).all(), what);
  }
}

CHECK_CASE("general: a decay is its series over every piece") {
  const GeneralRange range{0.02, 1.5, 0.3, 6.0};
  std::string reason;
  const auto pieces = identify::speed_pieces(range, -9.0, 1.3, reason);
  CHECK_WITH(pieces.has_value(), reason);
  const auto points = pieces->points();
  CHECK(points.size() == pieces->moments());
  base::Random random(3, 0, 0, 0);
  double worst = 0.0;
  for (int i = 0; i < 3000; ++i) {
    const double velocity = range.velocity_low * std::pow(75.0, random.uniform());
    const double exponent = range.exponent_low * std::pow(20.0, random.uniform());
    const double speed = -9.0 + 10.3 * random.uniform();
    const double weight = 1.0;
    std::vector<double> row(pieces->moments(), 0.0);
    identify::Span span{row.size(), 0};
    identify::add_moments(*pieces, &speed, &weight, 1, row.data(), span);
    const auto decay = [&](double at) {
      return std::exp(-std::exp(exponent * (at - std::log(velocity))));
    };
    double sum = 0.0;
    for (std::size_t p = 0; p < pieces->pieces(); ++p) {
      const std::size_t first = pieces->first[p];
      if (first != span.begin) continue;
      const auto size = static_cast<Eigen::Index>(pieces->first[p + 1] - first);
      Eigen::MatrixXd values(1, size);
      for (Eigen::Index k = 0; k < size; ++k) {
        values(0, k) = decay(points[first + static_cast<std::size_t>(k)]);
      }
      const Eigen::MatrixXd series = identify::chebyshev_coefficients(values);
      for (Eigen::Index k = 0; k < size; ++k) {
        sum += series(0, k) * row[first + static_cast<std::size_t>(k)];
      }
    }
    worst = std::max(worst, std::fabs(sum - decay(speed)));
  }
  CHECK_WITH(worst < 3e-14, std::to_string(1e14 * worst) + "e-14");
}

CHECK_CASE("general: speeds below all pieces are at rest, those beyond all decays count nothing") {
  std::string reason;
  const auto pieces = identify::speed_pieces({0.1, 0.2, 2.0, 2.0}, -8.0, 9.0, reason);
  CHECK(pieces.has_value());
  std::vector<double> row(pieces->moments(), 0.0);
  const double speeds[] = {model::log_speed(0.0), 8.0};
  const double weights[] = {0.5, 0.25};
  identify::Span span{row.size(), 0};
  identify::add_moments(*pieces, speeds, weights, 2, row.data(), span);
  CHECK(span.begin == 0 && span.end == 1 && row[0] == 0.5);
  CHECK(std::count(row.begin(), row.end(), 0.0) == static_cast<std::ptrdiff_t>(row.size()) - 1);
}

THREADED_CASE("general: equal to the direct sum, with narrow, wide and fixed shapes") {
  const auto direct = penalty_of(false, {0, 0.02});
  check_equal(direct, {0.05, 1.5, 0.5, 4.0}, "default");
  check_equal(direct, {1e-4, 10.0, 0.3, 4.0}, "wide");
  check_equal(direct, {0.05, 1.5, 2.0, 2.0}, "fixed exponent");
  check_equal(direct, {0.1, 0.1, 0.5, 4.0}, "fixed velocity");
}

THREADED_CASE("general: equal with both directions apart, and with running integrals") {
  check_equal(penalty_of(true, {0, 0.02}), {0.05, 1.5, 0.5, 4.0}, "directions");
  check_equal(penalty_of(false, {0, 0.05, 1.0, true}), {0.05, 1.5, 0.5, 4.0}, "running");
}

THREADED_CASE("general: parts over threads give the same bits as one thread") {
  const auto direct = penalty_of(false, {0, 0.02}, 250'000);
  const auto domain = domain_of(direct, {0.05, 1.5, 0.5, 4.0});
  const auto candidates = candidates_of(domain, 20);
  Eigen::VectorXd one(20);
  Eigen::VectorXd four(20);
  base::Pool single(1);
  base::Pool many(4);
  CompressedPenalty(direct, domain, single).evaluate(candidates, one, single);
  CompressedPenalty(direct, domain, many).evaluate(candidates, four, many);
  CHECK(one == four);
}

CHECK_CASE("general: bounds that no table serves are left to the direct sum, for a reason") {
  const auto direct = penalty_of(false, {0, 0.02});
  base::Pool pool(1);
  const CompressedPenalty compressed(direct, domain_of(direct, {1e-5, 10.0, 0.1, 500.0}), pool);
  CHECK(!compressed.exact() && compressed.reason().find("so wide") != std::string::npos);
  const CompressedPenalty zero(direct, domain_of(direct, {0.0, 1.0, 0.5, 4.0}), pool);
  CHECK(!zero.exact() && zero.reason().find("above 0") != std::string::npos);
}

}  // namespace
}  // namespace jointid::tests
