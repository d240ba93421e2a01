#pragma once
// The direct penalty as a function of only the shapes (Golub and Pereyra 1973).
//
// The constant columns and the target are made orthonormal once. Each shape then costs the integral
// of its own columns and their products with that basis. The coefficients follow from a system of a
// dozen rows, under their bounds.

#include <Eigen/Core>
#include <array>
#include <vector>

#include "base/cancel.hpp"
#include "identify/penalty/penalty.hpp"
#include "search/domain.hpp"

namespace jointid::identify {

/// The penalty at some shapes with the best coefficients.
struct ProjectedPoint {
  Eigen::VectorXd theta;  ///< all parameters
  double value = 0.0;
  Eigen::VectorXd gradient;   ///< by each free shape
  Eigen::MatrixXd curvature;  ///< Kaufman's (1975): of the residuals linearised in all parameters
};

class Projection {
 public:
  /// Over some windows of a penalty in rising order; none: over all. It keeps references to the
  /// penalty and the domain. The balance must be linear, and windows must not be running sums.
  Projection(const Penalty& penalty, const search::Domain& domain,
             const std::vector<Eigen::Index>& windows, const base::Cancel& cancel);

  /// Number of nodes that an evaluation sums over.
  [[nodiscard]] std::size_t nodes() const;
  [[nodiscard]] Eigen::Index windows() const { return basis_.rows(); }
  /// Indices of the free shapes among all parameters.
  [[nodiscard]] const std::vector<Eigen::Index>& free() const { return free_; }
  /// The penalty for these values of the free shapes.
  [[nodiscard]] double value(const Eigen::VectorXd& shapes) const;
  /// The same with derivatives.
  [[nodiscard]] ProjectedPoint at(const Eigen::VectorXd& shapes) const;

 private:
  /// The system for the coefficients, in the basis and one more direction per shaped column.
  struct Frame {
    Eigen::MatrixXd columns;
    std::vector<Eigen::MatrixXd> slopes;  ///< derivatives of each shaped column by its shapes
    std::vector<Eigen::MatrixXd> beyond;  ///< their remainder outside the frame, by windows
  };
  Eigen::VectorXd append(Eigen::VectorXd column);
  [[nodiscard]] const FrictionNodes& nodes_of(const Penalty::Shaped& shaped) const;
  [[nodiscard]] Eigen::VectorXd full(const Eigen::VectorXd& shapes) const;
  [[nodiscard]] Frame frame(const Eigen::VectorXd& theta, bool slopes) const;
  /// Sets the best coefficients and returns the residual in the frame.
  Eigen::VectorXd solve(const Frame& frame, Eigen::VectorXd& theta) const;

  const Penalty& penalty_;
  const search::Domain& domain_;
  const base::Cancel& cancel_;
  std::vector<Eigen::Index> free_;
  std::array<FrictionNodes, 3>
      chosen_;  ///< nodes of the windows, by model::Direction; empty if all windows are used
  bool all_;
  Eigen::Index count_ = 0;  ///< number of columns of the basis
  Eigen::MatrixXd basis_;   ///< windows x (constant columns, target)
  Eigen::MatrixXd constant_;
  Eigen::VectorXd target_;
};

}  // namespace jointid::identify
