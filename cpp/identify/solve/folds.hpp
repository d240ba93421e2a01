#pragma once
// Cross-validated least squares of one target on any subset of many columns. Blocks of rows are
// left out in turn. The inner products of every block are stored, so another choice of columns
// needs no rows.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace jointid::identify {

class Folds {
 public:
  /// `rows`: `width` values per row; the last column is the target. Block b has the rows edges[b]
  /// .. edges[b + 1] - 1.
  Folds(const double* rows, std::size_t width, const std::vector<std::int64_t>& edges);

  [[nodiscard]] Eigen::Index blocks() const { return static_cast<Eigen::Index>(blocks_); }
  [[nodiscard]] std::size_t width() const { return width_; }
  /// Sum of squared residuals of the target in each block, with these columns fitted to the other
  /// blocks. All columns are scaled to unit norm over all blocks.
  [[nodiscard]] Eigen::VectorXd misfit(const std::vector<std::size_t>& columns) const;

 private:
  std::size_t width_;
  std::size_t blocks_;
  std::size_t lanes_;             ///< blocks in parallel, padded
  std::vector<double> products_;  ///< of columns j <= i: pair after pair, with adjacent lanes
  std::vector<double> others_;    ///< the same over all other blocks
};

}  // namespace jointid::identify
