#pragma once
// The integral penalty [4-21 .. 4-24]: the sum of squared window residuals, summed directly over
// the samples. All coefficients are linear; only shape parameters cost a pass over the samples.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "base/pool.hpp"
#include "identify/quadrature.hpp"

namespace jointid::identify {

enum class Residual {
  sensor,  ///< integral of the sensor reading: the torque residual over the sensor's gain (the
           ///< thesis)
  torque,  ///< integral of the commanded torque
};

/// Penalty of a parameter vector over one or several recordings.
///
/// P(theta) = sum over windows of r^2;  torque: r = integral(tau) - sum_j c_j phi_j(shape); sensor:
/// that over sensor_gain. Parameters are ordered as `names()`: coefficients in the order given,
/// then shapes.
class Penalty {
 public:
  Penalty(std::vector<Recording> recordings, const std::vector<std::string>& terms,
          const WindowOptions& windows, Residual residual, bool mask_standstill);

  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  [[nodiscard]] Eigen::Index coefficients() const { return columns_.cols(); }
  [[nodiscard]] Eigen::Index parameters() const { return static_cast<Eigen::Index>(names_.size()); }
  [[nodiscard]] Eigen::Index window_count() const { return target_.size(); }
  [[nodiscard]] Residual residual() const { return residual_; }
  /// Position of sensor_gain among the parameters, -1 without a sensor.
  [[nodiscard]] Eigen::Index gain_index() const { return gain_index_; }

  /// Direct sum. Throws std::invalid_argument when theta has the wrong length or the gain is zero.
  [[nodiscard]] double operator()(const Eigen::VectorXd& theta,
                                  const base::Cancel* cancel = nullptr) const;
  /// Window residuals, and on request their derivatives (windows x parameters).
  void residuals(const Eigen::VectorXd& theta, Eigen::VectorXd& residual, Eigen::MatrixXd* jacobian,
                 const base::Cancel* cancel = nullptr) const;
  /// One candidate a column.
  void evaluate(const Eigen::MatrixXd& candidates, Eigen::VectorXd& penalties,
                base::Pool& pool) const;

  /// Columns of all terms for these shapes (windows x coefficients), and the integrals of the
  /// torque.
  void columns(const Eigen::VectorXd& shapes, Eigen::MatrixXd& result,
               const base::Cancel* cancel = nullptr) const;
  [[nodiscard]] const Eigen::VectorXd& target() const { return target_; }

  /// What was cut and why, one entry a window; sample numbers are within `recording_of`.
  [[nodiscard]] const std::vector<Window>& windows() const { return windows_; }
  [[nodiscard]] const std::vector<int>& recording_of() const { return recording_of_; }
  [[nodiscard]] const Eigen::VectorXd& usable_duration() const {
    return usable_duration_;
  }  ///< [s] a window
  [[nodiscard]] const WindowChoice& window_choice() const { return choice_; }
  [[nodiscard]] std::int64_t standing_samples() const { return standing_; }
  [[nodiscard]] std::int64_t unusable_intervals() const { return unusable_; }
  [[nodiscard]] std::int64_t total_samples() const { return total_; }

 private:
  struct Shaped {
    Eigen::Index coefficient;
    Eigen::Index shape;  ///< among the shapes
    model::SpeedBasis basis;
  };
  void check(const Eigen::VectorXd& theta) const;

  std::vector<std::string> names_;
  std::vector<Shaped> shaped_;
  Residual residual_;
  Eigen::Index gain_index_ = -1;
  Eigen::MatrixXd columns_;  ///< windows x coefficients; shaped ones stay zero here
  Eigen::VectorXd target_;
  FrictionNodes nodes_;
  std::vector<Window> windows_;
  std::vector<int> recording_of_;
  Eigen::VectorXd usable_duration_;
  WindowChoice choice_;
  std::int64_t standing_ = 0;
  std::int64_t unusable_ = 0;
  std::int64_t total_ = 0;
};

}  // namespace jointid::identify
