#pragma once
// Interface of the penalty for a search. There is the direct sum over all samples, and the
// compressed form that represents the same sum by a few numbers.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "base/cancel.hpp"
#include "base/pool.hpp"

namespace jointid::identify {

enum class Residual {
  sensor,       ///< integral of the sensor reading: the torque residual over the sensor's gain (the
                ///< thesis)
  torque,       ///< integral of the commanded torque
  instruments,  ///< the same, with the part of the reading that the motion explains
};

/// P(theta) = |r|^2;  torque: r = target - sum_j c_j column_j(shapes);  sensor: that over
/// sensor_gain. Parameters are ordered as `names()`: coefficients, then shapes.
class PenaltyFunction {
 public:
  virtual ~PenaltyFunction() = default;

  [[nodiscard]] virtual const std::vector<std::string>& names() const = 0;
  [[nodiscard]] virtual Eigen::Index coefficients() const = 0;
  [[nodiscard]] virtual Residual residual() const = 0;
  /// Index of sensor_gain among the parameters, -1 without a sensor.
  [[nodiscard]] virtual Eigen::Index gain_index() const = 0;
  [[nodiscard]] Eigen::Index parameters() const {
    return static_cast<Eigen::Index>(names().size());
  }

  /// Whether an evaluation takes less time than waking another thread.
  [[nodiscard]] virtual bool is_cheap() const = 0;

  /// Columns of all coefficients for these shapes (rows x coefficients).
  virtual void columns(const Eigen::VectorXd& shapes, Eigen::MatrixXd& result,
                       const base::Cancel* cancel = nullptr) const = 0;
  [[nodiscard]] virtual const Eigen::VectorXd& target() const = 0;
  /// Whether, for given shapes, the residuals of the torque are linear in the coefficients.
  [[nodiscard]] virtual bool is_linear() const { return true; }
  /// Columns of the balance linearised about these coefficients; for a linear balance the same as
  /// `columns`.
  virtual void linear_columns(const Eigen::VectorXd& shapes, const Eigen::VectorXd& /*about*/,
                              Eigen::MatrixXd& result, const base::Cancel* cancel = nullptr) const {
    columns(shapes, result, cancel);
  }

  /// Throws std::invalid_argument if theta has the wrong length or the gain is zero.
  virtual double operator()(const Eigen::VectorXd& theta,
                            const base::Cancel* cancel = nullptr) const = 0;
  /// Residuals, and on request their derivatives (rows x parameters).
  virtual void residuals(const Eigen::VectorXd& theta, Eigen::VectorXd& residual,
                         Eigen::MatrixXd* jacobian, const base::Cancel* cancel = nullptr) const = 0;
  /// Penalties of candidates, one candidate per column.
  virtual void evaluate(const Eigen::MatrixXd& candidates, Eigen::VectorXd& penalties,
                        base::Pool& pool) const = 0;

 protected:
  PenaltyFunction() = default;
  PenaltyFunction(const PenaltyFunction&) = default;
  PenaltyFunction(PenaltyFunction&&) = default;
  PenaltyFunction& operator=(const PenaltyFunction&) = default;
  PenaltyFunction& operator=(PenaltyFunction&&) = default;

  /// Checks theta for operator() and residuals.
  void check(const Eigen::VectorXd& theta) const;
};

}  // namespace jointid::identify
