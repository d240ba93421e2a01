#pragma once
// Several smooth functions of one or two shapes, as polynomials over pieces of the range: their
// values at any shape cost the same few dozen operations.

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "identify/compressed/shape_axis.hpp"

namespace jointid::identify {

/// Values of functions at the product of Chebyshev points of the axes' whole ranges: functions x
/// points. A second axis may have another number of points at each point of the first.
struct Samples {
  std::vector<Eigen::MatrixXd> values;  ///< one matrix a point of the first axis of two, else one
};

/// cos(pi (k + 1/2) / count): Chebyshev points in [-1, 1].
Eigen::VectorXd chebyshev_points(Eigen::Index count);
/// Coefficients (functions x count) of the series through values at Chebyshev points.
Eigen::MatrixXd chebyshev_coefficients(const Eigen::MatrixXd& values);

class ShapeTable {
 public:
  static constexpr int kLanes = 4;  ///< functions are padded to a multiple of this

  ShapeTable() = default;
  /// One polynomial of `degree` in each shape over each piece.
  ShapeTable(std::vector<ShapeAxis> axes, const Samples& samples, int degree);

  [[nodiscard]] Eigen::Index functions() const { return functions_; }
  /// Functions with padding: what values() and slopes() write.
  [[nodiscard]] std::size_t width() const { return width_; }
  [[nodiscard]] const std::vector<ShapeAxis>& axes() const { return axes_; }

  /// All functions at the shapes, which must lie in the axes' ranges.
  void values(const double* shapes, double* result) const;
  /// Their derivatives by shape number `which`.
  void slopes(const double* shapes, int which, double* result) const;

 private:
  void build_line(const Eigen::MatrixXd& values);
  void build_plane(const Samples& samples);
  [[nodiscard]] const double* row(std::int64_t piece) const {
    return rows_.data() + static_cast<std::size_t>(piece) * terms_ * width_;
  }

  std::vector<ShapeAxis> axes_;
  Eigen::Index functions_ = 0;
  std::size_t width_ = 0;
  std::size_t order_ = 0;     ///< coefficients in one shape: degree + 1
  std::size_t terms_ = 0;     ///< coefficients of a piece: order, or its square
  std::vector<double> rows_;  ///< piece, power of the first shape, of the second, function
};

}  // namespace jointid::identify
