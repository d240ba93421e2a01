#include "base/gram.hpp"

#include <cstddef>

#include "base/clones.hpp"
#include "base/inner_product.hpp"

namespace jointid::base {

namespace {

/// products[j] of a column with `count` others, `stride` apart.
JOINTID_CLONES void multiply(const double* column, const double* others, std::size_t stride,
                             std::size_t count, std::size_t rows, double* products) {
  for (std::size_t j = 0; j < count; ++j) {
    products[j] = inner_product(column, others + j * stride, rows);
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

}  // namespace jointid::base
