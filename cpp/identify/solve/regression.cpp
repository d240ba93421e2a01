#include "identify/solve/regression.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/decompositions.hpp"
#include "base/householder.hpp"
#include "identify/penalty/penalty_parts.hpp"

namespace jointid::identify {

namespace {

constexpr Eigen::Index kRows = 512;    // rows per block: it stays in the cache
constexpr Eigen::Index kTask = 16384;  // rows that one task reduces to one triangle

std::size_t tasks(Eigen::Index rows) {
  return static_cast<std::size_t>(std::max<Eigen::Index>(1, (rows + kTask - 1) / kTask));
}

// Largest condition of clearly independent columns. Below it, rank and rounding are not confused,
// and all solution methods agree.
constexpr double kIndependent = 1e6;

}  // namespace

Eigen::MatrixXd triangle(const Eigen::Ref<const Eigen::MatrixXd>& matrix, base::Pool* pool) {
  const Eigen::Index columns = matrix.cols();
  std::vector<Eigen::MatrixXd> each(tasks(matrix.rows()));
  for_each(each.size(), pool, [&](std::size_t task) {
    const auto begin = static_cast<Eigen::Index>(task) * kTask;
    const Eigen::Index end = std::min(matrix.rows(), begin + kTask);
    Eigen::MatrixXd& reached = each[task];
    reached.resize(0, columns);
    Eigen::MatrixXd block;
    for (Eigen::Index row = begin; row < end; row += kRows) {
      const Eigen::Index count = std::min(kRows, end - row);
      block.resize(reached.rows() + count, columns);
      block << reached, matrix.middleRows(row, count);
      reached = base::triangle_of(block);
    }
  });
  Eigen::MatrixXd all = each[0];
  for (std::size_t i = 1; i < each.size(); ++i) {
    Eigen::MatrixXd both(all.rows() + each[i].rows(), columns);
    both << all, each[i];
    all = base::triangle_of(both);
  }
  return all;
}

std::optional<std::pair<Eigen::VectorXd, double>> solve_independent(
    const Eigen::Ref<const Eigen::MatrixXd>& triangle, const std::vector<Eigen::Index>& columns,
    Eigen::Index target) {
  const auto count = static_cast<Eigen::Index>(columns.size());
  if (count == 0 || triangle.rows() < count) return std::nullopt;
  Eigen::MatrixXd regressors(triangle.rows(), count);
  for (Eigen::Index j = 0; j < count; ++j) {
    regressors.col(j) = triangle.col(columns[static_cast<std::size_t>(j)]);
  }
  const Eigen::VectorXd norms = regressors.colwise().norm();
  if (!(norms.minCoeff() > 0.0)) return std::nullopt;
  const Eigen::VectorXd wanted = triangle.col(target);
  const auto [upper, right] = base::reduced(regressors * norms.cwiseInverse().asDiagonal(), wanted);
  const Eigen::MatrixXd inverse = base::solve_upper(upper, Eigen::MatrixXd::Identity(count, count));
  // Frobenius norms, which are upper bounds of the norms in the condition; that of the scaled
  // columns is the root of their number.
  const double condition = std::sqrt(static_cast<double>(count)) * inverse.norm();
  if (!(condition < kIndependent)) return std::nullopt;
  const Eigen::VectorXd found = base::solve_upper(upper, right).cwiseQuotient(norms);
  return std::make_pair(found, (wanted - regressors * found).norm());
}

}  // namespace jointid::identify
