#include "design/information.hpp"

#include <cmath>

#include "base/elementary.hpp"
#include "base/require.hpp"
#include "model/dry_friction.hpp"

namespace jointid::design {

namespace {

/// Rate of change of the friction that varies with the speed [N·m/s].
double varying_rate(const model::Joint& joint, double velocity, double acceleration) {
  const double speed = std::fabs(velocity);
  if (speed == 0.0) return 0.0;
  double sum = 0.0;
  for (const auto& term : joint.friction) {
    if (term.basis == model::SpeedBasis::linear)
      continue;  // columns that are integrated without an error
    const double coefficient = velocity > 0.0 ? term.positive : term.negative;
    sum += coefficient * model::basis_rate(term.basis, speed, term.shapes.data());
  }
  return sum * acceleration;
}

/// Adds the windows of one run.
class Windows {
 public:
  Windows(const simulate::Signals& signals, const std::vector<Column>& columns, const Noise& noise,
          const model::Joint& joint, double inertia, double viscous, double period)
      : signals_(signals),
        columns_(columns),
        joint_(joint),
        period_(period),
        torque_(noise.torque * noise.torque * period * period),
        ends_(2.0 * (inertia * inertia * noise.velocity * noise.velocity +
                     viscous * viscous * noise.position * noise.position)),
        reversal_(noise.reversal * noise.reversal),
        quadrature_(noise.sampled * noise.sampled / 12.0),
        row_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(columns.size()))),
        misled_(Eigen::VectorXd::Zero(row_.size())),
        sum_(Eigen::MatrixXd::Zero(row_.size(), row_.size())) {
    rates(signals, columns, rates_);
  }

  /// The window from sample `first` to sample `last`.
  void add(std::size_t first, std::size_t last) {
    if (last <= first) return;
    const auto begin = static_cast<Eigen::Index>(first);
    const auto end = static_cast<Eigen::Index>(last);
    for (Eigen::Index c = 0; c < row_.size(); ++c) {
      const Column& column = columns_[static_cast<std::size_t>(c)];
      if (by_ends(column)) {
        row_[c] = step(column, signals_, first, last);
        continue;
      }
      // The trapezoidal rule over the samples.
      const double* rate = rates_.col(c).data();
      double sum = 0.5 * (rate[begin] + rate[end]);
      for (Eigen::Index k = begin + 1; k < end; ++k) sum += rate[k];
      row_[c] = sum * period_;
    }
    const auto count = static_cast<double>(last - first);
    const double variance = torque_ * count + ends_ + (reverses(first, last) ? reversal_ : 0.0);
    sum_.selfadjointView<Eigen::Lower>().rankUpdate(row_, 1.0 / variance);
    if (quadrature_ > 0.0) {  // the rule's first error term, by Euler and Maclaurin
      misled_ += row_ * (-quadrature_ * (rate(last) - rate(first)) / variance);
    }
  }
  [[nodiscard]] Told total() const { return {sum_.selfadjointView<Eigen::Lower>(), misled_}; }

 private:
  [[nodiscard]] bool reverses(std::size_t first, std::size_t last) const {
    const auto& velocity = signals_.true_velocity;
    for (std::size_t k = first; k < last; ++k) {
      if (velocity[k] * velocity[k + 1] <= 0.0) return true;
    }
    return false;
  }

  /// Friction acts against the motion, and so does its change: the rule's error has the sign of
  /// the velocity twice.
  [[nodiscard]] double rate(std::size_t k) const {
    return varying_rate(joint_, signals_.true_velocity[k], signals_.true_acceleration[k]);
  }

  const simulate::Signals& signals_;
  const std::vector<Column>& columns_;
  const model::Joint& joint_;
  double period_;
  double torque_;
  double ends_;
  double reversal_;
  double quadrature_;
  Eigen::VectorXd row_;
  Eigen::MatrixXd rates_;
  Eigen::VectorXd misled_;
  Eigen::MatrixXd sum_;
};

}  // namespace

void Noise::validate() const {
  const base::Requirement require("BalanceNoise");
  require.above_zero("torque", torque);
  require.at_least_zero("position", position);
  require.at_least_zero("velocity", velocity);
  require.at_least_zero("slowest", slowest);
  require.at_least_zero("reversal", reversal);
  require.at_least_zero("sampled", sampled);
}

Told information(const simulate::Signals& signals, const std::vector<Column>& columns,
                 const Noise& noise, const model::Joint& joint, double inertia, double viscous,
                 double period, int samples) {
  Windows windows(signals, columns, noise, joint, inertia, viscous, period);
  const std::size_t count = signals.true_velocity.size();
  const auto length = static_cast<std::size_t>(samples);
  std::size_t first = 0;
  bool open = false;
  for (std::size_t k = 0; k < count; ++k) {
    if (std::fabs(signals.true_velocity[k]) < noise.slowest) {
      if (open) windows.add(first, k - 1);
      open = false;
    } else if (!open) {
      first = k;
      open = true;
    } else if (k - first == length) {
      windows.add(first, k);
      first = k;
    }
  }
  if (open) windows.add(first, count - 1);
  return windows.total();
}

}  // namespace jointid::design
