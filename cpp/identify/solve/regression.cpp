#include "identify/solve/regression.hpp"

#include <algorithm>
#include <vector>

#include "base/householder.hpp"
#include "identify/penalty/penalty_parts.hpp"

namespace jointid::identify {

namespace {

constexpr Eigen::Index kRows = 512;    // of a block: it stays in the cache
constexpr Eigen::Index kTask = 16384;  // rows that one task brings down to one triangle

std::size_t tasks(Eigen::Index rows) {
  return static_cast<std::size_t>(std::max<Eigen::Index>(1, (rows + kTask - 1) / kTask));
}

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

SegmentSums segment_sums(const Eigen::Ref<const Eigen::MatrixXd>& jacobian,
                         const Eigen::VectorXd& residual, const Eigen::MatrixXd& whitening,
                         const std::vector<std::int64_t>& cuts) {
  const Eigen::MatrixXd rows = whitening * jacobian.transpose();
  const auto count = static_cast<Eigen::Index>(cuts.size()) - 1;
  SegmentSums result;
  result.scores.resize(whitening.rows(), count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Index first = cuts[static_cast<std::size_t>(i)];
    const Eigen::Index length = cuts[static_cast<std::size_t>(i) + 1] - first;
    const auto mine = rows.middleCols(first, length);
    result.shares.emplace_back(mine * mine.transpose());
    result.scores.col(i).noalias() = mine * residual.segment(first, length);
  }
  return result;
}

}  // namespace jointid::identify
