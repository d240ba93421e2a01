#include "identify/solve/regression.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <vector>

#include "base/elementary.hpp"
#include "identify/penalty/penalty_parts.hpp"

namespace jointid::identify {

namespace {

constexpr Eigen::Index kRows = 512;    // of a block: it stays in the cache
constexpr Eigen::Index kTask = 16384;  // rows that one task brings down to one triangle
// Scores are hardly ever more persistent; beyond, recolouring would amplify its own error.
constexpr double kMostPersistent = 0.97;

Eigen::MatrixXd upper(const Eigen::MatrixXd& block) {
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(block);
  const Eigen::Index rows = std::min(block.rows(), block.cols());
  return qr.matrixQR().topRows(rows).triangularView<Eigen::Upper>();
}

std::size_t tasks(Eigen::Index rows) {
  return static_cast<std::size_t>(std::max<Eigen::Index>(1, (rows + kTask - 1) / kTask));
}

/// Newey and West's sum of one white series.
double long_run(const Eigen::VectorXd& white, Eigen::Index lags) {
  double total = white.squaredNorm();
  const Eigen::Index rows = white.size();
  for (Eigen::Index lag = 1; lag <= std::min(lags, rows - 1); ++lag) {
    const double share = 1.0 - static_cast<double>(lag) / (static_cast<double>(lags) + 1.0);
    total += 2.0 * share * white.tail(rows - lag).dot(white.head(rows - lag));
  }
  return total;
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
      reached = upper(block);
    }
  });
  Eigen::MatrixXd all = each[0];
  for (std::size_t i = 1; i < each.size(); ++i) {
    Eigen::MatrixXd both(all.rows() + each[i].rows(), columns);
    both << all, each[i];
    all = upper(both);
  }
  return all;
}

Eigen::VectorXd robust_variance(const Eigen::Ref<const Eigen::MatrixXd>& jacobian,
                                const Eigen::VectorXd& residual, const Eigen::VectorXd& scale,
                                const Eigen::MatrixXd& weights, base::Pool* pool) {
  const Eigen::Index rows = jacobian.rows();
  const Eigen::Index columns = jacobian.cols();
  Eigen::VectorXd persistence = Eigen::VectorXd::Zero(columns);
  const auto score = [&](Eigen::Index row, Eigen::Index j) {
    return jacobian(row, j) * scale[j] * residual[row];
  };
  for_each(static_cast<std::size_t>(rows < 4 ? 0 : columns), pool, [&](std::size_t column) {
    const auto j = static_cast<Eigen::Index>(column);
    double power = 0.0;
    double lagged = 0.0;
    double before = score(0, j);
    for (Eigen::Index row = 1; row < rows; ++row) {
      const double here = score(row, j);
      power += before * before;
      lagged += here * before;
      before = here;
    }
    double found = lagged / (power > 0.0 ? power : 1.0);
    // The estimate of a persistence is biased down by about (1 + 3 rho) / n (Kendall 1954).
    found += (1.0 + 3.0 * found) / static_cast<double>(rows);
    persistence[j] = std::clamp(found, 0.0, kMostPersistent);
  });
  const auto lags = static_cast<Eigen::Index>(
      rows < 4 ? 0.0 : 4.0 * base::pow(static_cast<double>(rows) / 100.0, 2.0 / 9.0));
  Eigen::VectorXd variance(weights.cols());
  // Whitening and weighting are linear: a weighted sum of white scores is one white series.
  for_each(static_cast<std::size_t>(weights.cols()), pool, [&](std::size_t index) {
    Eigen::VectorXd white = Eigen::VectorXd::Zero(rows);
    for (Eigen::Index j = 0; j < columns; ++j) {
      const double weight = weights(j, static_cast<Eigen::Index>(index)) / (1.0 - persistence[j]);
      double before = score(0, j);
      white[0] += weight * before * std::sqrt(1.0 - persistence[j] * persistence[j]);
      for (Eigen::Index row = 1; row < rows; ++row) {
        const double here = score(row, j);
        white[row] += weight * (here - persistence[j] * before);
        before = here;
      }
    }
    variance[static_cast<Eigen::Index>(index)] = long_run(white, lags);
  });
  return variance;
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
