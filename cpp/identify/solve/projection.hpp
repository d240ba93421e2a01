#pragma once
// The direct penalty as a function of the shapes alone (Golub and Pereyra 1973).
//
// The columns that no shape changes and the target are made orthonormal once. A shape then costs
// the integral of its own columns and their products with that basis; the coefficients follow from
// a system of a dozen rows, under their bounds.

#include <Eigen/Core>
#include <array>
#include <vector>

#include "base/cancel.hpp"
#include "identify/penalty/penalty.hpp"
#include "search/domain.hpp"

namespace jointid::identify {

/// The penalty at some shapes with the best coefficients beside them.
struct ProjectedPoint {
  Eigen::VectorXd theta;  ///< all parameters
  double value = 0.0;
  Eigen::VectorXd gradient;   ///< by each free shape
  Eigen::MatrixXd curvature;  ///< Kaufman's (1975): of the residuals made linear in all parameters
};

class Projection {
 public:
  /// Over some windows of a penalty, in rising order; none: over all. It keeps references to the
  /// penalty and the domain. Only where the balance is linear and windows are not running sums.
  Projection(const Penalty& penalty, const search::Domain& domain,
             const std::vector<Eigen::Index>& windows, const base::Cancel& cancel);

  /// Nodes that an evaluation sums over.
  [[nodiscard]] std::size_t nodes() const;
  [[nodiscard]] Eigen::Index windows() const { return basis_.rows(); }
  /// Free shapes, among all parameters.
  [[nodiscard]] const std::vector<Eigen::Index>& free() const { return free_; }
  /// For given values of the free shapes.
  [[nodiscard]] double value(const Eigen::VectorXd& shapes) const;
  /// The same with derivatives.
  [[nodiscard]] ProjectedPoint at(const Eigen::VectorXd& shapes) const;

 private:
  /// What the coefficients are solved from, in the basis and one more direction a shaped column.
  struct Frame {
    Eigen::MatrixXd columns;
    std::vector<Eigen::MatrixXd> slopes;  ///< of each shaped column, by its shapes
    std::vector<Eigen::MatrixXd> beyond;  ///< what of them is left beside the frame, by window
  };
  Eigen::VectorXd append(Eigen::VectorXd column);
  [[nodiscard]] const FrictionNodes& nodes_of(const Penalty::Shaped& shaped) const;
  [[nodiscard]] Eigen::VectorXd full(const Eigen::VectorXd& shapes) const;
  [[nodiscard]] Frame frame(const Eigen::VectorXd& theta, bool slopes) const;
  /// Fills in the best coefficients; the residual in the frame.
  Eigen::VectorXd solve(const Frame& frame, Eigen::VectorXd& theta) const;

  const Penalty& penalty_;
  const search::Domain& domain_;
  const base::Cancel& cancel_;
  std::vector<Eigen::Index> free_;
  std::array<FrictionNodes, 3> chosen_;  ///< of the windows, by model::Direction; if not of all
  bool all_;
  Eigen::Index count_ = 0;  ///< of the basis
  Eigen::MatrixXd basis_;   ///< windows x (constant columns, target)
  Eigen::MatrixXd constant_;
  Eigen::VectorXd target_;
};

}  // namespace jointid::identify
