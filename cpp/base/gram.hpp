#pragma once
// Inner products of columns, at the vector width of the host.

#include <Eigen/Core>

namespace jointid::base {

/// left' right of two matrices of one shape with a symmetric product. The lower triangle is
/// computed, the upper one is its mirror image.
Eigen::MatrixXd symmetric_products(const Eigen::Ref<const Eigen::MatrixXd>& left,
                                   const Eigen::Ref<const Eigen::MatrixXd>& right);

/// left' right of a matrix and one column.
Eigen::VectorXd products(const Eigen::Ref<const Eigen::MatrixXd>& left,
                         const Eigen::Ref<const Eigen::VectorXd>& right);

/// left right of two matrices of some hundred rows and columns. Each sum is in the order of left's
/// columns, whatever the vector width; Eigen's own product depends on the compiler's options.
Eigen::MatrixXd product(const Eigen::Ref<const Eigen::MatrixXd>& left,
                        const Eigen::Ref<const Eigen::MatrixXd>& right);

/// A sum of columns, each times its coefficient.
Eigen::VectorXd sum_of(const Eigen::Ref<const Eigen::MatrixXd>& columns,
                       const Eigen::VectorXd& coefficients);

/// Subtracts a sum of columns, each times its coefficient, from `rest`.
void subtract_sum(const Eigen::Ref<const Eigen::MatrixXd>& columns,
                  const Eigen::VectorXd& coefficients, Eigen::Ref<Eigen::VectorXd> rest);

}  // namespace jointid::base
