// The gain by instruments is free of bias. In a plain regression, noise of the reading, or friction
// that the model lacks, biases it to either side.

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "check.hpp"
#include "identify/compressed/compressed_penalty.hpp"
#include "identify/penalty/penalty.hpp"
#include "identify/penalty/penalty_parts.hpp"
#include "identify/solve/refit.hpp"
#include "identify/solve/separable.hpp"
#include "synthetic.hpp"

namespace jointid::tests {
namespace {

using identify::Penalty;
using identify::Recording;
using identify::Residual;

const std::vector<std::string> kTerms{"inertia", "coulomb",     "static",
                                      "viscous", "sensor_gain", "sensor_offset"};
constexpr Eigen::Index kGain = 4;

/// A link under gravity on the sensor, with a noisy reading; viscous friction falls by `drift`.
Recording hanging(double noise, double drift, int samples = 12000) {
  const Truth truth;
  Recording r = moving(samples, 0.001, true, 3);
  add_torque(r, truth, false);
  base::Random random(5, 2, 0, 0);
  r.sensor.resize(samples);
  for (Eigen::Index k = 0; k < samples; ++k) {
    r.sensor[k] = (9.0 * std::sin(r.position[k]) - truth.sensor_offset) / truth.sensor_gain;
  }
  for (Eigen::Index k = 0; k + 1 < samples; ++k) {
    r.torque[k] += truth.sensor_gain * 0.5 * (r.sensor[k] + r.sensor[k + 1]) + truth.sensor_offset -
                   drift * truth.viscous * static_cast<double>(k) / samples * r.velocity[k];
  }
  for (double& reading : r.sensor) reading += noise * (2.0 * random.uniform() - 1.0);
  return r;
}

Penalty penalty_of(const Recording& r, Residual residual) {
  return Penalty({r}, kTerms, {0, 0.01}, residual, true);
}

search::Domain domain() {
  Eigen::VectorXd lower(7);
  Eigen::VectorXd upper(7);
  lower << 2.5, 0.0, 0.0, 0.0, 0.1, -30.0, 5.0;  // the inertia is known
  upper << 2.5, 60.0, 60.0, 60.0, 20.0, 30.0, 200.0;
  return {std::move(lower), std::move(upper)};
}

Eigen::VectorXd best_of(const identify::PenaltyFunction& penalty) {
  base::Pool pool(1);
  return identify::minimise_separable(penalty, domain(), pool).best;
}

Eigen::VectorXd by(const Recording& r, Residual residual) {
  Penalty penalty = penalty_of(r, residual);
  if (residual == Residual::instruments) penalty.project_reading(domain().free());
  return best_of(penalty);
}

CHECK_CASE("instruments: before the first stage the residual is that of the torque, to the bit") {
  const auto r = hanging(1.0, 0.0);
  const auto torque = penalty_of(r, Residual::torque);
  const auto waiting = penalty_of(r, Residual::instruments);
  const Eigen::VectorXd theta = 0.9 * domain().upper;
  CHECK(waiting(theta) == torque(theta));
  CHECK(!waiting.first_stage());
}

CHECK_CASE("instruments: neither noise of the reading nor drifting friction biases the gain") {
  const double gain = Truth{}.sensor_gain;
  const auto noisy = hanging(12.0, 0.0);
  CHECK(by(noisy, Residual::torque)[kGain] < 0.8 * gain);
  CHECK_CLOSE(by(noisy, Residual::instruments)[kGain], gain, 0.02 * gain);
  const auto drifting = hanging(0.1, 0.3);
  CHECK(by(drifting, Residual::sensor)[kGain] > 1.2 * gain);
  CHECK_CLOSE(by(drifting, Residual::instruments)[kGain], gain, 0.05 * gain);
}

CHECK_CASE("instruments: the exact reading gives the exact gain") {
  CHECK_CLOSE(by(hanging(0.0, 0.0), Residual::instruments)[kGain], Truth{}.sensor_gain, 1e-3);
}

CHECK_CASE("instruments: direct, compressed and part by part have one minimum") {
  const auto r = hanging(3.0, 0.0);
  Penalty direct = penalty_of(r, Residual::instruments);
  direct.project_reading(domain().free());
  base::Pool pool(2);
  const identify::CompressedPenalty compressed(direct, domain(), pool);
  CHECK(compressed.exact());
  const Eigen::VectorXd best = best_of(direct);
  CHECK_CLOSE(compressed(best) / direct(best), 1.0, 1e-9);
  const auto masked =
      std::make_shared<const identify::MaskedRecording>(r, identify::usable_intervals(r, true));
  const identify::PenaltyParts parts({masked}, kTerms, {0, 0.01}, Residual::instruments, 1.0, {});
  CHECK(parts.count() > 1);
  const Eigen::VectorXd again = identify::refit(parts, domain(), 1.02 * best, &pool);
  for (Eigen::Index i = 0; i < best.size(); ++i)
    CHECK_CLOSE(again[i], best[i], 2e-5 * std::fabs(best[i]) + 1e-6);
}

CHECK_CASE("instruments: the observed residual has the reading itself") {
  const auto r = hanging(3.0, 0.0);
  const auto torque = penalty_of(r, Residual::torque);
  Penalty projected = penalty_of(r, Residual::instruments);
  projected.project_reading(domain().free());
  const Eigen::VectorXd best = best_of(projected);
  Eigen::VectorXd expected;
  Eigen::VectorXd observed;
  torque.residuals(best, expected, nullptr);
  Eigen::MatrixXd jacobian;
  projected.residuals(best, observed, &jacobian);
  CHECK(observed.norm() < 0.5 * expected.norm());
  projected.observe(best, observed);
  CHECK_CLOSE((observed - expected).norm() / expected.norm(), 0.0, 1e-12);
  // The moments vanish, as two-stage least squares requires.
  for (const auto i : {1, 2, 3, 4, 5}) {
    const double cosine =
        jacobian.col(i).dot(observed) / (jacobian.col(i).norm() * observed.norm());
    CHECK_CLOSE(cosine, 0.0, 1e-3);
  }
}

CHECK_CASE("instruments: a reading that the motion does not explain makes them weak") {
  auto r = hanging(0.5, 0.0);
  Penalty strong = penalty_of(r, Residual::instruments);
  strong.project_reading(domain().free());
  CHECK(!strong.first_stage()->weak());
  CHECK(!strong.first_stage()->acceleration);
  base::Random random(9, 3, 0, 0);
  for (double& reading : r.sensor) reading = random.uniform();
  Penalty weak = penalty_of(r, Residual::instruments);
  weak.project_reading(domain().free());
  CHECK(weak.first_stage()->weak());
  Penalty other = penalty_of(r, Residual::torque);
  CHECK_REFUSED(other.project_reading(domain().free()), "instruments");
}

}  // namespace
}  // namespace jointid::tests
