#include "base/gram.hpp"

#include <cstddef>

#include "base/clones.hpp"
#include "base/inner_product.hpp"

namespace jointid::base {

namespace {

/// products[j] of a column with `count` others, `stride` apart.
JOINTID_CLONES void multiply(const double* column, const double* others, std::size_t stride,
                             std::size_t count, std::size_t rows, double* products) {
  inner_products(column, others, stride, count, rows, products);
}

JOINTID_CLONES void subtract(const double* columns, std::size_t stride, const double* coefficients,
                             std::size_t count, std::size_t rows, double* __restrict rest) {
  std::size_t j = 0;
  for (; j + 4 <= count; j += 4) {  // together, so that the rest is read and written less often
    const double* one = columns + j * stride;
    const double* two = one + stride;
    const double* three = two + stride;
    const double* four = three + stride;
    const double* c = coefficients + j;
    const double c0 = c[0], c1 = c[1], c2 = c[2], c3 = c[3];
    for (std::size_t i = 0; i < rows; ++i) {
      rest[i] -= (c0 * one[i] + c1 * two[i]) + (c2 * three[i] + c3 * four[i]);
    }
  }
  for (; j < count; ++j) {
    const double* own = columns + j * stride;
    const double coefficient = coefficients[j];
    for (std::size_t i = 0; i < rows; ++i) rest[i] -= coefficient * own[i];
  }
}

/// A sum of columns, the first four of which are written instead of added to zeros.
JOINTID_CLONES void combine(const double* columns, std::size_t stride, const double* c,
                            std::size_t count, std::size_t rows, double* __restrict sum) {
  const double* one = columns;
  const double* two = one + stride;
  const double* three = two + stride;
  const double* four = three + stride;
  const double c0 = c[0], c1 = c[1], c2 = c[2], c3 = c[3];
  for (std::size_t i = 0; i < rows; ++i) {
    sum[i] = (c0 * one[i] + c1 * two[i]) + (c2 * three[i] + c3 * four[i]);
  }
  for (std::size_t j = 4; j < count; ++j) {
    const double* own = columns + j * stride;
    const double coefficient = c[j];
    for (std::size_t i = 0; i < rows; ++i) sum[i] += coefficient * own[i];
  }
}

}  // namespace

Eigen::MatrixXd symmetric_products(const Eigen::Ref<const Eigen::MatrixXd>& left,
                                   const Eigen::Ref<const Eigen::MatrixXd>& right) {
  const Eigen::Index columns = left.cols();
  Eigen::MatrixXd result(columns, columns);
  for (Eigen::Index j = 0; j < columns; ++j) {
    multiply(right.col(j).data(), left.data() + j * left.outerStride(),
             static_cast<std::size_t>(left.outerStride()), static_cast<std::size_t>(columns - j),
             static_cast<std::size_t>(left.rows()), result.col(j).data() + j);
    result.row(j).tail(columns - j) = result.col(j).tail(columns - j).transpose();
  }
  return result;
}

Eigen::VectorXd products(const Eigen::Ref<const Eigen::MatrixXd>& left,
                         const Eigen::Ref<const Eigen::VectorXd>& right) {
  Eigen::VectorXd result(left.cols());
  multiply(right.data(), left.data(), static_cast<std::size_t>(left.outerStride()),
           static_cast<std::size_t>(left.cols()), static_cast<std::size_t>(left.rows()),
           result.data());
  return result;
}

Eigen::VectorXd sum_of(const Eigen::Ref<const Eigen::MatrixXd>& columns,
                       const Eigen::VectorXd& coefficients) {
  if (columns.cols() < 4 || columns.cols() >= 8) {  // of eight and more, two times four go together
    Eigen::VectorXd result = Eigen::VectorXd::Zero(columns.rows());
    subtract_sum(columns, -coefficients, result);
    return result;
  }
  Eigen::VectorXd result(columns.rows());
  combine(columns.data(), static_cast<std::size_t>(columns.outerStride()), coefficients.data(),
          static_cast<std::size_t>(columns.cols()), static_cast<std::size_t>(columns.rows()),
          result.data());
  return result;
}

void subtract_sum(const Eigen::Ref<const Eigen::MatrixXd>& columns,
                  const Eigen::VectorXd& coefficients, Eigen::Ref<Eigen::VectorXd> rest) {
  subtract(columns.data(), static_cast<std::size_t>(columns.outerStride()), coefficients.data(),
           static_cast<std::size_t>(columns.cols()), static_cast<std::size_t>(columns.rows()),
           rest.data());
}

}  // namespace jointid::base
