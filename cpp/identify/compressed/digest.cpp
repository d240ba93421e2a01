#include "identify/compressed/digest.hpp"

#include <algorithm>
#include <utility>

#include "base/clones.hpp"
#include "base/decompositions.hpp"
#include "base/inner_product.hpp"

namespace jointid::identify {

namespace {

constexpr std::size_t kMerged = 32;  // rows per part: they stay in the cache

/// Removes the `count` directions at q, `rows` apart, from a column. `products`: the column's share
/// of each direction.
JOINTID_CLONES void take_out(const double* q, std::size_t count, std::size_t rows, double* column,
                             double* products) {
  base::inner_products(column, q, rows, count, rows, products);
  std::size_t j = 0;
  for (; j + 4 <= count; j += 4) {
    const double* const direction = q + j * rows;
    const double* const share = products + j;
    for (std::size_t i = 0; i < rows; ++i) {
      const double first = share[0] * direction[i] + share[1] * direction[i + rows];
      const double last = share[2] * direction[i + 2 * rows] + share[3] * direction[i + 3 * rows];
      column[i] -= first + last;
    }
  }
  for (; j + 2 <= count; j += 2) {
    const double* const direction = q + j * rows;
    const double* const share = products + j;
    for (std::size_t i = 0; i < rows; ++i) {
      column[i] -= share[0] * direction[i] + share[1] * direction[i + rows];
    }
  }
  for (; j < count; ++j) {
    for (std::size_t i = 0; i < rows; ++i) column[i] -= products[j] * q[i + j * rows];
  }
}

JOINTID_CLONES double inner_product(const double* a, const double* b, std::size_t count) {
  return base::inner_product(a, b, count);
}

/// Splits columns into their projections on the constant columns and inner products of the
/// remainders.
Digest split(const Eigen::MatrixXd& constant, Eigen::MatrixXd& columns, Eigen::Index shaped) {
  const Eigen::Index m = constant.cols();
  auto [q, triangle] = base::orthogonal(constant);
  Digest result;
  result.triangle = std::move(triangle);
  result.projections.resize(m, columns.cols());
  const auto rows = static_cast<std::size_t>(columns.rows());
  for (Eigen::Index j = 0; j < columns.cols(); ++j) {
    take_out(q.data(), static_cast<std::size_t>(m), rows, columns.col(j).data(),
             result.projections.col(j).data());
  }
  const Eigen::Index nodes = shaped > 0 ? columns.cols() / shaped : 0;
  result.remainders.resize(pairs(shaped), nodes);
  for (Eigen::Index node = 0; node < nodes; ++node) {
    Eigen::Index pair = 0;
    for (Eigen::Index j = 0; j < shaped; ++j) {
      for (Eigen::Index i = 0; i <= j; ++i) {
        result.remainders(pair++, node) = inner_product(
            columns.col(node * shaped + i).data(), columns.col(node * shaped + j).data(), rows);
      }
    }
  }
  return result;
}

}  // namespace

Digest digest(Eigen::MatrixXd& constant, Eigen::MatrixXd& columns, Eigen::Index shaped) {
  const Eigen::Index m = constant.cols();
  if (constant.rows() < m) {  // rows of zeros change nothing, and give the triangle its size
    const Eigen::Index rows = constant.rows();
    constant.conservativeResize(m, Eigen::NoChange);
    columns.conservativeResize(m, Eigen::NoChange);
    constant.bottomRows(m - rows).setZero();
    columns.bottomRows(m - rows).setZero();
  }
  return split(constant, columns, shaped);
}

Digest merge(const std::vector<Digest>& parts) {
  if (parts.size() == 1) return parts[0];
  std::vector<Digest> merged;
  for (std::size_t begin = 0; begin < parts.size(); begin += kMerged) {
    const std::size_t end = std::min(parts.size(), begin + kMerged);
    const auto count = static_cast<Eigen::Index>(end - begin);
    const Eigen::Index m = parts[begin].triangle.cols();
    Eigen::MatrixXd constant(count * m, m);
    Eigen::MatrixXd columns(count * m, parts[begin].projections.cols());
    Eigen::MatrixXd remainders =
        Eigen::MatrixXd::Zero(parts[begin].remainders.rows(), parts[begin].remainders.cols());
    for (Eigen::Index i = 0; i < count; ++i) {
      const auto& part = parts[begin + static_cast<std::size_t>(i)];
      constant.middleRows(i * m, m) = part.triangle;
      columns.middleRows(i * m, m) = part.projections;
      remainders += part.remainders;
    }
    const Eigen::Index shaped =
        remainders.cols() > 0 ? columns.cols() / remainders.cols() : Eigen::Index{0};
    merged.push_back(split(constant, columns, shaped));
    merged.back().remainders += remainders;
  }
  return merged.size() == 1 ? merged[0] : merge(merged);
}

}  // namespace jointid::identify
