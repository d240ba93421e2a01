// The integral penalty on recordings with known parameters.

#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "check.hpp"
#include "identify/penalty/penalty.hpp"
#include "synthetic.hpp"

namespace jointid::tests {
namespace {

using identify::Penalty;
using identify::Recording;
using identify::Residual;
using identify::WindowOptions;

using Names = std::vector<std::string>;
const Names kWithSensor{"inertia", "coulomb", "static", "viscous", "sensor_gain", "sensor_offset"};
const Names kTorqueOnly{"inertia", "coulomb", "static", "viscous", "torque_offset"};

Eigen::VectorXd parameters(const Truth& t, bool with_sensor) {
  Eigen::VectorXd theta(with_sensor ? 7 : 6);
  if (with_sensor) {
    theta << t.inertia, t.coulomb, t.static_excess, t.viscous, t.sensor_gain, t.sensor_offset,
        t.stribeck;
  } else {
    theta << t.inertia, t.coulomb, t.static_excess, t.viscous, t.torque_offset, t.stribeck;
  }
  return theta;
}

Recording recorded(const Truth& truth, bool with_sensor, int samples = 3000,
                   std::uint64_t seed = 1) {
  auto r = moving(samples, 0.001, true, seed);
  add_torque(r, truth, with_sensor);
  return r;
}

Penalty penalty_of(std::vector<Recording> recordings, const Names& names, Residual residual,
                   WindowOptions windows = {0, 0.02}) {
  return Penalty(std::move(recordings), names, windows, residual, true);
}

CHECK_CASE("penalty: zero at the truth to rounding") {
  Truth truth;
  truth.torque_offset = 0.7;
  for (const auto& windows : {WindowOptions{}, WindowOptions{40, 0.0}, WindowOptions{0, 0.013}}) {
    const auto torque =
        penalty_of({recorded(truth, false)}, kTorqueOnly, Residual::torque, windows);
    const auto theta = parameters(truth, false);
    const double scale = torque.target().squaredNorm();
    CHECK_CLOSE(torque(theta) / scale, 0.0, 1e-26);
    for (Eigen::Index i = 0; i < theta.size(); ++i) {
      Eigen::VectorXd off = theta;
      off[i] *= 1.001;
      CHECK_WITH(torque(off) > 1e-14 * scale, torque.names()[static_cast<std::size_t>(i)]);
    }
  }
  truth.torque_offset = 0.0;
  for (const double gain : {1.4, -0.6}) {
    truth.sensor_gain = gain;
    const auto theta = parameters(truth, true);
    for (const auto residual : {Residual::torque, Residual::sensor}) {
      const auto penalty = penalty_of({recorded(truth, true)}, kWithSensor, residual);
      CHECK_CLOSE(penalty(theta) / penalty.target().squaredNorm(), 0.0, 1e-26);
    }
  }
}

CHECK_CASE("penalty: zero at the truth with stuck samples and a gap, thanks to the mask") {
  const Truth truth;
  auto r = moving(3000, 0.001, false, 2);
  Eigen::Index stuck = 1000;  // from full motion, so that nothing next to the run counts as slow
  while (std::fabs(r.velocity[stuck]) < 2.0 || std::fabs(r.velocity[stuck + 80]) < 2.0) ++stuck;
  const double moved = r.position[stuck + 79] - r.position[stuck];
  r.position.segment(stuck, 80).setConstant(r.position[stuck]);
  r.velocity.segment(stuck, 80).setZero();
  r.position.tail(3000 - stuck - 80).array() -= moved;
  r.gap_after = {2000};
  r.time.tail(999).array() += 3.0;
  add_torque(r, truth, false);
  r.torque.segment(stuck, 79).array() += 11.0;  // set-valued: anything up to break-away
  r.torque[2000] = -500.0;                      // the held torque in the gap has no meaning
  const Names names{"inertia", "coulomb", "static", "viscous"};
  Eigen::VectorXd theta(5);
  theta << truth.inertia, truth.coulomb, truth.static_excess, truth.viscous, truth.stribeck;
  const auto masked = penalty_of({r}, names, Residual::torque);
  CHECK_CLOSE(masked(theta) / masked.target().squaredNorm(), 0.0, 1e-26);
  CHECK_CLOSE(masked.standing_samples(), 80, 2);
  CHECK_CLOSE(masked.total_samples(), 3000, 0.0);
  const Penalty unmasked({r}, names, {0, 0.02}, Residual::torque, false);
  CHECK(unmasked(theta) > 1e-4 * unmasked.target().squaredNorm());
}

CHECK_CASE("penalty: the sensor residual is the torque residual over the gain") {
  Truth truth;
  auto r = recorded(truth, true);
  add_noise(r, 0.5, 1);
  const auto torque = penalty_of({r}, kWithSensor, Residual::torque);
  const auto sensor = penalty_of({r}, kWithSensor, Residual::sensor);
  Eigen::VectorXd theta = parameters(truth, true);
  theta.array() *= 1.07;
  Eigen::VectorXd in_torque;
  Eigen::VectorXd in_sensor;
  for (const double gain : {0.3, 1.9, -2.4}) {
    theta[4] = gain;
    torque.residuals(theta, in_torque, nullptr);
    sensor.residuals(theta, in_sensor, nullptr);
    const double largest = in_sensor.cwiseAbs().maxCoeff();
    CHECK_CLOSE((in_sensor - in_torque / gain).cwiseAbs().maxCoeff(), 0.0, 1e-14 * largest);
    CHECK_CLOSE(sensor(theta), in_sensor.squaredNorm(), 1e-13 * sensor(theta));
  }
}

CHECK_CASE("penalty: the Jacobian matches central differences, both residuals") {
  const Truth truth;
  auto r = recorded(truth, true);
  add_noise(r, 0.5, 2);
  for (const auto residual : {Residual::torque, Residual::sensor}) {
    const auto penalty = penalty_of({r}, kWithSensor, residual);
    for (const double gain : {1.2, -0.8}) {
      Eigen::VectorXd theta = parameters(truth, true) * 0.9;
      theta[4] = gain;
      Eigen::VectorXd value;
      Eigen::MatrixXd jacobian;
      penalty.residuals(theta, value, &jacobian);
      for (Eigen::Index i = 0; i < theta.size(); ++i) {
        const double step = 1e-5 * (1.0 + std::fabs(theta[i]));
        Eigen::VectorXd above = theta;
        Eigen::VectorXd below = theta;
        above[i] += step;
        below[i] -= step;
        Eigen::VectorXd high;
        Eigen::VectorXd low;
        penalty.residuals(above, high, nullptr);
        penalty.residuals(below, low, nullptr);
        const Eigen::VectorXd difference = (high - low) / (above[i] - below[i]);
        CHECK_CLOSE((jacobian.col(i) - difference).norm() / difference.norm(), 0.0, 1e-7);
      }
    }
  }
}

CHECK_CASE("penalty: several recordings add up, and keep their windows apart") {
  Truth truth;
  std::vector<Recording> recordings{recorded(truth, true, 3000, 1), recorded(truth, true, 2500, 2),
                                    recorded(truth, true, 4000, 3)};
  for (auto& r : recordings) add_noise(r, 0.3, 3);
  std::vector<std::vector<std::uint8_t>> masks;
  for (const auto& r : recordings) masks.push_back(usable_intervals(r, true).usable);
  const Eigen::VectorXd theta = 0.95 * parameters(truth, true);
  for (const auto residual : {Residual::torque, Residual::sensor}) {
    double sum = 0.0;
    Eigen::Index rows = 0;
    for (const auto& r : recordings) {
      const auto one = penalty_of({r}, kWithSensor, residual);
      sum += one(theta);
      rows += one.window_count();
    }
    const auto all = penalty_of(recordings, kWithSensor, residual);
    CHECK_CLOSE(all(theta), sum, 1e-13 * sum);
    CHECK(all.window_count() == rows);
    CHECK_CLOSE(all.total_samples(), 9500, 0.0);
    const auto& windows = all.windows();
    for (std::size_t w = 0; w < windows.size(); ++w) {
      const auto& of = recordings[static_cast<std::size_t>(all.recording_of()[w])];
      CHECK(windows[w].begin >= 0 && windows[w].end <= of.samples() - 1);
      const auto& usable = masks[static_cast<std::size_t>(all.recording_of()[w])];
      double expected = 0.0;
      for (auto k = windows[w].begin; k < windows[w].end; ++k) {
        if (usable[static_cast<std::size_t>(k)] != 0) expected += of.time[k + 1] - of.time[k];
      }
      CHECK_CLOSE(all.usable_duration()[static_cast<Eigen::Index>(w)], expected, 1e-12);
    }
  }
}

CHECK_CASE("penalty: a population's penalties are the same bits as one by one") {
  const auto penalty = penalty_of({recorded({}, true)}, kWithSensor, Residual::sensor);
  Eigen::MatrixXd candidates = parameters({}, true).replicate(1, 41);
  base::Random random(1, 0, 0, 0);
  for (double& value : candidates.reshaped()) value *= 0.5 + random.uniform();
  for (const int threads : {1, 2, 7}) {
    base::Pool pool(threads);
    Eigen::VectorXd penalties;
    penalty.evaluate(candidates, penalties, pool);
    for (Eigen::Index i = 0; i < 41; ++i) CHECK(penalties[i] == penalty(candidates.col(i)));
  }
}

CHECK_CASE("penalty: bad terms and windows are refused with their name") {
  const auto r = recorded({}, false);
  const auto with = recorded({}, true);
  const auto torque = Residual::torque;
  CHECK_REFUSED(penalty_of({}, kTorqueOnly, torque), "at least one recording");
  CHECK_REFUSED(penalty_of({r}, {}, torque), "at least one term");
  CHECK_REFUSED(penalty_of({r}, {"colomb"}, torque), "'colomb': choose one of inertia, coulomb");
  CHECK_REFUSED(penalty_of({r}, {"viscous", "viscous"}, torque), "'viscous' is listed twice");
  CHECK_REFUSED(penalty_of({r}, kTorqueOnly, Residual::sensor), "sensor_gain");
  CHECK_REFUSED(penalty_of({with, r}, kWithSensor, torque), "sensor signal");
  CHECK_REFUSED(penalty_of({r}, kTorqueOnly, torque, {0, 60.0}), "60");
  CHECK_REFUSED(penalty_of({r}, kTorqueOnly, torque, {5, 0.0}), "5 windows");
  CHECK_REFUSED(penalty_of({r}, kTorqueOnly, torque, {3000, 0.0}), "3000 windows");
  CHECK_REFUSED(penalty_of({r}, kTorqueOnly, torque, {10, 0.1}), "not both");
}

CHECK_CASE("penalty: bad recordings and parameters are refused with their name") {
  const auto refused = [](auto spoil, std::string_view part) {
    auto r = recorded({}, true);
    spoil(r);
    CHECK_REFUSED(penalty_of({r}, kWithSensor, Residual::torque), part);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  refused([&](Recording& r) { r.torque[17] = nan; }, "torque is not finite at sample 17");
  refused([&](Recording& r) { r.sensor[5] = -1.0 / 0.0; }, "sensor is not finite at sample 5");
  refused([](Recording& r) { r.velocity.conservativeResize(7); }, "velocity has 7 samples");
  refused([](Recording& r) { r.time[9] = r.time[8]; },
          "time must increase, it does not at sample 9");
  refused([](Recording& r) { r.gap_after = {2999}; }, "gap_after");
  refused([](Recording& r) { r = moving(7, 0.01, false, 1); }, "at least 8 samples, got 7");
  const auto penalty = penalty_of({recorded({}, true)}, kWithSensor, Residual::sensor);
  CHECK_REFUSED(penalty(Eigen::VectorXd::Ones(6)), "7 values, got 6");
  CHECK_REFUSED(penalty(Eigen::VectorXd::Zero(7)), "sensor_gain must not be 0");
}

}  // namespace
}  // namespace jointid::tests
