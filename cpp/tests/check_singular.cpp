#include <cmath>

#include "base/singular.hpp"
#include "tests/check.hpp"

namespace jointid::tests {
namespace {

Eigen::MatrixXd uneven(Eigen::Index rows, Eigen::Index columns) {
  Eigen::MatrixXd matrix(rows, columns);
  for (Eigen::Index j = 0; j < columns; ++j) {
    for (Eigen::Index i = 0; i < rows; ++i) {
      const double place = static_cast<double>(1 + i + 3 * j);
      matrix(i, j) = std::sin(place * place) * std::pow(10.0, static_cast<double>(3 * j) - 6.0);
    }
  }
  return matrix;
}

CHECK_CASE("singular: values and directions give the products of the columns") {
  for (const Eigen::Index columns : {1, 2, 5}) {
    const auto matrix = uneven(7, columns);
    const auto found = base::singular(matrix);
    const Eigen::MatrixXd products =
        found.directions * found.values.cwiseAbs2().asDiagonal() * found.directions.transpose();
    const Eigen::VectorXd sizes = matrix.colwise().norm();
    const Eigen::MatrixXd apart = products - matrix.transpose() * matrix;
    for (Eigen::Index i = 0; i < columns; ++i) {
      // The error of a product is small compared with the product of the two columns' sizes.
      CHECK(std::fabs(apart(i, i)) < 1e-14 * sizes[i] * sizes.maxCoeff());
      if (i > 0) CHECK(found.values[i] <= found.values[i - 1]);
    }
    const Eigen::MatrixXd one = found.directions.transpose() * found.directions;
    CHECK((one - Eigen::MatrixXd::Identity(columns, columns)).norm() < 1e-14);
  }
}

CHECK_CASE("singular: a small value among large ones is known to full accuracy") {
  // Columns of very different size, 1e-9 from being parallel: the smallest value is that of their
  // difference.
  Eigen::MatrixXd matrix(2, 2);
  matrix << 1.0, 1e-6, 0.0, 1e-15;
  const auto found = base::singular(matrix);
  CHECK_CLOSE(found.values[1] / 1e-15, 1.0, 1e-9);
  CHECK_CLOSE(found.values[0], 1.0, 1e-9);
}

CHECK_CASE("singular: equal columns, zero columns, and more columns than rows") {
  Eigen::MatrixXd matrix = uneven(6, 4);
  matrix.col(1) = 2.0 * matrix.col(0);
  matrix.col(2).setZero();
  const auto found = base::singular(matrix);
  CHECK(found.values[1] > 0.0);
  CHECK(found.values[2] < 1e-15 * found.values[0]);
  CHECK(found.values[3] < 1e-15 * found.values[0]);
  const auto wide = base::singular(uneven(2, 3));
  CHECK(wide.values[1] > 0.0);
  CHECK(wide.values[2] < 1e-15 * wide.values[0]);
}

}  // namespace
}  // namespace jointid::tests
