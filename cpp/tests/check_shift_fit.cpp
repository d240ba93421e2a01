// Delays of signals: window means, the shift of a balance, noise of one signal that another
// repeats.

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "base/circle.hpp"
#include "base/elementary.hpp"
#include "check.hpp"
#include "identify/solve/clustered.hpp"
#include "identify/solve/regression.hpp"
#include "signals/balance_columns.hpp"
#include "signals/repeated_noise.hpp"
#include "signals/shift_fit.hpp"

namespace jointid::tests {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using signals::Signal;

constexpr double kSampling = 1e-3;
constexpr Index kSamples = 6000;
constexpr Index kHalf = 6;

Signal view(const VectorXd& values) {
  return {values.data(), values.size()};
}

double motion(double t, Index column) {
  if (column == 0) return base::cos(9.0 * t);
  return column == 1 ? base::sin(23.0 * t) : 1.0;
}

/// A late signal, its windows and the columns that make its sum.
struct Late {
  VectorXd time = VectorXd::LinSpaced(kSamples, 0.0, kSampling*(kSamples - 1));
  VectorXd signal = VectorXd(kSamples);
  std::unique_ptr<bool[]> usable = std::make_unique<bool[]>(kSamples);
  signals::SmoothWindows windows;
  MatrixXd columns;

  explicit Late(double delay) {
    for (Index i = 0; i < kSamples; ++i) {
      usable[static_cast<std::size_t>(i)] = i % 97 != 0;
      const double t = time[i] - delay;
      signal[i] = 2.0 * motion(t, 0) - 0.7 * motion(t, 1) + 0.3;
    }
    windows = signals::smooth_windows(stretch(), {kHalf, 12, 0, true});
    columns.resize(static_cast<Index>(windows.used.size()), 3);
    for (Index j = 0; j < 3; ++j) {
      VectorXd own(kSamples);
      for (Index i = 0; i < kSamples; ++i) own[i] = motion(time[i], j);
      signals::window_means(view(own), windows.weight, windows.used, columns.col(j).data());
    }
  }
  [[nodiscard]] signals::EvenStretch stretch() const {
    return {view(time), view(signal), view(signal), usable.get(), false};
  }
  [[nodiscard]] signals::ShiftRows rows() const {
    return {{{view(time), view(signal), windows}}, columns, 1, false};
  }
};

CHECK_CASE("shift: a late signal's delay is found, whole, in parts, and from a distant start") {
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

CHECK_CASE("shift: the leading coefficient is that of the columns; too few rows give nothing") {
  Late late(0.0);
  CHECK_CLOSE(signals::leading_coefficient(late.rows()), 2.0, 1e-3);
  const auto found = signals::fit_shift(late.rows(), {0.0, true, 0.0}, nullptr);
  CHECK(found.has_value() && found->leading == signals::leading_coefficient(late.rows()));
  late.windows.used.resize(20);
  late.windows.between.conservativeResize(20);
  late.columns = MatrixXd(late.columns.topRows(20));
  CHECK(!signals::fit_shift(late.rows(), {0.0, true, 0.0}, nullptr).has_value());
}

CHECK_CASE("shift: smoothing is the window mean around each sample, zeros beyond the ends") {
  const Late late(0.0);
  const VectorXd& weight = late.windows.weight;
  const VectorXd smooth = signals::smoothed(view(late.signal), weight);
  VectorXd means(2);
  signals::window_means(view(late.signal), weight, {50, kSamples - kHalf}, means.data());
  CHECK_CLOSE(smooth[50], means[0], 1e-15);
  CHECK_CLOSE(smooth[kSamples - kHalf], means[1], 1e-15);
  CHECK_CLOSE(smooth[0], weight.tail(kHalf).dot(late.signal.head(kHalf)), 1e-15);
}

CHECK_CASE("shift: windows keep clear of unusable samples and changes of direction") {
  const Late late(0.0);
  const auto found = signals::smooth_windows(late.stretch(), {kHalf, 12, 9, true});
  signals::Middles wanted;
  const VectorXd& v = late.signal;
  for (Index middle = kHalf + 14; middle < kSamples - kHalf - 14; middle += kHalf) {
    bool kept = true;
    for (Index i = middle - kHalf; i < middle + kHalf; ++i) kept = kept && i % 97 != 0;
    for (Index i = middle - 8; i <= middle + 9; ++i) kept = kept && v[i] * v[i - 1] > 0.0;
    if (kept) wanted.push_back(middle);
  }
  CHECK(wanted.size() > 100 && found.used == wanted);
  for (Index i = 0; i < found.between.size(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    const bool inner =
        i > 0 && i + 1 < found.between.size() && wanted[at + 1] - wanted[at - 1] == 2 * kHalf;
    CHECK_CLOSE(found.between[i], inner ? 1.0 / (2 * kHalf * kSampling) : 0.0, 1e-9);
  }
  CHECK_CLOSE(signals::mean_rates(view(late.time), found).maxCoeff(), 1.0, 1e-12);
  CHECK_CLOSE(signals::curvature_weight(kHalf, kSampling)
                  .dot(VectorXd::LinSpaced(2 * kHalf + 1, -kHalf * kSampling, kHalf * kSampling)
                           .cwiseAbs2()),
              2.0, 1e-9);
  CHECK_REFUSED(signals::smooth_windows(late.stretch(), {kHalf, 3, 0, true}), "beyond its stretch");
}

CHECK_CASE("shift: columns are the means of possible friction; half of a jump is earlier") {
  const Late late(0.0);
  const auto& windows = late.windows;
  const VectorXd cosine = late.time.array().cos();
  const VectorXd sine = late.time.array().sin();
  signals::ColumnChoice choice{view(cosine), view(sine), true,         {view(late.time)},
                               true,         {},         std::nullopt, 0.5};
  const MatrixXd found = signals::balance_columns(late.stretch(), windows, choice);
  CHECK(found.cols() == 8 + 1 + 16);
  const double limit = 0.4 * late.signal.cwiseAbs().maxCoeff();
  double apart = 0.0;
  for (Index row = 0; row < found.rows(); ++row) {
    const auto middle = windows.used[static_cast<std::size_t>(row)];
    VectorXd sums = VectorXd::Zero(4);
    for (Index k = 0; k < windows.weight.size(); ++k) {
      const Index i = middle - kHalf + 1 + k;
      const double v = late.signal[i];
      const double sign = v > 0.0 ? 1.0 : -1.0;
      const double time = static_cast<double>(i) / (kSamples - 1) - 0.5;
      sums += windows.weight[k] * Eigen::Vector4d(v * v * sine[i], v * std::fabs(v),
                                                  sign * std::exp(-std::pow(4.0 * v / limit, 2.0)),
                                                  v * time);
    }
    const Eigen::Vector4d own(found(row, 7), found(row, 11), found(row, 15), found(row, 24));
    apart = std::max(apart, (own - sums).cwiseAbs().maxCoeff());
  }
  CHECK_CLOSE(apart, 0.0, 1e-12);
  CHECK_CLOSE(found.col(8).minCoeff(), 1.0, 1e-12);
  choice.jumping.emplace(view(late.time));  // by a period at each sample
  const MatrixXd earlier = signals::balance_columns(late.stretch(), windows, choice);
  CHECK_CLOSE((found - earlier).col(0).maxCoeff(), 0.5 * kSampling, 1e-12);
  CHECK_CLOSE((found - earlier).rightCols(24).cwiseAbs().maxCoeff(), 0.0, 0.0);
}

CHECK_CASE("shift: windows are as long as the noise of the acceleration requires") {
  VectorXd signal(kSamples);
  for (Index i = 0; i < kSamples; ++i) signal[i] = motion(kSampling * static_cast<double>(i), 1);
  CHECK(signals::half_length(view(signal), kSampling, false) == 6);
  std::uint64_t state = 11;
  for (auto& one : signal) {
    state = state * 6364136223846793005ULL + 1442695040888963407ULL;
    one += 0.02 * (static_cast<double>(state >> 11U) * 0x1p-53 - 0.5);
  }
  const auto noisy = signals::half_length(view(signal), kSampling, false);
  CHECK_WITH(noisy > 6 && noisy < 56, std::to_string(noisy));
  for (auto& one : signal) one = std::round(one * 20.0) / 20.0;  // a counter's steps
  CHECK(signals::half_length(view(signal), kSampling, true) > noisy);
}

CHECK_CASE("noise: noise that a torque repeats two samples earlier shows at that lag") {
  std::uint64_t state = 7;
  VectorXd noise(kSamples);
  for (auto& one : noise) {
    state = state * 6364136223846793005ULL + 1442695040888963407ULL;
    one = static_cast<double>(state >> 11U) * 0x1p-53 - 0.5;
  }
  VectorXd torque = VectorXd::Zero(kSamples);
  torque.head(kSamples - 2) = 3.0 * noise.tail(kSamples - 2);
  const VectorXd late =
      VectorXd::LinSpaced(kSamples, -4.0, 9.0).array().sin() + 0.1 * noise.reverse().array();
  const MatrixXd found = signals::noise_products(view(noise), view(torque), 60, 9, 4.0);
  CHECK(found.rows() == 60 && found.cols() == 19);
  Index most = 0;
  found.colwise().mean().maxCoeff(&most);
  CHECK_WITH(most == 9 + 2, std::to_string(most));
  CHECK_CLOSE(signals::roughness(view(torque)) / signals::roughness(view(noise)), 3.0, 0.01);
  CHECK(signals::noise_products(view(VectorXd::Ones(kSamples)), view(torque), 60, 9, 4.0).rows() ==
        0);
  torque.head(kSamples - 3) = 2.4 * noise.segment(2, kSamples - 3) + 0.6 * noise.tail(kSamples - 3);
  const auto told = signals::repeated_noise({{view(noise), view(torque)}});
  CHECK(told.has_value());
  if (told) {
    CHECK_CLOSE(told->earlier, 2.2, 0.03);
    CHECK(told->share > 0.9);
    CHECK_CLOSE(told->error, 0.1, 0.01);
  }
  CHECK(!signals::repeated_noise({{view(noise), view(late)}}).has_value());
}

CHECK_CASE("circle: the bits of one angle after the other, for any number of angles") {
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
  struct Regime {
    double scale, from, to;  // largest share of a direction in one segment
  };
  // Small shares are corrected by a series, larger ones by eigenvalues. For a direction that one
  // segment determines alone, a twentieth is assumed to remain.
  for (const auto& [scale, from, to] :
       {Regime{0.05, 0.1, 0.3}, Regime{0.09, 0.6, 0.9}, Regime{0.2, 2.0, 5.0}}) {
    MatrixXd whitening(2, 3);
    whitening << 1.0, 0.5, 0.0, -1.0, 0.0, 2.0;
    whitening *= scale;
    const MatrixXd rows = identify::whitened_rows(jacobian, whitening);
    CHECK((rows - jacobian * whitening.transpose()).norm() < 1e-13 * rows.norm());
    const auto found = identify::cluster(rows, residual, whitening, {0, 20, 50});
    MatrixXd covariance = MatrixXd::Zero(3, 3);
    double size = 0.0;
    double squares = 0.0;
    double largest = 0.0;
    VectorXd even = VectorXd::Zero(3);
    for (const auto& [first, length] : {std::pair<Index, Index>{0, 20}, {20, 30}}) {
      const MatrixXd mine = rows.middleRows(first, length).transpose();
      const MatrixXd shares = mine * mine.transpose();
      const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(shares);
      const VectorXd left = (1.0 - solver.eigenvalues().array()).max(0.05);
      const VectorXd scores = solver.eigenvectors() * left.cwiseSqrt().cwiseInverse().asDiagonal() *
                              solver.eigenvectors().transpose() *
                              (mine * residual.segment(first, length));
      covariance += whitening.transpose() * scores * scores.transpose() * whitening;
      size += scores.squaredNorm();
      squares += shares.squaredNorm();
      largest = std::max(largest, solver.eigenvalues().maxCoeff());
      const VectorXd parts = (whitening.transpose() * shares * whitening).diagonal();
      const VectorXd whole = whitening.colwise().squaredNorm();
      even += parts.cwiseQuotient(whole).cwiseMin(1.0).cwiseAbs2();
    }
    CHECK_WITH(largest > from && largest < to, std::to_string(largest));
    CHECK(found.segments == 2);
    CHECK((found.covariance - covariance).norm() < 1e-12 * covariance.norm());
    CHECK(std::fabs(found.size - size) < 1e-12 * size);
    CHECK((found.freedom - even.cwiseInverse()).norm() < 1e-9);
    CHECK(std::fabs(found.pooled_freedom - 4.0 / squares) < 1e-9 * found.pooled_freedom);
    // Single rows are not corrected.
    const VectorXd alone = identify::variances_of_rows(rows, residual, whitening);
    const MatrixXd effects = residual.asDiagonal() * (rows * whitening);
    CHECK((alone - effects.colwise().squaredNorm().transpose()).norm() < 1e-12 * alone.norm());
  }
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
