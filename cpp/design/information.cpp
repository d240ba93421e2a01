#include "design/information.hpp"

#include <cmath>

#include "base/require.hpp"

namespace jointid::design {

namespace {

/// Adds the windows of one run.
class Windows {
 public:
  Windows(const simulate::Signals& signals, const std::vector<Column>& columns, const Noise& noise,
          double inertia, double viscous, double period)
      : signals_(signals),
        columns_(columns),
        period_(period),
        torque_(noise.torque * noise.torque * period * period),
        ends_(2.0 * (inertia * inertia * noise.velocity * noise.velocity +
                     viscous * viscous * noise.position * noise.position)),
        reversal_(noise.reversal * noise.reversal),
        row_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(columns.size()))),
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
  }
  [[nodiscard]] Eigen::MatrixXd total() const { return sum_.selfadjointView<Eigen::Lower>(); }

 private:
  [[nodiscard]] bool reverses(std::size_t first, std::size_t last) const {
    const auto& velocity = signals_.true_velocity;
    for (std::size_t k = first; k < last; ++k) {
      if (velocity[k] * velocity[k + 1] <= 0.0) return true;
    }
    return false;
  }

  const simulate::Signals& signals_;
  const std::vector<Column>& columns_;
  double period_;
  double torque_;
  double ends_;
  double reversal_;
  Eigen::VectorXd row_;
  Eigen::MatrixXd rates_;
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
}

Eigen::MatrixXd information(const simulate::Signals& signals, const std::vector<Column>& columns,
                            const Noise& noise, double inertia, double viscous, double period,
                            int samples) {
  Windows windows(signals, columns, noise, inertia, viscous, period);
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
