// Load friction: the balance solved for the torque, compared with torques made sample by sample.

#include "check.hpp"
#include "identify/balance/load_friction.hpp"
#include "identify/compressed/compressed_penalty.hpp"
#include "identify/penalty/penalty_parts.hpp"
#include "identify/solve/refit.hpp"
#include "identify/solve/separable.hpp"
#include "synthetic.hpp"

namespace jointid::tests {
namespace load_friction {

using identify::Penalty;
using identify::Residual;

const std::vector<std::string> kTerms{"inertia",       "coulomb",     "viscous",
                                      "load_friction", "sensor_gain", "sensor_offset"};

/// A moving joint with a sensor. Its torque has load friction by the drive's torque or the link's.
identify::Recording loaded(double share, bool by_link) {
  auto r = moving(4001, 1e-3, false, 3);
  Truth truth;
  truth.static_excess = 0.0;
  add_torque(r, truth, true);
  for (Eigen::Index k = 0; k + 1 < r.samples(); ++k) {
    const double v = r.velocity[k] + r.velocity[k + 1];
    const double direction = v < 0.0 ? -1.0 : 1.0;
    const double link =
        0.5 * truth.sensor_gain * (r.sensor[k] + r.sensor[k + 1]) + truth.sensor_offset;
    r.torque[k] = by_link ? identify::loaded_by_link(r.torque[k], link, direction, share).value
                          : identify::loaded_by_drive(r.torque[k], direction, share).value;
  }
  return r;
}

std::vector<std::string> terms_for(bool by_link) {
  auto terms = kTerms;
  if (by_link) terms[3] = "load_friction_link";
  return terms;
}

Penalty penalty_for(bool by_link, Residual residual, bool cumulative = false) {
  identify::WindowOptions windows;
  windows.duration = 0.01;
  windows.cumulative = cumulative;
  return Penalty({loaded(0.2, by_link)}, terms_for(by_link), windows, residual, true);
}

search::Domain domain() {
  search::Domain box;
  box.lower.resize(6);
  box.upper.resize(6);
  box.lower << 0.0, 0.0, 0.0, 0.1, -50.0, 0.0;
  box.upper << 10.0, 100.0, 100.0, 10.0, 50.0, 0.95;
  return box;
}

CHECK_CASE("load friction: the torque solves tau = F + c |tau| sgn v") {
  for (const double torque : {-7.0, 3.0}) {
    for (const double direction : {-1.0, 1.0}) {
      const auto drive = identify::loaded_by_drive(torque, direction, 0.3);
      CHECK_CLOSE(drive.value, torque + 0.3 * std::fabs(drive.value) * direction, 1e-14);
      const auto more = identify::loaded_by_drive(torque, direction, 0.3 + 1e-7);
      CHECK_CLOSE(drive.by_coefficient, (more.value - drive.value) / 1e-7, 1e-4);
      const auto link = identify::loaded_by_link(torque, -4.0, direction, 0.3);
      CHECK_CLOSE(link.value, torque + 0.3 * 4.0 * direction, 1e-14);
      CHECK_CLOSE(link.by_link, -0.3 * direction, 1e-14);
    }
  }
}

CHECK_CASE("load friction: names, and no column of its own") {
  const auto penalty = penalty_for(false, Residual::torque);
  CHECK(penalty.coefficients() == 5);
  CHECK(penalty.names().back() == "load_friction");
  CHECK(!penalty.is_linear());
  base::Pool pool(1);
  const identify::CompressedPenalty compressed(penalty, domain(), pool);
  CHECK(!compressed.exact());
  CHECK(compressed.reason() == "load friction acts on the sum of all other terms");
}

CHECK_CASE("load friction: the Jacobian is the residuals' difference, also of running sums") {
  for (const bool by_link : {false, true}) {
    for (const bool cumulative : {false, true}) {
      for (const auto residual : {Residual::torque, Residual::sensor}) {
        const auto penalty = penalty_for(by_link, residual, cumulative);
        Eigen::VectorXd theta(6);
        theta << 2.4, 24.0, 17.0, 1.5, -2.0, 0.15;
        Eigen::VectorXd at;
        Eigen::MatrixXd jacobian;
        penalty.residuals(theta, at, &jacobian);
        for (Eigen::Index j = 0; j < theta.size(); ++j) {
          const double step = 1e-6;
          Eigen::VectorXd moved = theta;
          moved[j] += step;
          Eigen::VectorXd above;
          penalty.residuals(moved, above, nullptr);
          const double error = ((above - at) / step - jacobian.col(j)).norm();
          CHECK_WITH(error < 1e-4 * (1.0 + jacobian.col(j).norm()),
                     penalty.names()[static_cast<std::size_t>(j)]);
        }
      }
    }
  }
}

CHECK_CASE("load friction: search, refit and parts find it, whatever the threads") {
  for (const bool by_link : {false, true}) {
    for (const auto residual : {Residual::torque, Residual::sensor}) {
      const auto penalty = penalty_for(by_link, residual);
      base::Pool one(1);
      base::Pool three(3);
      const auto found = identify::minimise_separable(penalty, domain(), one);
      CHECK((found.best.array() ==
             identify::minimise_separable(penalty, domain(), three).best.array())
                .all());
      CHECK_CLOSE(found.best[5], 0.2, 2e-3);
      CHECK_CLOSE(found.best[1], 25.0, 0.2);
      CHECK_CLOSE(found.best[3], 1.4, 0.01);
      const auto recording = loaded(0.2, by_link);
      const Penalty::Masked masked{std::make_shared<const identify::MaskedRecording>(
          recording, identify::usable_intervals(recording, true))};
      identify::WindowOptions windows;
      windows.duration = 0.01;
      const identify::PenaltyParts parts(masked, terms_for(by_link), windows, residual, 1.0, {});
      const Eigen::VectorXd again = identify::refit(parts, domain(), found.best, nullptr);
      CHECK((again - found.best).norm() < 1e-4);
    }
  }
}

CHECK_CASE("load friction: without a sensor the share of the inertia behind the gear is found") {
  auto r = moving(4001, 1e-3, false, 5);
  Truth truth;
  truth.static_excess = 0.0;
  add_torque(r, truth, false);
  for (Eigen::Index k = 0; k + 1 < r.samples(); ++k) {
    const double v = r.velocity[k] + r.velocity[k + 1];
    const double weight = 15.0 * (std::cos(r.position[k]) + std::cos(r.position[k + 1]));
    const double speeding = (r.velocity[k + 1] - r.velocity[k]) / (r.time[k + 1] - r.time[k]);
    const double link = 0.4 * truth.inertia * speeding + weight;
    r.torque[k] =
        identify::loaded_by_link(r.torque[k] + weight, link, v < 0.0 ? -1.0 : 1.0, 0.2).value;
  }
  identify::WindowOptions windows;
  windows.duration = 0.01;
  const Penalty penalty(
      {r}, {"inertia", "coulomb", "viscous", "load_friction_link", "gravity_cos", "gravity_sin"},
      windows, Residual::torque, true);
  search::Domain box;
  box.lower = Eigen::VectorXd::Zero(7);
  box.upper = Eigen::VectorXd::Constant(7, 100.0);
  box.lower.segment(3, 2).setConstant(-100.0);
  box.upper.tail(2) << 0.95, 1.0;
  base::Pool pool(1);
  const auto best = identify::minimise_separable(penalty, box, pool).best;
  CHECK_CLOSE(best[5], 0.2, 5e-3);
  CHECK_CLOSE(best[6], 0.4, 2e-2);
  CHECK_CLOSE(best[3], 30.0, 0.1);
  Eigen::VectorXd at;
  Eigen::VectorXd above;
  Eigen::MatrixXd jacobian;
  Eigen::VectorXd theta = best;
  theta[6] = 0.3;
  penalty.residuals(theta, at, &jacobian);
  theta[6] += 1e-6;
  penalty.residuals(theta, above, nullptr);
  CHECK(((above - at) / 1e-6 - jacobian.col(6)).norm() < 1e-3 * jacobian.col(6).norm());
}

CHECK_CASE("load friction: refused without a link torque") {
  identify::WindowOptions windows;
  windows.duration = 0.01;
  CHECK_REFUSED(Penalty({loaded(0.2, false)}, {"inertia", "coulomb", "load_friction_link"}, windows,
                        Residual::torque, true),
                "no torque behind the gear");
}

}  // namespace load_friction
}  // namespace jointid::tests
