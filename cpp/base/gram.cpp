#include "base/gram.hpp"

#include <algorithm>
#include <cstddef>

#include "base/clones.hpp"
#include "base/four.hpp"
#include "base/inner_product.hpp"

namespace jointid::base {

namespace {

/// products[j] of a column and the j-th of `count` others, which are `stride` apart.
JOINTID_CLONES void multiply(const double* column, const double* others, std::size_t stride,
                             std::size_t count, std::size_t rows, double* products) {
  inner_products(column, others, stride, count, rows, products);
}

JOINTID_CLONES void subtract_column(const double* columns, std::size_t stride,
                                    const double* coefficients, std::size_t count, std::size_t rows,
                                    double* __restrict rest) {
  std::size_t j = 0;
  for (; j + 4 <= count; j += 4) {  // in one loop, so that the rest is read and written less often
    const double* one = columns + j * stride;
    const double* two = one + stride;
    const double* three = two + stride;
    const double* four = three + stride;
    const double* c = coefficients + j;
    const double c0 = c[0], c1 = c[1], c2 = c[2], c3 = c[3];
    for (std::size_t i = 0; i < rows; ++i) {
      rest[i] -= (c0 * one[i] + c1 * two[i]) + (c2 * three[i] + c3 * four[i]);
    }
  }
  for (; j < count; ++j) {
    const double* own = columns + j * stride;
    const double coefficient = coefficients[j];
    for (std::size_t i = 0; i < rows; ++i) rest[i] -= coefficient * own[i];
  }
}

/// A sum of columns. The first four are written instead of added to zeros.
JOINTID_CLONES void combine(const double* columns, std::size_t stride, const double* c,
                            std::size_t count, std::size_t rows, double* __restrict sum) {
  const double* one = columns;
  const double* two = one + stride;
  const double* three = two + stride;
  const double* four = three + stride;
  const double c0 = c[0], c1 = c[1], c2 = c[2], c3 = c[3];
  for (std::size_t i = 0; i < rows; ++i) {
    sum[i] = (c0 * one[i] + c1 * two[i]) + (c2 * three[i] + c3 * four[i]);
  }
  for (std::size_t j = 4; j < count; ++j) {
    const double* own = columns + j * stride;
    const double coefficient = c[j];
    for (std::size_t i = 0; i < rows; ++i) sum[i] += coefficient * own[i];
  }
}

constexpr std::size_t kTall = 2 * kFour;  // rows with sums that stay in registers, for four columns

/// result(r, c) = sum over k of left(r, k) right(k, c), for kTall rows and four columns. The rows
/// of `left` are adjacent, kTall apart from k to k + 1.
[[gnu::always_inline]] inline void tall_block(const double* left, const double* right,
                                              std::size_t depth, std::size_t stride, double* result,
                                              std::size_t rows) {
  Four a0{}, a1{}, b0{}, b1{}, c0{}, c1{}, d0{}, d1{};  // an array would live in memory
  const double* one = right;
  const double* two = right + stride;
  const double* three = right + 2 * stride;
  const double* four = right + 3 * stride;
  for (std::size_t k = 0; k < depth; ++k) {
    Four low;
    Four high;
    load(low, left + k * kTall);
    load(high, left + k * kTall + kFour);
    a0 = a0 + low * one[k];
    a1 = a1 + high * one[k];
    b0 = b0 + low * two[k];
    b1 = b1 + high * two[k];
    c0 = c0 + low * three[k];
    c1 = c1 + high * three[k];
    d0 = d0 + low * four[k];
    d1 = d1 + high * four[k];
  }
  store(result, a0);
  store(result + kFour, a1);
  store(result + rows, b0);
  store(result + rows + kFour, b1);
  store(result + 2 * rows, c0);
  store(result + 2 * rows + kFour, c1);
  store(result + 3 * rows, d0);
  store(result + 3 * rows + kFour, d1);
}

/// A strip of kTall rows by all columns. The number of columns is a multiple of four; result has
/// `rows` rows.
JOINTID_CLONES void multiply_strip(const double* left, const double* right, std::size_t depth,
                                   std::size_t stride, std::size_t columns, double* result,
                                   std::size_t rows) {
  for (std::size_t c = 0; c < columns; c += 4) {
    tall_block(left, right + c * stride, depth, stride, result + c * rows, rows);
  }
}

}  // namespace

Eigen::MatrixXd product(const Eigen::Ref<const Eigen::MatrixXd>& left,
                        const Eigen::Ref<const Eigen::MatrixXd>& right) {
  constexpr auto kHeight = static_cast<Eigen::Index>(kTall);
  const Eigen::Index depth = left.cols();
  const Eigen::Index whole = right.cols() / 4 * 4;
  const Eigen::Index rest = right.cols() - whole;
  Eigen::MatrixXd result(left.rows(), right.cols());
  // Partial blocks are filled up with zeros, in separate buffers.
  Eigen::MatrixXd last = Eigen::MatrixXd::Zero(depth, rest > 0 ? 4 : 0);
  last.leftCols(rest) = right.rightCols(rest);
  Eigen::MatrixXd strip = Eigen::MatrixXd::Zero(kHeight, depth);
  Eigen::MatrixXd block(kHeight, 4);
  Eigen::MatrixXd low(left.rows() % kHeight > 0 ? kHeight : 0, whole);
  const auto size = [](Eigen::Index number) { return static_cast<std::size_t>(number); };
  for (Eigen::Index row = 0; row < left.rows(); row += kHeight) {
    const Eigen::Index height = std::min(kHeight, left.rows() - row);
    strip.topRows(height) = left.middleRows(row, height);
    if (height == kHeight) {
      multiply_strip(strip.data(), right.data(), size(depth), size(right.outerStride()),
                     size(whole), result.data() + row, size(result.rows()));
    } else {
      multiply_strip(strip.data(), right.data(), size(depth), size(right.outerStride()),
                     size(whole), low.data(), kTall);
      result.block(row, 0, height, whole) = low.topRows(height);
    }
    if (rest == 0) continue;
    multiply_strip(strip.data(), last.data(), size(depth), size(depth), 4, block.data(), kTall);
    result.block(row, whole, height, rest) = block.topLeftCorner(height, rest);
  }
  return result;
}

Eigen::MatrixXd symmetric_products(const Eigen::Ref<const Eigen::MatrixXd>& left,
                                   const Eigen::Ref<const Eigen::MatrixXd>& right) {
  const Eigen::Index columns = left.cols();
  Eigen::MatrixXd result(columns, columns);
  for (Eigen::Index j = 0; j < columns; ++j) {
    multiply(right.col(j).data(), left.data() + j * left.outerStride(),
             static_cast<std::size_t>(left.outerStride()), static_cast<std::size_t>(columns - j),
             static_cast<std::size_t>(left.rows()), result.col(j).data() + j);
    result.row(j).tail(columns - j) = result.col(j).tail(columns - j).transpose();
  }
  return result;
}

Eigen::VectorXd products(const Eigen::Ref<const Eigen::MatrixXd>& left,
                         const Eigen::Ref<const Eigen::VectorXd>& right) {
  Eigen::VectorXd result(left.cols());
  multiply(right.data(), left.data(), static_cast<std::size_t>(left.outerStride()),
           static_cast<std::size_t>(left.cols()), static_cast<std::size_t>(left.rows()),
           result.data());
  return result;
}

Eigen::VectorXd sum_of(const Eigen::Ref<const Eigen::MatrixXd>& columns,
                       const Eigen::VectorXd& coefficients) {
  if (columns.cols() < 4 ||
      columns.cols() >= 8) {  // from eight on, two groups of four are summed together
    Eigen::VectorXd result = Eigen::VectorXd::Zero(columns.rows());
    subtract_sum(columns, -coefficients, result);
    return result;
  }
  Eigen::VectorXd result(columns.rows());
  combine(columns.data(), static_cast<std::size_t>(columns.outerStride()), coefficients.data(),
          static_cast<std::size_t>(columns.cols()), static_cast<std::size_t>(columns.rows()),
          result.data());
  return result;
}

void subtract_sum(const Eigen::Ref<const Eigen::MatrixXd>& columns,
                  const Eigen::VectorXd& coefficients, Eigen::Ref<Eigen::VectorXd> rest) {
  subtract_column(columns.data(), static_cast<std::size_t>(columns.outerStride()),
                  coefficients.data(), static_cast<std::size_t>(columns.cols()),
                  static_cast<std::size_t>(columns.rows()), rest.data());
}

}  // namespace jointid::base
