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
        row_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(columns.size()))),
        rates_(row_),
        sum_(Eigen::MatrixXd::Zero(row_.size(), row_.size())) {}

  void begin(std::size_t k) {
    first_ = k;
    rates(signals_, columns_, k, rates_.data());
    row_ = 0.5 * rates_;
  }
  void go_on(std::size_t k) {
    rates(signals_, columns_, k, rates_.data());
    row_ += rates_;
  }
  /// `last` is the sample that went on last.
  void end(std::size_t last) {
    if (last <= first_) return;
    // The trapezoidal rule over the samples.
    row_ -= 0.5 * rates_;
    row_ *= period_;
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      if (by_ends(columns_[c])) {
        row_[static_cast<Eigen::Index>(c)] = step(columns_[c], signals_, first_, last);
      }
    }
    const auto count = static_cast<double>(last - first_);
    sum_.selfadjointView<Eigen::Lower>().rankUpdate(row_, 1.0 / (torque_ * count + ends_));
  }
  [[nodiscard]] std::size_t first() const { return first_; }
  [[nodiscard]] Eigen::MatrixXd total() const { return sum_.selfadjointView<Eigen::Lower>(); }

 private:
  const simulate::Signals& signals_;
  const std::vector<Column>& columns_;
  double period_;
  double torque_;
  double ends_;
  std::size_t first_ = 0;
  Eigen::VectorXd row_;
  Eigen::VectorXd rates_;
  Eigen::MatrixXd sum_;
};

}  // namespace

void Noise::validate() const {
  const base::Requirement require("BalanceNoise");
  require.above_zero("torque", torque);
  require.at_least_zero("position", position);
  require.at_least_zero("velocity", velocity);
  require.at_least_zero("slowest", slowest);
}

Eigen::MatrixXd information(const simulate::Signals& signals, const std::vector<Column>& columns,
                            const Noise& noise, double inertia, double viscous, double period,
                            int samples) {
  Windows windows(signals, columns, noise, inertia, viscous, period);
  const std::size_t count = signals.true_velocity.size();
  const auto length = static_cast<std::size_t>(samples);
  bool open = false;
  for (std::size_t k = 0; k < count; ++k) {
    if (std::fabs(signals.true_velocity[k]) < noise.slowest) {
      if (open) windows.end(k - 1);
      open = false;
    } else if (!open) {
      windows.begin(k);
      open = true;
    } else {
      windows.go_on(k);
      if (k - windows.first() == length) {
        windows.end(k);
        windows.begin(k);
      }
    }
  }
  if (open) windows.end(count - 1);
  return windows.total();
}

}  // namespace jointid::design
