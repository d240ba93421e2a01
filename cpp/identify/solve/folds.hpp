#pragma once
// Cross-validated least squares of one target on any of many columns: blocks of rows are left out
// in turn. Inner products of every block are kept, so that a choice of columns costs no rows.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace jointid::identify {

class Folds {
 public:
  /// `rows`: `width` values each, one row after the other; the last column is the target. Block b
  /// has the rows edges[b] .. edges[b + 1] - 1.
  Folds(const double* rows, std::size_t width, const std::vector<std::int64_t>& edges);

  [[nodiscard]] Eigen::Index blocks() const { return static_cast<Eigen::Index>(blocks_); }
  [[nodiscard]] std::size_t width() const { return width_; }
  /// Sum of squares in each block of what these columns, fitted to the other blocks, leave of the
  /// target. All columns count as if they had unit size, over all blocks.
  [[nodiscard]] Eigen::VectorXd misfit(const std::vector<std::size_t>& columns) const;

 private:
  std::size_t width_;
  std::size_t blocks_;
  std::size_t lanes_;             ///< blocks side by side, padded
  std::vector<double> products_;  ///< of columns j <= i: pair after pair, its lanes side by side
  std::vector<double> others_;    ///< the same over all other blocks
};

}  // namespace jointid::identify
