#include <array>
#include <cmath>

#include "base/input_error.hpp"
#include "identify/balance/load_friction.hpp"
#include "identify/penalty/penalty.hpp"

// The part of the penalty for load friction, which acts on the sum of all terms.

namespace jointid::identify {

void Penalty::weigh_link() {
  link_weights_.setZero(coefficients());
  for (Eigen::Index j = 0; j < coefficients(); ++j) {
    const auto& term = terms_[static_cast<std::size_t>(j)];
    if (term.option == "sensor" || (term.option == "gravity" && gain_index_ < 0)) {
      link_weights_[j] = 1.0;
    }
  }
  if (link_load_ && load_ >= 0 && !(link_weights_.cwiseAbs().maxCoeff() > 0.0)) {
    throw base::InputError(
        "there is no torque behind the gear that friction could depend on: neither a sensor nor "
        "gravity",
        "load_friction", "link");
  }
}

void Penalty::plain_columns(const double* shapes, bool backward, const base::Cancel* cancel,
                            Eigen::MatrixXd& result) const {
  result = backward ? backward_ : columns_;
  for (const auto& s : shaped_) {
    const auto& nodes =
        (backward ? backward_nodes_ : nodes_)[static_cast<std::size_t>(s.term.direction)];
    std::array<double, 4> own{};
    for (std::size_t i = 0; i < s.shapes.size(); ++i) own[i] = shapes[s.shapes[i]];
    integrate_friction(s.term, nodes, own.data(), cancel, result.col(s.coefficient));
  }
}

Eigen::VectorXd Penalty::Loaded::slope(const Eigen::VectorXd& every, const Eigen::VectorXd& part,
                                       double weight) const {
  const auto forward = (gain.col(0) + weight * gain.col(1)).cwiseProduct(every - part);
  return forward + (gain.col(2) + weight * gain.col(3)).cwiseProduct(part);
}

Penalty::Loaded Penalty::loaded(const double* shapes, const Eigen::VectorXd& coefficients,
                                const base::Cancel* cancel) const {
  Loaded result;
  plain_columns(shapes, false, cancel, result.all);
  plain_columns(shapes, true, cancel, result.back);
  const double load = shapes[load_];
  const Eigen::VectorXd whole = result.all * coefficients;
  const Eigen::VectorXd behind = result.back * coefficients;
  result.weights = link_weights_;
  Eigen::VectorXd inertia = Eigen::VectorXd::Zero(coefficients.size());
  for (Eigen::Index j = 0; j < coefficients.size() && share_ >= 0; ++j) {
    if (terms_[static_cast<std::size_t>(j)].integral != Integral::velocity_change) continue;
    inertia[j] = coefficients[j];
    result.weights[j] = shapes[share_];
  }
  const Eigen::VectorXd linked = coefficients.cwiseProduct(result.weights);
  const Eigen::VectorXd link = result.all * linked;
  const Eigen::VectorXd link_behind = result.back * linked;
  const auto of = [&](double torque, double link_torque, double direction) {
    return link_load_ ? loaded_by_link(torque, link_torque, direction, load)
                      : loaded_by_drive(torque, direction, load);
  };
  result.torque.resize(whole.size());
  result.by_load.resize(whole.size());
  result.gain.resize(whole.size(), 4);
  for (Eigen::Index row = 0; row < whole.size(); ++row) {
    const auto forward = of(whole[row] - behind[row], link[row] - link_behind[row], 1.0);
    const auto backward = of(behind[row], link_behind[row], -1.0);
    result.torque[row] = forward.value + backward.value;
    result.by_load[row] = forward.by_coefficient + backward.by_coefficient;
    result.gain.row(row) << forward.by_torque, forward.by_link, backward.by_torque,
        backward.by_link;
  }
  if (share_ >= 0) {
    const Eigen::VectorXd behind_gear = result.back * inertia;
    result.by_share = result.gain.col(1).cwiseProduct(result.all * inertia - behind_gear) +
                      result.gain.col(3).cwiseProduct(behind_gear);
  }
  return result;
}

void Penalty::linear_columns(const Eigen::VectorXd& shapes, const Eigen::VectorXd& about,
                             Eigen::MatrixXd& result, const base::Cancel* cancel) const {
  if (load_ < 0) {
    columns(shapes, result, cancel);
    return;
  }
  // Homogeneous of degree 1 in the coefficients, so the slopes are the columns.
  const Loaded balance = loaded(shapes.data(), about.head(coefficients()), cancel);
  result.resize(window_count(), coefficients());
  for (Eigen::Index j = 0; j < result.cols(); ++j) {
    result.col(j) = balance.slope(balance.all.col(j), balance.back.col(j), balance.weights[j]);
    if (cumulative_) accumulate(result.col(j));
  }
}

void Penalty::loaded_residuals(const Eigen::VectorXd& theta, Eigen::VectorXd& residual,
                               Eigen::MatrixXd* jacobian, const base::Cancel* cancel) const {
  const Eigen::Index p = coefficients();
  const double* shapes = theta.data() + p;
  Loaded balance = loaded(shapes, theta.head(p), cancel);
  if (cumulative_) accumulate(balance.torque);
  residual = target_ - balance.torque;
  if (jacobian == nullptr) return;
  jacobian->setZero(window_count(), parameters());
  for (Eigen::Index j = 0; j < p; ++j) {
    jacobian->col(j) = -balance.slope(balance.all.col(j), balance.back.col(j), balance.weights[j]);
  }
  jacobian->col(p + load_) = -balance.by_load;
  if (share_ >= 0) jacobian->col(p + share_) = -balance.by_share;
  for (const auto& s : shaped_) {
    std::array<double, 4> own{};
    for (std::size_t i = 0; i < s.shapes.size(); ++i) own[i] = shapes[s.shapes[i]];
    const auto direction = static_cast<std::size_t>(s.term.direction);
    Eigen::MatrixXd every(window_count(), static_cast<Eigen::Index>(s.shapes.size()) + 1);
    Eigen::MatrixXd part(every.rows(), every.cols());
    integrate_slopes(s.term, nodes_[direction], own.data(), cancel, every);
    integrate_slopes(s.term, backward_nodes_[direction], own.data(), cancel, part);
    for (std::size_t i = 0; i < s.shapes.size(); ++i) {
      const auto column = static_cast<Eigen::Index>(i) + 1;
      jacobian->col(p + s.shapes[i]) -=
          theta[s.coefficient] * balance.slope(every.col(column), part.col(column), 0.0);
    }
  }
  if (cumulative_) {
    for (Eigen::Index j = 0; j < jacobian->cols(); ++j) accumulate(jacobian->col(j));
  }
}

}  // namespace jointid::identify
