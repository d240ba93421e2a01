#pragma once
// The triangle of a tall matrix by Householder's reflections, at the vector width of the host.

#include <Eigen/Core>

namespace jointid::base {

/// R of the QR decomposition (Golub and Van Loan, 5.2.1); the matrix, which may also be wide, is
/// used up. As many rows as the smaller of its sizes.
Eigen::MatrixXd triangle_of(Eigen::MatrixXd& matrix);

}  // namespace jointid::base
