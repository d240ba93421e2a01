// Delays of signals: window means, the shift of a balance, noise that one signal repeats.

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "base/circle.hpp"
#include "base/elementary.hpp"
#include "check.hpp"
#include "identify/solve/clustered.hpp"
#include "identify/solve/regression.hpp"
#include "signals/repeated_noise.hpp"
#include "signals/shift_fit.hpp"

namespace jointid::tests {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using signals::Signal;

constexpr double kPeriod = 1e-3;
constexpr Index kSamples = 6000;
constexpr Index kHalf = 6;

Signal view(const VectorXd& values) {
  return {values.data(), values.size()};
}

double motion(double t, Index column) {
  if (column == 0) return base::cos(9.0 * t);
  return column == 1 ? base::sin(23.0 * t) : 1.0;
}

/// A signal that is late, its windows and the columns that it is a sum of.
struct Late {
  VectorXd time = VectorXd::LinSpaced(kSamples, 0.0, kPeriod*(kSamples - 1));
  VectorXd signal = VectorXd(kSamples);
  VectorXd weight = VectorXd(2 * kHalf - 1);
  signals::Middles middles;
  std::vector<bool> kept;
  MatrixXd columns;

  explicit Late(double delay) {
    for (Index k = 0; k < weight.size(); ++k) {
      weight[k] = 1.0 + std::cos(std::numbers::pi * static_cast<double>(k - kHalf + 1) / kHalf);
    }
    weight /= weight.sum();
    std::vector<std::int64_t> used;
    for (Index m = 40; m + 40 < kSamples; m += kHalf) {
      middles.push_back(m);
      kept.push_back(m % 17 != 0);
      if (kept.back()) used.push_back(m);
    }
    columns.resize(static_cast<Index>(used.size()), 3);
    for (Index i = 0; i < kSamples; ++i) {
      const double t = time[i] - delay;
      signal[i] = 2.0 * motion(t, 0) - 0.7 * motion(t, 1) + 0.3;
    }
    for (Index j = 0; j < 3; ++j) {
      VectorXd own(kSamples);
      for (Index i = 0; i < kSamples; ++i) own[i] = motion(time[i], j);
      columns.col(j) = signals::window_means(view(own), view(weight), used);
    }
  }
  [[nodiscard]] signals::ShiftRows rows() const {
    return {{{view(time), view(signal), view(weight), middles, kept, kHalf, kPeriod}},
            columns,
            1,
            false};
  }
};

CHECK_CASE("shift: a late signal's delay is found, whole, in parts, and from afar") {
  for (const double delay : {0.0, 2.3e-4, -1.7e-3}) {
    const Late late(delay);
    const auto found = signals::fit_shift(late.rows(), {0.0, true, 0.0}, nullptr);
    CHECK(found.has_value());
    if (!found) continue;
    CHECK_CLOSE(found->whole[0], delay, 2e-6);
    CHECK_CLOSE(found->conservative[0], delay, 2e-6);
    CHECK_CLOSE(found->friction[0], delay, 2e-5);
    CHECK(found->unexplained < 1e-4);
    const auto afar = signals::fit_shift(late.rows(), {4e-3, false, 0.0}, nullptr);
    CHECK(afar.has_value() && std::fabs(afar->whole[0] - delay) < 2e-6);
  }
}

CHECK_CASE("shift: coefficients are those of the columns; too few rows say nothing") {
  Late late(0.0);
  const VectorXd found = signals::shift_coefficients(late.rows());
  CHECK_CLOSE(found[0], 2.0, 1e-3);
  CHECK_CLOSE(found[1], -0.7, 1e-3);
  CHECK_CLOSE(found[2], 0.3, 1e-3);
  late.middles.resize(20);
  late.kept.assign(20, true);
  late.columns = MatrixXd(late.columns.topRows(20));
  CHECK(!signals::fit_shift(late.rows(), {0.0, true, 0.0}, nullptr).has_value());
}

CHECK_CASE("shift: smoothing is the window mean around each sample") {
  const Late late(0.0);
  const VectorXd smooth = signals::smoothed(view(late.signal), view(late.weight));
  const VectorXd means = signals::window_means(view(late.signal), view(late.weight), {50, 777});
  CHECK_CLOSE(smooth[50], means[0], 1e-15);
  CHECK_CLOSE(smooth[777], means[1], 1e-15);
}

CHECK_CASE("noise: what a torque repeats two samples earlier shows at that lag") {
  std::uint64_t state = 7;
  VectorXd noise(kSamples);
  for (auto& one : noise) {
    state = state * 6364136223846793005ULL + 1442695040888963407ULL;
    one = static_cast<double>(state >> 11U) * 0x1p-53 - 0.5;
  }
  VectorXd torque = VectorXd::Zero(kSamples);
  torque.head(kSamples - 2) = 3.0 * noise.tail(kSamples - 2);
  const MatrixXd found = signals::noise_products(view(noise), view(torque), 60, 9, 4.0);
  CHECK(found.rows() == 60 && found.cols() == 19);
  Index most = 0;
  found.colwise().mean().maxCoeff(&most);
  CHECK_WITH(most == 9 + 2, std::to_string(most));
  CHECK_CLOSE(signals::roughness(view(torque)) / signals::roughness(view(noise)), 3.0, 0.01);
  CHECK(signals::noise_products(view(VectorXd::Ones(kSamples)), view(torque), 60, 9, 4.0).rows() ==
        0);
}

CHECK_CASE("circle: the bits of one angle after the other, of any size") {
  for (const double scale : {1.0, 3e7}) {
    const VectorXd angle = scale * VectorXd::LinSpaced(101, -40.0, 41.0);
    VectorXd cosine(101);
    VectorXd sine(101);
    base::circle(angle.data(), 101, cosine.data(), sine.data());
    for (Index i = 0; i < 101; ++i) {
      CHECK(cosine[i] == base::cos(angle[i]) && sine[i] == base::sin(angle[i]));
    }
  }
}

CHECK_CASE("segments: the sandwich of scores that are corrected for the freedom of the fit") {
  const MatrixXd jacobian = MatrixXd::NullaryExpr(
      50, 3, [](Index i, Index j) { return std::sin(static_cast<double>(i * (j + 2))); });
  const VectorXd residual = jacobian.col(0) + 0.5 * jacobian.col(2);
  MatrixXd whitening(2, 3);
  whitening << 1.0, 0.5, 0.0, -1.0, 0.0, 2.0;
  whitening *= 0.05;  // a segment holds a part of each direction
  const MatrixXd rows = identify::whitened_rows(jacobian, whitening);
  CHECK((rows - jacobian * whitening.transpose()).norm() < 1e-13 * rows.norm());
  const auto found = identify::cluster(rows, residual, whitening, {0, 20, 50});
  MatrixXd covariance = MatrixXd::Zero(3, 3);
  double size = 0.0;
  double squares = 0.0;
  VectorXd even = VectorXd::Zero(3);
  for (const auto& [first, length] : {std::pair<Index, Index>{0, 20}, {20, 30}}) {
    const MatrixXd mine = rows.middleRows(first, length).transpose();
    const MatrixXd shares = mine * mine.transpose();
    const MatrixXd left = MatrixXd::Identity(2, 2) - shares;
    const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(left);
    CHECK(solver.eigenvalues().minCoeff() > 0.05);
    const VectorXd scores = solver.operatorInverseSqrt() * (mine * residual.segment(first, length));
    covariance += whitening.transpose() * scores * scores.transpose() * whitening;
    size += scores.squaredNorm();
    squares += shares.squaredNorm();
    const VectorXd parts = (whitening.transpose() * shares * whitening).diagonal();
    const VectorXd whole = whitening.colwise().squaredNorm();
    even += parts.cwiseQuotient(whole).cwiseAbs2();
  }
  CHECK(found.segments == 2);
  CHECK((found.covariance - covariance).norm() < 1e-12 * covariance.norm());
  CHECK(std::fabs(found.size - size) < 1e-12 * size);
  CHECK((found.freedom - even.cwiseInverse()).norm() < 1e-9);
  CHECK(std::fabs(found.pooled_freedom - 4.0 / squares) < 1e-9 * found.pooled_freedom);
  // Of rows alone nothing is corrected.
  const VectorXd alone = identify::variances_of_rows(rows, residual, whitening);
  const MatrixXd effects = residual.asDiagonal() * (rows * whitening);
  CHECK((alone - effects.colwise().squaredNorm().transpose()).norm() < 1e-12 * alone.norm());
}

CHECK_CASE("triangle: solves for columns only where they are clearly independent") {
  MatrixXd columns = MatrixXd::NullaryExpr(
      60, 4, [](Index i, Index j) { return std::cos(static_cast<double>(i * (j + 1))); });
  columns.col(1) *= 1e9;  // units do not matter
  columns.col(3) = 2.0 * columns.col(0) - 3e-9 * columns.col(1) + 0.1 * columns.col(3);
  const MatrixXd triangle = identify::triangle(columns, nullptr);
  const auto found = identify::solve_independent(triangle, {1, 0}, 3);
  const Eigen::Vector2d scale(1e-9, 1.0);
  const MatrixXd two = columns.leftCols(2).rowwise().reverse();
  const VectorXd expected = two.colPivHouseholderQr().solve(columns.col(3));
  CHECK(found.has_value());
  CHECK(((found->first - expected).cwiseQuotient(scale)).norm() < 1e-10);
  CHECK(std::fabs(found->second - (columns.col(3) - two * expected).norm()) < 1e-10);
  columns.col(2) = columns.col(0) + 1e-8 * columns.col(2);
  CHECK(!identify::solve_independent(identify::triangle(columns, nullptr), {0, 2}, 3));
  columns.col(2).setZero();
  CHECK(!identify::solve_independent(identify::triangle(columns, nullptr), {0, 2}, 3));
}

}  // namespace
}  // namespace jointid::tests
