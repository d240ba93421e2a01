// Minima over halved and over joined windows, compared with searches over newly cut windows.

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "check.hpp"
#include "identify/penalty/penalty_parts.hpp"
#include "identify/solve/refit.hpp"
#include "identify/solve/window_shifts.hpp"
#include "synthetic.hpp"

namespace jointid::tests {
namespace window_shifts {

using identify::Penalty;
using identify::Recording;
using identify::Residual;

const std::vector<std::string> kTerms{"inertia", "coulomb",     "static",
                                      "viscous", "sensor_gain", "sensor_offset"};

/// A joint with a link on the sensor. Its friction rises with time, which no model includes.
Recording drifting() {
  constexpr int kSamples = 12000;
  const Truth truth;
  Recording r = moving(kSamples, 0.001, true, 3);
  add_torque(r, truth, false);
  r.sensor.resize(kSamples);
  for (Eigen::Index k = 0; k < kSamples; ++k) {
    r.sensor[k] = (9.0 * std::sin(r.position[k]) - truth.sensor_offset) / truth.sensor_gain;
  }
  for (Eigen::Index k = 0; k + 1 < kSamples; ++k) {
    r.torque[k] += truth.sensor_gain * 0.5 * (r.sensor[k] + r.sensor[k + 1]) + truth.sensor_offset +
                   0.2 * truth.viscous * static_cast<double>(k) / kSamples * r.velocity[k];
  }
  return r;
}

search::Domain domain() {
  Eigen::VectorXd lower(7);
  Eigen::VectorXd upper(7);
  lower << 2.5, 0.0, 0.0, 0.0, 0.1, -30.0, 5.0;  // the inertia is known
  upper << 2.5, 60.0, 60.0, 60.0, 20.0, 30.0, 200.0;
  return {std::move(lower), std::move(upper)};
}

std::shared_ptr<const identify::MaskedRecording> masked(const Recording& recording) {
  return std::make_shared<const identify::MaskedRecording>(
      recording, identify::usable_intervals(recording, true));
}

CHECK_CASE("window shifts: as with newly cut windows, for any number of threads") {
  const Recording recording = drifting();
  const auto run = masked(recording);
  // An even number of windows, so that both others nest.
  const double duration = (recording.time[recording.samples() - 1] - recording.time[0]) / 1200.0;
  for (const auto residual : {Residual::sensor, Residual::torque, Residual::instruments}) {
    Penalty penalty({run}, kTerms, {0, duration}, residual);
    if (residual == Residual::instruments) penalty.project_reading(domain().free());
    const identify::PenaltyParts same({run}, kTerms, {0, duration}, residual, 1.0, {});
    Eigen::VectorXd start = 0.5 * (domain().lower + domain().upper);
    const Eigen::VectorXd best = identify::refit(same, domain(), start, nullptr);
    base::Pool pool(2);
    const auto found =
        identify::window_shifts(penalty, {run}, kTerms, 1.0, {}, domain(), best, nullptr);
    const auto shared =
        identify::window_shifts(penalty, {run}, kTerms, 1.0, {}, domain(), best, &pool);
    CHECK(found.halved && found.doubled && shared.halved && shared.doubled);
    CHECK(*found.halved == *shared.halved);
    CHECK(*found.doubled == *shared.doubled);
    for (const bool doubled : {false, true}) {
      const identify::PenaltyParts other(
          {run}, kTerms, {0, doubled ? 2.0 * duration : 0.5 * duration}, residual, 1.0, {});
      const Eigen::VectorXd expected = identify::refit(other, domain(), best, nullptr) - best;
      const Eigen::VectorXd moved = (doubled ? *found.doubled : *found.halved) - best;
      for (Eigen::Index i = 0; i < best.size(); ++i) {
        CHECK_CLOSE(moved[i], expected[i],
                    0.03 * std::fabs(expected[i]) + 2e-4 * std::fabs(best[i]));
      }
    }
  }
}

CHECK_CASE("window shifts: none where windows cannot be halved or are too few to be joined") {
  const Recording recording = drifting();
  const auto run = masked(recording);
  const Eigen::VectorXd best = 0.5 * (domain().lower + domain().upper);
  const Penalty finest({run}, kTerms, {0, run->period()}, Residual::torque);
  const auto single =
      identify::window_shifts(finest, {run}, kTerms, 1.0, {}, domain(), best, nullptr);
  CHECK(!single.halved);
  CHECK(single.doubled.has_value());
  const Penalty few({run}, kTerms, {8, 0.0}, Residual::torque);
  const auto joined = identify::window_shifts(few, {run}, kTerms, 1.0, {}, domain(), best, nullptr);
  CHECK(joined.halved.has_value());
  CHECK(!joined.doubled);
}

}  // namespace window_shifts
}  // namespace jointid::tests
