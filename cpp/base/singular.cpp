#include "base/singular.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace jointid::base {

namespace {

constexpr double kOrthogonal = 2.2e-16;  // remaining cosine of two columns, per row
constexpr int kSweeps = 60;              // a dozen suffice

void turn(Eigen::MatrixXd& matrix, Eigen::Index one, Eigen::Index other, double cosine,
          double sine) {
  double* a = matrix.col(one).data();
  double* b = matrix.col(other).data();
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
    const double before = a[row];
    a[row] = cosine * before - sine * b[row];
    b[row] = sine * before + cosine * b[row];
  }
}

}  // namespace

Singular singular(Eigen::MatrixXd matrix) {
  const Eigen::Index count = matrix.cols();
  Eigen::MatrixXd turned = Eigen::MatrixXd::Identity(count, count);
  const double least = kOrthogonal * std::sqrt(static_cast<double>(matrix.rows()));
  bool any = true;
  for (int sweep = 0; any && sweep < kSweeps; ++sweep) {
    any = false;
    for (Eigen::Index i = 0; i < count; ++i) {
      for (Eigen::Index j = i + 1; j < count; ++j) {
        const double product = matrix.col(i).dot(matrix.col(j));
        const double first = matrix.col(i).squaredNorm();
        const double second = matrix.col(j).squaredNorm();
        if (!(std::fabs(product) > least * std::sqrt(first) * std::sqrt(second))) continue;
        any = true;
        const double half = (second - first) / (2.0 * product);
        const double tangent =
            std::copysign(1.0 / (std::fabs(half) + std::sqrt(1.0 + half * half)), half);
        const double cosine = 1.0 / std::sqrt(1.0 + tangent * tangent);
        turn(matrix, i, j, cosine, cosine * tangent);
        turn(turned, i, j, cosine, cosine * tangent);
      }
    }
  }
  Singular result{Eigen::VectorXd(count), Eigen::MatrixXd(count, count)};
  std::vector<double> sizes;
  for (Eigen::Index i = 0; i < count; ++i) sizes.push_back(matrix.col(i).norm());
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto largest = std::max_element(sizes.begin(), sizes.end());
    result.values[i] = *largest;
    result.directions.col(i) = turned.col(largest - sizes.begin());
    *largest = -1.0;  // taken
  }
  return result;
}

}  // namespace jointid::base
