#pragma once
// The penalty at a cost that does not depend on the length of the recording.
//
// P = |R [-c; 1] - sum s_i p_i(shape)|^2 + s' G(shape) s: with the constant columns orthogonalised
// once, only the projections p_i of the shaped columns and the inner products G of what remains of
// them depend on the shape. They are smooth, so a table of polynomials gives them. A sum of squares
// plus a remainder that is kept from falling below zero: never negative.

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
  /// One pass over the samples for each of some dozens of shapes within the domain, over the pool's
  /// threads. Where the table cannot meet the tolerance the penalty is not `exact`: use the direct
  /// sum, for the `reason` given.
  CompressedPenalty(const Penalty& penalty, const search::Domain& domain, base::Pool& pool);
  /// From the digest of the nodes' rates; without nodes, for a penalty without shapes. `frame`
  /// gives the terms, its windows do not matter.
  CompressedPenalty(const Penalty& frame, const std::optional<ShapeNodes>& nodes,
                    const Digest& whole);

  [[nodiscard]] bool exact() const { return exact_; }
  [[nodiscard]] const std::string& reason() const { return reason_; }
  /// Shapes at which the samples were summed.
  [[nodiscard]] Eigen::Index passes() const { return passes_; }
  /// The largest error found between the nodes, of the shaped columns' squared size.
  [[nodiscard]] double error() const { return error_; }

  [[nodiscard]] const std::vector<std::string>& names() const override { return names_; }
  [[nodiscard]] Eigen::Index coefficients() const override { return coefficients_; }
  [[nodiscard]] Residual residual() const override { return residual_; }
  [[nodiscard]] Eigen::Index gain_index() const override { return gain_index_; }
  [[nodiscard]] bool is_cheap() const override { return true; }
  [[nodiscard]] const Eigen::VectorXd& target() const override { return target_; }

  /// As few rows as there are coefficients and a target; equal to the direct ones in every inner
  /// product.
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
  /// Settles whether the functions found at some shapes are near enough to those expected there,
  /// functions x shapes. `scale`: the shaped columns' squared size.
  void compare(const Eigen::MatrixXd& found, const Eigen::MatrixXd& expected, double scale);
  void assemble(const std::optional<ShapeNodes>& nodes, const Digest& whole);
  [[nodiscard]] bool has_too_many_terms() const;
  /// Refuses what could not be compressed.
  void require_made() const;
  void require_inside(double shape) const;
  /// Shaped columns, rows x shaped.
  [[nodiscard]] Eigen::MatrixXd shaped_columns(double shape) const;
  /// Their derivatives by the shape.
  [[nodiscard]] Eigen::MatrixXd shaped_slopes(double shape) const;

  std::vector<std::string> names_;
  Eigen::Index coefficients_;
  Residual residual_;
  Eigen::Index gain_index_;
  std::vector<Eigen::Index> shaped_;    ///< coefficients
  std::vector<Eigen::Index> constant_;  ///< coefficients
  Eigen::Index rows_ = 0;               ///< of the triangle
  Eigen::MatrixXd triangle_;            ///< padded rows x (constant columns, target)
  Eigen::VectorXd target_;
  std::optional<ShapeTable> table_;  ///< of the first shape
  bool exact_ = false;
  std::string reason_;
  Eigen::Index passes_ = 0;
  double error_ = 0.0;
};

}  // namespace jointid::identify
