// Candidate motions: they keep their bounds, the information follows from the regressors, and costs
// have the same bits on any number of threads.

#include <cmath>
#include <vector>

#include "base/elementary.hpp"
#include "base/random.hpp"
#include "check.hpp"
#include "design/excitation.hpp"
#include "simulated.hpp"

namespace jointid::tests {
namespace {

using design::Column;
using design::Excitation;
using design::Family;

Column column(const char* key, int shape = -1, double coefficient = 0.0,
              std::vector<double> shapes = {}) {
  return {identify::find_term(key), shape, coefficient, 0.0, std::move(shapes)};
}

Family family() {
  Family made;
  made.sines = 4;
  made.duration = 2.0;
  made.fade = 0.2;
  made.slowest = 1.5;
  made.fastest = 25.0;
  made.bounds = {-0.5, 0.7, 2.0, 40.0, 160.0, 2.6, 20.0, 50.0};
  return made;
}

Eigen::VectorXd genes(std::uint32_t number) {
  base::Random random(7, 0, 0, number);
  Eigen::VectorXd drawn(family().genes());
  for (Eigen::Index i = 0; i < drawn.size(); ++i) drawn[i] = random.uniform();
  return drawn;
}

Excitation excitation() {
  const std::vector<Column> columns{column("coulomb"),
                                    column("static", -1, 0.0, {100.0}),
                                    column("static", 0, 20.0, {100.0}),
                                    column("viscous"),
                                    column("sensor_gain"),
                                    column("sensor_offset")};
  std::vector<design::Drawn> joints;
  for (int i = 0; i < 3; ++i) {
    simulate::Setup setup = thesis_setup();
    setup.joint.friction[2].positive = setup.joint.friction[2].negative = 18.0 + i;
    joints.push_back({setup,
                      columns,
                      {0.5, 0.0, 0.0, 0.01, 0.0},
                      Eigen::VectorXd::Ones(6),
                      Eigen::VectorXd::Ones(6),
                      Eigen::MatrixXd::Identity(6, 6),
                      2.5,
                      20.0});
  }
  simulate::Scenario scenario;
  scenario.duration = 2.0;
  return {family(), scenario, joints, design::Held{}, design::Criterion::worst, 10};
}

CHECK_CASE("design: a motion keeps its bounds, also between the examined samples") {
  for (std::uint32_t number = 0; number < 50; ++number) {
    const auto trajectory = motion_of(family(), genes(number)).trajectory();
    for (int k = 0; k <= 20000; ++k) {
      const auto at = trajectory.at(2.0 * k / 20000);
      const bool inside = at.position > -0.5 && at.position < 0.7 && std::fabs(at.velocity) < 2.0 &&
                          std::fabs(at.acceleration) < 40.0;
      const double effort = std::fabs(2.6 * at.acceleration + 20.0 * at.velocity);
      CHECK_WITH(inside && effort < 110.0, "motion " + std::to_string(number));
    }
  }
}

CHECK_CASE("design: samples of a motion are the motion") {
  const auto trajectory = motion_of(family(), genes(3)).trajectory();
  std::vector<simulate::Reference> wanted(2001);
  trajectory.sample(1e-3, wanted);
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    const auto at = trajectory.at(1e-3 * static_cast<double>(k));
    CHECK_CLOSE(wanted[k].position, at.position, 1e-13);
    CHECK_CLOSE(wanted[k].velocity, at.velocity, 1e-12);
    CHECK_CLOSE(wanted[k].acceleration, at.acceleration, 1e-10);
  }
}

CHECK_CASE("design: the information of a steady motion is known in closed form") {
  simulate::Signals signals;
  for (int k = 0; k <= 1000; ++k) {
    signals.true_position.push_back(0.5e-3 * k);
    signals.true_velocity.push_back(0.5);
    signals.reading.push_back(2.0);
  }
  const std::vector<Column> columns{column("coulomb"), column("viscous"), column("sensor_gain")};
  const auto found =
      design::information(signals, columns, {0.5, 0.0, 0.0, 0.01}, {}, 0.0, 0.0, 1e-3, 10)
          .information;
  // 1000 intervals, each with noise 0.5: a unit of a rate r gives the information 1000 r^2 / 0.25.
  const Eigen::Vector3d rates(1.0, 0.5, 2.0);
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < 3; ++j) {
      CHECK_CLOSE(found(i, j), 4000.0 * rates[i] * rates[j], 1e-8);
    }
  }
}

CHECK_CASE("design: the trapezoidal rule's error for decaying friction counts as a bias") {
  // From rest at a constant acceleration; static friction decays within some samples.
  const double period = 1e-3;
  const double acceleration = 20.0;
  const model::Joint joint = thesis_setup().joint;
  const auto excess = [&](double time) {
    const double velocity = 0.05 + acceleration * time;
    const auto& fading = joint.friction[1];
    return fading.positive * base::exp(-fading.shapes[0] * velocity * velocity);
  };
  simulate::Signals signals;
  double rule = 0.0;
  double exact = 0.0;
  for (int k = 0; k <= 10; ++k) {
    signals.true_position.push_back(0.0);
    signals.true_velocity.push_back(0.05 + acceleration * period * k);
    signals.true_acceleration.push_back(acceleration);
    if (k == 10) break;
    rule += 0.5 * period * (excess(period * k) + excess(period * (k + 1)));
    for (int i = 0; i < 100; ++i) exact += 0.01 * period * excess(period * (k + 0.01 * (i + 0.5)));
  }
  const std::vector<Column> columns{column("coulomb")};
  const design::Noise noise{0.5, 0.0, 0.0, 0.01, 0.0, period};
  const auto told = design::information(signals, columns, noise, joint, 0.0, 0.0, period, 10);
  const double impulse = 10.0 * period;
  const double variance = 10.0 * 0.25 * period * period;
  const double missed = impulse * (exact - rule) / variance;
  CHECK_CLOSE(told.misled[0], missed, 0.02 * std::fabs(missed));
}

CHECK_CASE(
    "design: slow samples give no information, a reversal little, noise at the ends its part") {
  simulate::Signals signals;
  for (int k = 0; k <= 100; ++k) {
    signals.true_velocity.push_back(k < 50 ? -0.5 : 0.5);
    signals.true_position.push_back(0.0);
  }
  const std::vector<Column> columns{column("coulomb")};
  const auto with = [&](design::Noise noise, double inertia) {
    return design::information(signals, columns, noise, {}, inertia, 0.0, 1e-3, 100)
        .information(0, 0);
  };
  CHECK_CLOSE(with({1.0, 0.0, 0.0, 1.0, 0.0}, 0.0), 0.0, 0.0);
  // One window of 100 intervals in which the friction changes its sign in the middle one.
  const double impulse = 1e-3;
  CHECK_CLOSE(with({1.0, 0.0, 0.0, 0.1, 0.0}, 0.0), impulse * impulse / (100.0 * 1e-6), 1e-12);
  CHECK_CLOSE(with({1.0, 0.0, 0.0, 0.1, 0.3}, 0.0), impulse * impulse / (100.0 * 1e-6 + 0.09),
              1e-12);
  CHECK_CLOSE(with({1.0, 0.0, 0.2, 0.1, 0.0}, 3.0), impulse * impulse / (100.0 * 1e-6 + 2.0 * 0.36),
              1e-12);
}

CHECK_CASE("design: costs are the same bits on one thread and on four, before and after others") {
  const Excitation judge = excitation();
  Eigen::MatrixXd candidates(family().genes(), 9);
  for (Eigen::Index i = 0; i < candidates.cols(); ++i) {
    candidates.col(i) = genes(static_cast<std::uint32_t>(i));
  }
  Eigen::VectorXd one;
  Eigen::VectorXd four;
  base::Pool alone(1);
  base::Pool several(4);
  judge.evaluate(candidates, one, alone);
  judge.evaluate(candidates, four, several);
  for (Eigen::Index i = 0; i < candidates.cols(); ++i) CHECK(one[i] == four[i]);
  const auto trajectory = motion_of(family(), candidates.col(3)).trajectory();
  CHECK(base::exp(judge.cost(judge.judge(trajectory, base::Cancel{}))) == one[3]);
}

CHECK_CASE("design: parameters that no motion determines are not requested") {
  Excitation judge = excitation();
  Eigen::MatrixXd candidates(family().genes(), 2);
  candidates << genes(0), genes(1);
  base::Pool pool(2);
  judge.leave_out(candidates, 1e-9, pool);
  for (const auto& joint : judge.joints()) CHECK(joint.weight.maxCoeff() == 0.0);
}

}  // namespace
}  // namespace jointid::tests
