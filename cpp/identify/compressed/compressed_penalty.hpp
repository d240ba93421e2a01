#pragma once
// The penalty at a cost that does not depend on the length of the recording.
//
// P = |R [-c; 1] - sum s_i p_i(shape)|^2 + s' G(shape) s. The constant columns are orthogonalised
// once. Then only the projections p_i of the shaped columns and the inner products G of their
// remainders depend on the shape. These functions are smooth, so a table of polynomials gives them.
// The penalty is a sum of squares plus a remainder that is kept from falling below zero, so it is
// never negative.

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "identify/compressed/compression.hpp"
#include "identify/compressed/shape_table.hpp"
#include "identify/penalty/penalty.hpp"
#include "search/domain.hpp"

namespace jointid::identify {

class CompressedPenalty final : public PenaltyFunction {
 public:
  /// One pass over the samples for each of some dozens of shapes within the domain, on the pool's
  /// threads. If the table cannot meet the tolerance, the penalty is not `exact`, and `reason` says
  /// why. Use the direct sum then.
  CompressedPenalty(const Penalty& penalty, const search::Domain& domain, base::Pool& pool);
  /// From the digest of the nodes' rates; without nodes for a penalty without shapes. `frame` gives
  /// only the terms, not the windows.
  CompressedPenalty(const Penalty& frame, const std::optional<ShapeNodes>& nodes,
                    const Digest& whole);

  [[nodiscard]] bool exact() const { return exact_; }
  [[nodiscard]] const std::string& reason() const { return reason_; }
  /// Number of shapes at which the samples were summed.
  [[nodiscard]] Eigen::Index passes() const { return passes_; }
  /// The largest error found between the nodes, as a share of the shaped columns' squared norm.
  [[nodiscard]] double error() const { return error_; }

  [[nodiscard]] const std::vector<std::string>& names() const override { return names_; }
  [[nodiscard]] Eigen::Index coefficients() const override { return coefficients_; }
  [[nodiscard]] Residual residual() const override { return residual_; }
  [[nodiscard]] Eigen::Index gain_index() const override { return gain_index_; }
  [[nodiscard]] bool is_cheap() const override { return true; }
  [[nodiscard]] const Eigen::VectorXd& target() const override { return target_; }

  /// Only one row per coefficient and one for the target. Every inner product equals that of the
  /// direct columns.
  void columns(const Eigen::VectorXd& shapes, Eigen::MatrixXd& result,
               const base::Cancel* cancel = nullptr) const override;
  double operator()(const Eigen::VectorXd& theta,
                    const base::Cancel* cancel = nullptr) const override;
  void residuals(const Eigen::VectorXd& theta, Eigen::VectorXd& residual, Eigen::MatrixXd* jacobian,
                 const base::Cancel* cancel = nullptr) const override;
  void evaluate(const Eigen::MatrixXd& candidates, Eigen::VectorXd& penalties,
                base::Pool& pool) const override;

 private:
  explicit CompressedPenalty(const Penalty& frame);
  void build(const Penalty& penalty, const search::Domain& domain, base::Pool& pool);
  void take_triangle(const Eigen::MatrixXd& triangle);
  /// Decides whether the functions computed at some shapes are near enough to the expected ones
  /// (functions x shapes). `scale`: the shaped columns' squared norm.
  void compare(const Eigen::MatrixXd& found, const Eigen::MatrixXd& expected, double scale);
  void assemble(const std::optional<ShapeNodes>& nodes, const Digest& whole);
  [[nodiscard]] bool has_too_many_terms() const;
  /// Refuses a penalty that cannot be compressed.
  void require_made() const;
  void require_inside(double shape) const;
  /// Shaped columns, rows x shaped.
  [[nodiscard]] Eigen::MatrixXd shaped_columns(double shape) const;
  /// Derivatives of the shaped columns by the shape.
  [[nodiscard]] Eigen::MatrixXd shaped_slopes(double shape) const;

  std::vector<std::string> names_;
  Eigen::Index coefficients_;
  Residual residual_;
  Eigen::Index gain_index_;
  std::vector<Eigen::Index> shaped_;    ///< indices among the coefficients
  std::vector<Eigen::Index> constant_;  ///< indices among the coefficients
  Eigen::Index rows_ = 0;               ///< rows of the triangle
  Eigen::MatrixXd triangle_;            ///< padded rows x (constant columns, target)
  Eigen::VectorXd target_;
  std::optional<ShapeTable> table_;  ///< index of the first shape
  bool exact_ = false;
  std::string reason_;
  Eigen::Index passes_ = 0;
  double error_ = 0.0;
};

}  // namespace jointid::identify
