// Building blocks of sums and extremes over many rows, compared with plain loops.

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "base/gram.hpp"
#include "base/householder.hpp"
#include "base/random.hpp"
#include "base/scans.hpp"
#include "check.hpp"
#include "identify/balance/decays.hpp"

namespace jointid::tests {
namespace {

Eigen::MatrixXd scattered(Eigen::Index rows, Eigen::Index columns) {
  base::Random random(3, 0);
  Eigen::MatrixXd result(rows, columns);
  for (Eigen::Index j = 0; j < columns; ++j) {
    for (Eigen::Index i = 0; i < rows; ++i) result(i, j) = random.uniform() - 0.4;
  }
  return result;
}

}  // namespace

CHECK_CASE("columns: the triangle has the columns' inner products") {
  for (const Eigen::Index rows : {1, 3, 5, 8, 37, 400}) {
    constexpr Eigen::Index kColumns = 11;  // two times four, and three more
    Eigen::MatrixXd matrix = scattered(rows, kColumns);
    matrix.col(3).setZero();
    matrix.col(1) *= 1e-9;
    const Eigen::MatrixXd products = matrix.transpose() * matrix;
    const Eigen::MatrixXd triangle = base::triangle_of(matrix);
    CHECK(triangle.rows() == std::min<Eigen::Index>(rows, kColumns));
    const Eigen::MatrixXd found = triangle.transpose() * triangle;
    for (Eigen::Index j = 0; j < kColumns; ++j) {
      for (Eigen::Index i = 0; i < kColumns; ++i) {
        const double size = std::sqrt(products(i, i) * products(j, j));
        CHECK_CLOSE(found(i, j), products(i, j), 1e-14 * size);
      }
      for (Eigen::Index i = j + 1; i < triangle.rows(); ++i) CHECK(triangle(i, j) == 0.0);
    }
  }
}

CHECK_CASE("columns: symmetric products, also of a part of a matrix") {
  const Eigen::MatrixXd matrix = scattered(45, 6);
  const Eigen::VectorXd weight = scattered(45, 1).cwiseAbs();
  const Eigen::MatrixXd weighted = weight.asDiagonal() * matrix;
  const Eigen::MatrixXd expected = matrix.transpose() * weighted;
  const Eigen::MatrixXd found = base::symmetric_products(matrix, weighted);
  CHECK((found - expected).cwiseAbs().maxCoeff() < 1e-14);
  const Eigen::MatrixXd part =
      base::symmetric_products(matrix.block(3, 1, 40, 4), weighted.block(3, 1, 40, 4));
  const Eigen::MatrixXd wanted =
      matrix.block(3, 1, 40, 4).transpose() * weighted.block(3, 1, 40, 4);
  CHECK((part - wanted).cwiseAbs().maxCoeff() < 1e-14);
}

CHECK_CASE("columns: products of matrices of any shape, in the order of the sums") {
  for (const Eigen::Index rows : {1, 7, 8, 29}) {
    for (const Eigen::Index depth : {1, 13}) {
      for (const Eigen::Index columns : {1, 4, 6}) {
        const Eigen::MatrixXd left = scattered(rows + 2, depth).middleRows(1, rows);
        const Eigen::MatrixXd right = scattered(depth, columns);
        const Eigen::MatrixXd found = base::product(left, right);
        CHECK(found.rows() == rows && found.cols() == columns);
        for (Eigen::Index i = 0; i < rows; ++i) {
          for (Eigen::Index j = 0; j < columns; ++j) {
            double sum = 0.0;
            for (Eigen::Index k = 0; k < depth; ++k) sum += left(i, k) * right(k, j);
            CHECK(found(i, j) == sum);
          }
        }
      }
    }
  }
}

CHECK_CASE("scans: extremes of samples and steps, wherever they lie") {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  const Eigen::VectorXd base = scattered(23, 1);
  for (Eigen::Index place = 0; place < 23; ++place) {
    for (const double value : {-3.0, 0.0, 4.0}) {
      Eigen::VectorXd x = base;
      x[place] = value;
      const auto [low, high] = base::range_of(x.data(), 23);
      CHECK(low == x.minCoeff() && high == x.maxCoeff());
      double any = kNone;
      double positive = kNone;
      for (const double one : x) {
        any = std::min(any, std::fabs(one));
        if (one != 0.0) positive = std::min(positive, std::fabs(one));
      }
      const auto sizes = base::least_sizes(x.data(), 23);
      CHECK(sizes.any == any && sizes.positive == positive);
      if (place > 0) x[place - 1] = x[place];  // a step of zero
      double least = kNone;
      double height = 0.0;
      for (Eigen::Index k = 0; k + 1 < 23; ++k) {
        const double step = std::fabs(x[k + 1] - x[k]);
        if (step > 0.0) least = std::min(least, step);
        if (k + 2 >= 23) continue;
        const double there = x[k + 1] - x[k];
        const double back = x[k + 1] - x[k + 2];
        if (there * back > 0.0)
          height = std::max(height, std::min(std::fabs(there), std::fabs(back)));
      }
      const auto steps = base::least_steps(x.data(), 22);
      CHECK(steps.positive == least);
      CHECK(steps.any == (place > 0 ? 0.0 : least));
      CHECK(base::largest_height(x.data(), 1, 21) == height);
    }
  }
}

CHECK_CASE("scans: the samples of one sign end at the first other one, at any place") {
  for (const double side : {1.0, -1.0}) {
    for (const std::size_t count : {1U, 3U, 16U, 37U}) {
      std::vector<double> x(count, 0.5 * side);
      CHECK(base::one_sided(x.data(), count) == count);
      for (std::size_t place = 0; place < count; ++place) {
        for (const double other : {0.0, -0.0, -1e-300 * side}) {
          auto changed = x;
          changed[place] = other;
          // The first sample gives the sign, if it has one.
          const bool alone = place == 0 && other != 0.0;
          CHECK(base::one_sided(changed.data(), count) == (alone ? 1 : place));
        }
      }
    }
  }
}

CHECK_CASE("columns: an inner product has the same bits alone and together with three others") {
  for (const Eigen::Index rows : {1, 7, 8, 29, 400}) {
    const Eigen::MatrixXd matrix = scattered(rows, 12);
    const Eigen::VectorXd together = base::products(matrix, matrix.col(0));
    for (Eigen::Index j = 0; j < 12; ++j) {
      const Eigen::VectorXd alone = base::products(matrix.middleCols(j, 1), matrix.col(0));
      CHECK(alone[0] == together[j]);
    }
  }
}

CHECK_CASE("scans: a value that is not finite or does not increase is seen at every place") {
  const Eigen::VectorXd time = Eigen::VectorXd::LinSpaced(21, 0.0, 1.0);
  CHECK(base::all_finite(time.data(), 21) && base::increases(time.data(), 20));
  for (Eigen::Index k = 0; k < 21; ++k) {
    for (const double bad : {HUGE_VAL, -HUGE_VAL, std::nan("")}) {
      Eigen::VectorXd wrong = time;
      wrong[k] = bad;
      CHECK(!base::all_finite(wrong.data(), 21));
    }
    if (k == 0) continue;
    Eigen::VectorXd still = time;
    still[k] = still[k - 1];
    CHECK(!base::increases(still.data(), 20));
  }
}

CHECK_CASE("decays: sums by series equal sums of single exponentials") {
  base::Random random(5, 0);
  identify::FrictionNodes nodes;
  for (const int count : {0, 1, 11, 12, 13, 40, 200}) {
    const double start = 3.0 * random.uniform();
    const double step = 0.2 * random.uniform() / std::max(1, count);
    for (int i = 0; i < count; ++i) {
      nodes.speed.push_back(std::fabs(start - i * step));
      nodes.weight.push_back(1e-3 * (random.uniform() - 0.2));
    }
    nodes.first.push_back(nodes.speed.size());
  }
  for (int i = 0; i < 12; ++i) {  // squares that are almost or exactly zero
    nodes.speed.push_back(1e-155 * std::pow(0.3, i));
    nodes.weight.push_back(1e-3);
  }
  nodes.first.push_back(nodes.speed.size());
  identify::DecayRates group;
  for (double rate = -0.05; rate < 2000.0; rate = rate < 0.01 ? rate + 0.03 : 1.4 * rate) {
    group.rates.push_back(rate);
  }
  const auto windows = nodes.first.size() - 1;
  Eigen::MatrixXd found(static_cast<Eigen::Index>(windows),
                        static_cast<Eigen::Index>(group.rates.size()));
  integrate_decays(nodes, {0, windows}, group, nullptr, found);
  for (std::size_t w = 0; w < windows; ++w) {
    for (std::size_t k = 0; k < group.rates.size(); ++k) {
      double sum = 0.0;
      double size = 0.0;
      for (std::size_t i = nodes.first[w]; i < nodes.first[w + 1]; ++i) {
        sum += nodes.weight[i] * std::exp(-group.rates[k] * nodes.speed[i] * nodes.speed[i]);
        size += std::fabs(nodes.weight[i]);
      }
      const auto row = static_cast<Eigen::Index>(w);
      CHECK_CLOSE(found(row, static_cast<Eigen::Index>(k)), sum, 4e-15 * size);
    }
  }
}

}  // namespace jointid::tests
