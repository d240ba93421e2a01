// A balance's residual without columns, compared with the residual from its columns.

#include <memory>
#include <vector>

#include "check.hpp"
#include "identify/penalty/penalty_parts.hpp"
#include "synthetic.hpp"

namespace jointid::tests {
namespace {

using identify::Hold;
using identify::Penalty;
using identify::PenaltyParts;
using identify::Residual;

/// Reversals, a stop, a gap, and speeds at which a decay has vanished.
identify::Recording eventful(Hold hold) {
  auto r = moving(3001, 1e-3, true, 9);
  add_torque(r, Truth{}, true);
  add_noise(r, 3.0, 4);
  for (Eigen::Index k = 1200; k < 1260; ++k) r.velocity[k] = 0.0;
  r.gap_after = {2000};
  r.torque_hold = hold;
  return r;
}

/// The largest difference of the residuals over their size, over short windows.
double apart(const std::vector<std::string>& terms, Hold hold, Residual residual) {
  const auto recording = eventful(hold);
  const Penalty::Masked masked{std::make_shared<const identify::MaskedRecording>(
      recording, identify::usable_intervals(recording, true))};
  identify::WindowOptions windows;
  windows.duration = 0.0022;
  const PenaltyParts parts(masked, terms, windows, residual, 7.0, {});
  Eigen::VectorXd theta(parts.parameters());
  for (Eigen::Index i = 0; i < theta.size(); ++i) theta[i] = 1.5 + 0.3 * static_cast<double>(i);
  double largest = 0.0;
  for (std::size_t i = 0; i < parts.count(); ++i) {
    const auto found = parts.residuals(i, theta);
    const Penalty whole = parts.part(i);
    Eigen::VectorXd wanted;
    whole.residuals(theta, wanted, nullptr);
    if (residual == Residual::sensor) wanted *= theta[whole.gain_index()];
    CHECK(found.windows.size() == whole.windows().size());
    CHECK((found.duration - whole.usable_duration()).cwiseAbs().maxCoeff() == 0.0);
    const double size = wanted.cwiseAbs().maxCoeff();
    CHECK(size > 1e-4);
    largest = std::fmax(largest, (found.torque - wanted).cwiseAbs().maxCoeff() / size);
  }
  return largest;
}

}  // namespace

CHECK_CASE("residual: the same without columns as with them, for each kind of term") {
  const std::vector<std::vector<std::string>> balances{
      {"inertia", "coulomb", "static", "viscous", "sensor_gain", "sensor_offset"},
      {"inertia", "coulomb", "static_general", "viscous", "torque_offset"},
      {"inertia", "coulomb_positive", "coulomb_negative", "static_positive", "static_negative",
       "viscous_positive", "viscous_negative", "torque_offset"},
      {"inertia", "coulomb", "viscous", "gravity_cos", "gravity_sin", "ripple_cos_2",
       "ripple_sin_2"},
      {"inertia", "coulomb", "viscous", "load_friction"},
  };
  for (const auto& terms : balances) {
    for (const Hold hold : {Hold::zero_order, Hold::linear}) {
      CHECK(apart(terms, hold, Residual::torque) < 1e-11);
    }
  }
  CHECK(apart(balances[0], Hold::zero_order, Residual::sensor) < 1e-11);
}

}  // namespace jointid::tests
