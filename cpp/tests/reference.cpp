#include "reference.hpp"

#include <Eigen/LU>
#include <Eigen/QR>
#include <cstddef>
#include <vector>

namespace jointid::tests {

Eigen::MatrixXd drawn(base::Random& random, Eigen::Index rows, Eigen::Index columns) {
  Eigen::MatrixXd result(rows, columns);
  for (double& value : result.reshaped()) value = 2.0 * random.uniform() - 1.0;
  return result;
}

Eigen::VectorXd box_reference(const Eigen::MatrixXd& a, const Eigen::VectorXd& b,
                              const Eigen::VectorXd& lower, const Eigen::VectorXd& upper) {
  const Eigen::Index n = a.cols();
  int combinations = 1;
  for (Eigen::Index j = 0; j < n; ++j) combinations *= 3;
  Eigen::VectorXd best = lower;
  double best_square = std::numeric_limits<double>::infinity();
  for (int combination = 0; combination < combinations; ++combination) {
    Eigen::VectorXd x = lower;
    std::vector<Eigen::Index> free;
    int digits = combination;
    for (Eigen::Index j = 0; j < n; ++j, digits /= 3) {
      if (digits % 3 == 1) x[j] = upper[j];
      if (digits % 3 == 2) free.push_back(j);
    }
    if (!free.empty()) {
      for (const auto j : free) x[j] = 0.0;
      Eigen::MatrixXd part(a.rows(), static_cast<Eigen::Index>(free.size()));
      for (std::size_t i = 0; i < free.size(); ++i) {
        part.col(static_cast<Eigen::Index>(i)) = a.col(free[i]);
      }
      const Eigen::VectorXd solution = part.colPivHouseholderQr().solve(b - a * x);
      bool inside = true;
      for (std::size_t i = 0; i < free.size(); ++i) {
        const auto j = free[i];
        x[j] = solution[static_cast<Eigen::Index>(i)];
        inside = inside && x[j] >= lower[j] && x[j] <= upper[j];
      }
      if (!inside) continue;
    }
    const double square = (a * x - b).squaredNorm();
    if (square < best_square) {
      best_square = square;
      best = x;
    }
  }
  return best;
}

ConstrainedReference constrained_reference(const Eigen::MatrixXd& a, const Eigen::VectorXd& b,
                                           const Eigen::MatrixXd& g, const Eigen::VectorXd& h) {
  const Eigen::Index n = a.cols();
  ConstrainedReference best;
  for (int subset = 0; subset < (1 << g.rows()); ++subset) {
    std::vector<Eigen::Index> active;
    for (Eigen::Index i = 0; i < g.rows(); ++i) {
      if ((subset >> i) & 1) active.push_back(i);
    }
    const auto m = static_cast<Eigen::Index>(active.size());
    if (m > n) continue;
    // Stationarity and the active rows: [A'A  -G'; G  0] [x; multipliers] = [A'b; h].
    Eigen::MatrixXd system = Eigen::MatrixXd::Zero(n + m, n + m);
    Eigen::VectorXd right(n + m);
    system.topLeftCorner(n, n) = a.transpose() * a;
    right.head(n) = a.transpose() * b;
    for (Eigen::Index i = 0; i < m; ++i) {
      const auto row = active[static_cast<std::size_t>(i)];
      system.block(0, n + i, n, 1) = -g.row(row).transpose();
      system.block(n + i, 0, 1, n) = g.row(row);
      right[n + i] = h[row];
    }
    const Eigen::FullPivLU<Eigen::MatrixXd> lu(system);
    if (!lu.isInvertible()) continue;
    const Eigen::VectorXd x = lu.solve(right).head(n);
    if (((g * x - h).array() < -1e-9 * (1.0 + h.cwiseAbs().maxCoeff())).any()) continue;
    const double square = (a * x - b).squaredNorm();
    if (square < best.square) best = {x, square};
  }
  return best;
}

}  // namespace jointid::tests
