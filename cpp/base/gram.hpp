#pragma once
// Inner products of columns, at the vector width of the host.

#include <Eigen/Core>

namespace jointid::base {

/// left' right of two matrices of one shape, whose columns' products are symmetric: the lower
/// triangle is computed, the upper one is its mirror image.
Eigen::MatrixXd symmetric_products(const Eigen::Ref<const Eigen::MatrixXd>& left,
                                   const Eigen::Ref<const Eigen::MatrixXd>& right);

}  // namespace jointid::base
