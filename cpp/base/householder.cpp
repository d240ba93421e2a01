#include "base/householder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "base/clones.hpp"
#include "base/inner_product.hpp"

namespace jointid::base {

namespace {

/// Reduces a matrix, stored by columns, to its triangle, by one reflection per column.
JOINTID_CLONES void reflect(double* matrix, std::size_t rows, std::size_t columns) {
  for (std::size_t k = 0; k < std::min(rows, columns); ++k) {
    double* own = matrix + k * rows + k;
    const std::size_t below = rows - k - 1;
    const double head = own[0];
    const double tail = inner_product(own + 1, own + 1, below);
    if (tail <= std::numeric_limits<double>::min()) continue;
    const double size = std::sqrt(head * head + tail);
    const double diagonal = head >= 0.0 ? -size : size;
    // The reflection is 1 - weight v v' with v = (1, own / (head - diagonal)).
    const double scale = 1.0 / (head - diagonal);
    const double weight = (diagonal - head) / diagonal;
    for (std::size_t i = 1; i <= below; ++i) own[i] *= scale;
    std::size_t j = k + 1;
    for (; j + 4 <= columns;
         j += 4) {  // four columns together, so that the reflection's vector is read once
      double* others = matrix + j * rows + k;
      std::array<double, 4> along;
      four_products(own + 1, others + 1, rows, below, along.data());
      for (std::size_t c = 0; c < 4; ++c) {
        double* other = others + c * rows;
        along[c] = weight * (other[0] + along[c]);
        other[0] -= along[c];
      }
      std::size_t i = 1;
      for (; i + kFour <= rows - k; i += kFour) {
        Four part;
        load(part, own + i);
        for (std::size_t c = 0; c < 4; ++c) {
          Four there;
          load(there, others + c * rows + i);
          subtract(there, part * along[c]);
          store(others + c * rows + i, there);
        }
      }
      for (; i <= below; ++i) {
        for (std::size_t c = 0; c < 4; ++c) others[c * rows + i] -= along[c] * own[i];
      }
    }
    for (; j < columns; ++j) {
      double* other = matrix + j * rows + k;
      const double along = weight * (other[0] + inner_product(own + 1, other + 1, below));
      other[0] -= along;
      for (std::size_t i = 1; i <= below; ++i) other[i] -= along * own[i];
    }
    own[0] = diagonal;
  }
}

}  // namespace

Eigen::MatrixXd triangle_of(Eigen::MatrixXd& matrix) {
  reflect(matrix.data(), static_cast<std::size_t>(matrix.rows()),
          static_cast<std::size_t>(matrix.cols()));
  return matrix.topRows(std::min(matrix.rows(), matrix.cols())).triangularView<Eigen::Upper>();
}

}  // namespace jointid::base
