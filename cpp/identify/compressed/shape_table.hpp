#pragma once
// Several smooth functions of a shape, as polynomials over pieces of its range. The values at any
// shape cost the same few dozen operations.

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "identify/compressed/shape_axis.hpp"

namespace jointid::identify {

/// cos(pi (k + 1/2) / count): Chebyshev points in [-1, 1].
Eigen::VectorXd chebyshev_points(Eigen::Index count);
/// Coefficients (functions x count) of the series through values at Chebyshev points.
Eigen::MatrixXd chebyshev_coefficients(const Eigen::MatrixXd& values);

class ShapeTable {
 public:
  static constexpr int kLanes = 4;  ///< functions are padded to a multiple of this

  /// A polynomial of `degree` over each piece, from values at Chebyshev points of the axis's whole
  /// range: functions x points.
  ShapeTable(const ShapeAxis& axis, const Eigen::MatrixXd& values, int degree);

  [[nodiscard]] Eigen::Index functions() const { return functions_; }
  /// Number of functions with padding, which values() and slopes() write.
  [[nodiscard]] std::size_t width() const { return width_; }
  [[nodiscard]] const ShapeAxis& axis() const { return axis_; }

  /// Values of all functions at a shape, which must lie in the axis's range.
  void values(double shape, double* result) const;
  /// Derivatives of all functions by the shape.
  void slopes(double shape, double* result) const;

 private:
  [[nodiscard]] const double* row(std::int64_t piece) const {
    return rows_.data() + static_cast<std::size_t>(piece) * order_ * width_;
  }

  ShapeAxis axis_;
  Eigen::Index functions_;
  std::size_t width_;
  std::size_t order_;         ///< coefficients per piece: degree + 1
  std::vector<double> rows_;  ///< by piece, power of the shape, function
};

}  // namespace jointid::identify
