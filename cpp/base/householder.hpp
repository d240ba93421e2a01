#pragma once
// The triangle of a tall matrix by Householder's reflections, at the vector width of the host.

#include <Eigen/Core>

namespace jointid::base {

/// R of the QR decomposition (Golub and Van Loan, 5.2.1). The matrix may also be wide, and is
/// overwritten. R has as many rows as the smaller dimension of the matrix.
Eigen::MatrixXd triangle_of(Eigen::MatrixXd& matrix);

}  // namespace jointid::base
