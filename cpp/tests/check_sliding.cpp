// The sliding penalty against the penalty over the same windows.

#include <algorithm>
#include <string>
#include <vector>

#include "check.hpp"
#include "identify/compressed/sliding_penalty.hpp"
#include "identify/solve/separable.hpp"
#include "synthetic.hpp"

namespace jointid::tests {
namespace sliding {

using identify::Penalty;
using identify::Residual;
using identify::SlidingPenalty;

const std::vector<std::string> kTerms{"inertia", "coulomb",     "static",
                                      "viscous", "sensor_gain", "sensor_offset"};

search::Domain domain() {
  Eigen::VectorXd lower(7);
  Eigen::VectorXd upper(7);
  lower << 0, 0, 0, 0, 0.1, -30, 0;
  upper << 50, 50, 50, 50, 5, 30, 200;
  return {lower, upper};
}

identify::Recording recorded(int samples) {
  auto r = moving(samples, 0.001, false, 3);
  add_torque(r, {}, true);
  add_noise(r, 0.5, 3);
  return r;
}

SlidingPenalty sliding(const identify::Recording& r, double speed = 4.5) {
  return {kTerms, Residual::sensor, 1.0, 0.02, true, identify::motion_scale(r), domain(), speed};
}

CHECK_CASE("sliding: stretches add up to the penalty over the same windows") {
  const auto r = recorded(4001);
  const Penalty whole({r}, kTerms, {0, 0.02}, Residual::sensor, true);
  auto parts = sliding(r);
  for (Eigen::Index begin = 0; begin < 4000; begin += 500) parts.append(r, begin, begin + 500);
  CHECK(parts.window_count() == whole.window_count());
  CHECK(parts.begin() == r.time[0] && parts.end() == r.time[4000]);
  CHECK_CLOSE(parts.usable_duration(), whole.usable_duration().sum(), 1e-12);
  const auto compressed = parts.compressed();
  CHECK(compressed.has_value());
  if (!compressed) return;
  CHECK_WITH(compressed->exact(), compressed->reason());
  const Eigen::VectorXd theta = 0.7 * domain().lower + 0.3 * domain().upper;
  CHECK_CLOSE((*compressed)(theta), whole(theta), 1e-10 * whole(theta));
  Eigen::VectorXd residual;
  Eigen::MatrixXd jacobian;
  parts.residuals(theta, residual, jacobian);
  CHECK_CLOSE(residual.squaredNorm(), whole(theta), 1e-12 * whole(theta));
  CHECK(jacobian.rows() == whole.window_count() && jacobian.cols() == 7);
}

CHECK_CASE("sliding: forgotten stretches no longer count") {
  const auto r = recorded(4001);
  auto parts = sliding(r);
  auto late = sliding(r);
  for (Eigen::Index begin = 0; begin < 4000; begin += 500) {
    parts.append(r, begin, begin + 500);
    if (begin >= 2000) late.append(r, begin, begin + 500);
  }
  parts.forget(r.time[2000]);
  CHECK(parts.stretches() == 4 && parts.begin() == r.time[2000]);
  const Eigen::VectorXd theta = 0.7 * domain().lower + 0.3 * domain().upper;
  CHECK((*parts.compressed())(theta) == (*late.compressed())(theta));
  parts.forget(1e9);
  CHECK(parts.stretches() == 0 && !parts.compressed().has_value());
}

CHECK_CASE("sliding: context shows whether the joint stands still at a stretch's end") {
  auto r = recorded(2001);
  for (Eigen::Index k = 900; k < 1200; ++k) {
    r.velocity[k] = 0.0;
    r.position[k] = r.position[900];
  }
  auto parts = sliding(r);
  parts.append(r, 0, 1000);
  parts.append(r, 1000, 2000);
  const Penalty whole({r}, kTerms, {0, 0.02}, Residual::sensor, true);
  CHECK_CLOSE(parts.usable_duration(), whole.usable_duration().sum(), 1e-12);
}

CHECK_CASE("sliding: a pause of many stretches, exact or noisy, is judged by the whole motion") {
  for (const double noise : {0.0, 1e-6}) {
    auto r = recorded(6001);
    for (Eigen::Index k = 1900; k < 4600; ++k) {
      const double sign = k % 2 == 0 ? 1.0 : -1.0;
      r.position[k] = r.position[1900] + sign * noise;
      r.velocity[k] = 1e3 * sign * noise;
    }
    auto parts = sliding(r);
    for (Eigen::Index begin = 0; begin < 6000; begin += 500) {
      const Eigen::Index before = std::max<Eigen::Index>(0, begin - 150);
      const Eigen::Index after = std::min<Eigen::Index>(6001, begin + 651);
      const auto cut = [&](const Eigen::VectorXd& signal) {
        return identify::RecordingView::Signal(signal.data() + before, after - before);
      };
      parts.append({cut(r.time),
                    cut(r.position),
                    cut(r.velocity),
                    cut(r.torque),
                    cut(r.sensor),
                    r.torque_hold,
                    {}},
                   begin - before, begin - before + 500);
    }
    const Penalty whole({r}, kTerms, {0, 0.02}, Residual::sensor, true);
    CHECK(whole.usable_duration().sum() < 3.5);
    CHECK_CLOSE(parts.usable_duration(), whole.usable_duration().sum(), 0.01);
    CHECK(parts.window_count() == whole.window_count());
  }
}

CHECK_CASE("sliding: refuses what it cannot serve") {
  const auto r = recorded(2001);
  auto parts = sliding(r);
  parts.append(r, 500, 1000);
  CHECK_REFUSED(parts.append(r, 900, 1500), "before the last one's end");
  CHECK_REFUSED(parts.append(r, 1500, 2001), "not within the 2001 samples");
  CHECK_REFUSED(sliding(r, 1.0).append(r, 0, 500), "faster than the");
  CHECK_REFUSED(sliding(r, 0.0), "speed and window_duration must be above 0");
  auto still = r;
  still.velocity.setZero();
  CHECK_REFUSED(sliding(still), "must be that of a motion");
}

}  // namespace sliding
}  // namespace jointid::tests
