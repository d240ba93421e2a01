#include "identify/solve/folds.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/clones.hpp"

namespace jointid::identify {

namespace {

constexpr std::size_t kLanes = 8;
constexpr double kRidge = 1e-9;  // of columns of unit norm

/// Sums the products of each row's values: of values 0 .. i with value i, stored at i * width.
JOINTID_CLONES void sum_products(const double* rows, std::size_t count, std::size_t width,
                                 double* sums) {
  for (std::size_t i = 0; i < width; ++i) {
    double* sum = sums + i * width;
    for (std::size_t j = 0; j <= i; ++j) sum[j] = 0.0;
    for (std::size_t row = 0; row < count; ++row) {
      const double* x = rows + row * width;
      const double own = x[i];
      for (std::size_t j = 0; j <= i; ++j) sum[j] += own * x[j];
    }
  }
}

/// Lanes of the working arrays: `lower` is a triangle stored by rows, `target` its right side.
struct Systems {
  std::size_t size;
  std::size_t lanes;
  double* lower;
  double* target;
};

std::size_t pair_of(std::size_t i, std::size_t j) {
  return i * (i + 1) / 2 + j;
}

/// Solves the systems of all lanes at once, by Cholesky factors. Both arrays are overwritten.
JOINTID_CLONES void solve_all(const Systems& of) {
  const std::size_t lanes = of.lanes;
  const auto at = [&](std::size_t i, std::size_t j) {
    return of.lower + (i * (i + 1) / 2 + j) * lanes;
  };
  for (std::size_t j = 0; j < of.size; ++j) {
    double* own = at(j, j);
    double* right = of.target + j * lanes;
    for (std::size_t k = 0; k < j; ++k) {
      const double* left = at(j, k);
      const double* known = of.target + k * lanes;
      for (std::size_t l = 0; l < lanes; ++l) {
        own[l] -= left[l] * left[l];
        right[l] -= left[l] * known[l];
      }
    }
    for (std::size_t l = 0; l < lanes; ++l) {  // the diagonal stores the inverse of the root
      own[l] = 1.0 / std::sqrt(own[l] > kRidge * kRidge ? own[l] : kRidge * kRidge);
      right[l] *= own[l];
    }
    for (std::size_t i = j + 1; i < of.size; ++i) {
      double* entry = at(i, j);
      for (std::size_t k = 0; k < j; ++k) {
        const double* left = at(i, k);
        const double* above = at(j, k);
        for (std::size_t l = 0; l < lanes; ++l) entry[l] -= left[l] * above[l];
      }
      for (std::size_t l = 0; l < lanes; ++l) entry[l] *= own[l];
    }
  }
  for (std::size_t j = of.size; j-- > 0;) {
    double* found = of.target + j * lanes;
    for (std::size_t i = j + 1; i < of.size; ++i) {
      const double* left = at(i, j);
      const double* known = of.target + i * lanes;
      for (std::size_t l = 0; l < lanes; ++l) found[l] -= left[l] * known[l];
    }
    const double* own = at(j, j);
    for (std::size_t l = 0; l < lanes; ++l) found[l] *= own[l];
  }
}

/// result -= factor * products * first * second, in each lane.
JOINTID_CLONES void take_away(double factor, const double* products, const double* first,
                              const double* second, std::size_t lanes, double* result) {
  for (std::size_t l = 0; l < lanes; ++l) {
    result[l] -= factor * (products[l] * first[l] * second[l]);
  }
}

}  // namespace

Folds::Folds(const double* rows, std::size_t width, const std::vector<std::int64_t>& edges)
    : width_(width), blocks_(edges.size() - 1) {
  lanes_ = (blocks_ + kLanes - 1) / kLanes * kLanes;
  const std::size_t pairs = width * (width + 1) / 2;
  products_.assign(pairs * lanes_, 0.0);
  std::vector<double> sums(width * width);
  for (std::size_t b = 0; b < blocks_; ++b) {
    const auto begin = static_cast<std::size_t>(edges[b]);
    const auto end = static_cast<std::size_t>(edges[b + 1]);
    sum_products(rows + begin * width, end - begin, width, sums.data());
    double* to = products_.data() + b;
    for (std::size_t i = 0; i < width; ++i) {
      for (std::size_t j = 0; j <= i; ++j, to += lanes_) *to = sums[i * width + j];
    }
  }
  std::vector<double> scale(width);
  for (std::size_t i = 0; i < width; ++i) {
    const double* own = products_.data() + pair_of(i, i) * lanes_;
    double square = 0.0;
    for (std::size_t b = 0; b < blocks_; ++b) square += own[b];
    scale[i] = square > 0.0 ? 1.0 / std::sqrt(square) : 1.0;
  }
  others_.resize(products_.size());
  for (std::size_t i = 0; i < width; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double* own = products_.data() + pair_of(i, j) * lanes_;
      double* other = others_.data() + pair_of(i, j) * lanes_;
      const double both = scale[i] * scale[j];
      double sum = 0.0;
      for (std::size_t l = 0; l < lanes_; ++l) sum += own[l] *= both;
      for (std::size_t l = 0; l < lanes_; ++l) other[l] = sum - own[l];
    }
  }
}

Eigen::VectorXd Folds::misfit(const std::vector<std::size_t>& columns) const {
  const std::size_t size = columns.size();
  const std::size_t target = width_ - 1;
  const auto place = [&](std::size_t i, std::size_t j) {
    return pair_of(std::max(i, j), std::min(i, j)) * lanes_;
  };
  std::vector<double> lower(size * (size + 1) / 2 * lanes_);
  std::vector<double> found(size * lanes_);
  for (std::size_t i = 0; i < size; ++i) {
    if (columns[i] >= target) throw std::invalid_argument("there is no such column");
    for (std::size_t j = 0; j <= i; ++j) {
      double* to = lower.data() + pair_of(i, j) * lanes_;
      std::copy_n(others_.data() + place(columns[i], columns[j]), lanes_, to);
      for (std::size_t l = 0; i == j && l < lanes_; ++l) to[l] += kRidge;
    }
    std::copy_n(others_.data() + place(columns[i], target), lanes_, found.data() + i * lanes_);
  }
  solve_all({size, lanes_, lower.data(), found.data()});
  const std::vector<double> ones(lanes_, 1.0);
  std::vector<double> left(
      products_.begin() + static_cast<std::ptrdiff_t>(place(target, target)),
      products_.begin() + static_cast<std::ptrdiff_t>(place(target, target) + lanes_));
  for (std::size_t i = 0; i < size; ++i) {
    const double* own = found.data() + i * lanes_;
    take_away(2.0, products_.data() + place(columns[i], target), own, ones.data(), lanes_,
              left.data());
    for (std::size_t j = 0; j <= i; ++j) {
      take_away(i == j ? -1.0 : -2.0, products_.data() + place(columns[i], columns[j]), own,
                found.data() + j * lanes_, lanes_, left.data());
    }
  }
  Eigen::VectorXd result(blocks());
  for (Eigen::Index b = 0; b < result.size(); ++b) {
    result[b] = std::max(left[static_cast<std::size_t>(b)], 0.0);
  }
  return result;
}

}  // namespace jointid::identify
