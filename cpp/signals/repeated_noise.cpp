#include "signals/repeated_noise.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "base/clones.hpp"
#include "base/four.hpp"
#include "base/ranks.hpp"

namespace jointid::signals {

namespace {

using base::Four;
using base::kFour;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kOfMedian = 1.4826;  // standard deviations of normal noise in a median of sizes
constexpr Index kLag = 9;             // samples, the longest delay
constexpr double kClipped = 4.0;      // standard deviations of a difference
// Autocovariance of the third differences of white noise, over its variance.
constexpr std::array<double, 4> kAutocorrelation{1.0, -0.75, 0.3, -0.05};
constexpr Index kNoiseReach = 3;    // lags, to either side
constexpr double kSure = 8.0;       // standard errors of the noise's share in the torque
constexpr double kExplained = 0.9;  // share of the cross-correlation that one delay must explain
constexpr Index kBlocks = 60;   // parts of the recording; their spread gives the standard errors
constexpr Index kUsual = 6000;  // samples that are cut into this number of blocks
constexpr double kAnswer =
    0.1;  // samples: the joint's own response to noise moves the delay by up to this
constexpr std::size_t kSums = 5;              // vectors of lags in parallel
constexpr std::size_t kLags = kSums * kFour;  // lags for which the torque has zeros after its end

JOINTID_CLONES void take_thirds(const double* x, std::size_t count, double* thirds) {
  for (std::size_t i = 0; i < count; ++i) {
    const double change = x[i + 2] - x[i + 1];
    thirds[i] = ((x[i + 3] - x[i + 2]) - change) - (change - (x[i + 1] - x[i]));
  }
}

JOINTID_CLONES void clip(double* values, std::size_t count, double divisor, double most) {
  for (std::size_t i = 0; i < count; ++i) {
    const double change = values[i] / divisor;
    const double low = change < -most ? -most : change;
    values[i] = low > most ? most : low;
  }
}

/// Third differences, followed by `beyond` zeros.
VectorXd thirds_of(const Signal& signal, Index beyond = 0) {
  const Index count = std::max<Index>(0, signal.size() - 3);
  VectorXd result(count + beyond);
  take_thirds(signal.data(), static_cast<std::size_t>(count), result.data());
  result.tail(beyond).setZero();
  return result;
}

/// Standard deviation, from the median of every second difference.
double size_of(const VectorXd& thirds, Index count) {
  if (count == 0) return 0.0;
  VectorXd sizes((count + 1) / 2);  // not set to zero before
  for (Index i = 0; i < sizes.size(); ++i) sizes[i] = std::fabs(thirds[2 * i]);
  const auto size = static_cast<std::size_t>(sizes.size());
  const base::Ranked middle = base::at_rank(sizes.data(), size, (size - 1) / 2);
  return kOfMedian * (size % 2 == 1 ? middle.value : 0.5 * (middle.value + middle.next));
}

/// Third differences over their usual size, clipped, followed by `beyond` zeros.
VectorXd differences(const Signal& signal, double clipped, Index beyond = 0) {
  VectorXd result = thirds_of(signal, beyond);
  const Index count = result.size() - beyond;
  const double size = size_of(result, count);
  if (!(size > 0.0)) return result.setZero();
  clip(result.data(), static_cast<std::size_t>(count), std::max(size, 1e-300), clipped);
  return result;
}

/// Sums of reading times torque, with the torque l samples later: later[l] = torque[i + l].
JOINTID_CLONES void lagged_sums(const double* reading, const double* torque, std::size_t count,
                                double* sums) {
  std::array<Four, kSums> sum{};
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j < kSums; ++j) {
      Four later;
      base::load(later, torque + i + kFour * j);
      sum[j] = sum[j] + later * reading[i];
    }
  }
  for (std::size_t j = 0; j < kSums; ++j) base::store(sums + kFour * j, sum[j]);
}

/// Autocorrelation of the noise at this number of samples.
double alike(Index lag) {
  const auto size = static_cast<std::size_t>(std::abs(lag));
  return size < kAutocorrelation.size() ? kAutocorrelation[size] : 0.0;
}

/// The cross-correlation of a torque that repeats the noise this number of samples earlier, one
/// column each.
MatrixXd taps() {
  return MatrixXd::NullaryExpr(
      2 * kLag + 1, 2 * (kLag - kNoiseReach) + 1,
      [](Index lag, Index place) { return alike(lag - place - kNoiseReach); });
}

/// Products of all pairs, by blocks.
MatrixXd products_of(const std::vector<NoisyPair>& pairs) {
  MatrixXd all(0, 2 * kLag + 1);
  for (const auto& pair : pairs) {
    const Index count = pair.reading.size() - 3;
    const double part =
        static_cast<double>(kBlocks * count) / static_cast<double>(std::max(count, kUsual));
    const Index blocks = std::max<Index>(2, static_cast<Index>(std::nearbyint(part)));
    const MatrixXd own = noise_products(pair.reading, pair.torque, blocks, kLag, kClipped);
    all.conservativeResize(all.rows() + own.rows(), Eigen::NoChange);
    all.bottomRows(own.rows()) = own;
  }
  return all;
}

}  // namespace

double roughness(const Signal& signal) {
  const VectorXd thirds = thirds_of(signal);
  return size_of(thirds, thirds.size());
}

MatrixXd noise_products(const Signal& reading, const Signal& torque, Index blocks, Index longest,
                        double clipped) {
  const Index lags = 2 * longest + 1;
  const auto together = static_cast<Index>(kLags);
  const VectorXd first = differences(reading, clipped);
  const VectorXd second = differences(torque, clipped, together);
  if (!(first.array() != 0.0).any() || !(second.array() != 0.0).any()) return MatrixXd(0, lags);
  const Index length = (first.size() - 2 * longest) / blocks;
  MatrixXd result(blocks, lags);
  std::array<double, kLags> sums;
  for (Index block = 0; block < blocks; ++block) {
    const Index begin = block * length;
    // In column k the torque is `longest` - k samples behind the reading. Columns are filled from
    // the last one.
    for (Index lag = 0; lag < lags; lag += together) {
      lagged_sums(first.data() + longest + begin, second.data() + begin + lag,
                  static_cast<std::size_t>(length), sums.data());
      for (Index l = 0; l < std::min(together, lags - lag); ++l) {
        result(block, lags - 1 - lag - l) =
            sums[static_cast<std::size_t>(l)] / static_cast<double>(length);
      }
    }
  }
  return result;
}

std::optional<RepeatedNoise> repeated_noise(const std::vector<NoisyPair>& pairs) {
  const MatrixXd means = products_of(pairs);
  if (means.rows() < kBlocks / 2) return std::nullopt;
  const VectorXd seen = means.colwise().mean();
  // Each two neighbouring delays share the noise between them. Their normal equations are equal.
  const MatrixXd kernel = taps();
  const VectorXd matched = kernel.transpose() * seen;
  const double own = kernel.col(0).squaredNorm();
  const double common = kernel.col(0).dot(kernel.col(1));
  Eigen::Matrix2d shares_of;  // the inverse of (own, common; common, own)
  shares_of(0, 0) = shares_of(1, 1) = own / (own * own - common * common);
  shares_of(0, 1) = shares_of(1, 0) = -common / (own * own - common * common);
  Index place = 0;
  double most = -1.0;
  for (Index i = 0; i + 1 < matched.size(); ++i) {
    const Eigen::Vector2d pair = matched.segment<2>(i);
    const Eigen::Vector2d both = shares_of * pair;
    const double explained = both.prod() >= 0.0 ? pair.dot(both) : 0.0;
    if (explained > most) {
      place = i;
      most = explained;
    }
  }
  if (most < kExplained * seen.squaredNorm()) return std::nullopt;
  const Eigen::MatrixX2d shares = means * kernel.middleCols<2>(place) * shares_of;
  const Eigen::RowVector2d mean = shares.colwise().mean();
  const Eigen::MatrixX2d apart = shares.rowwise() - mean;
  const auto count = static_cast<double>(shares.rows());
  const Eigen::Matrix2d spread = apart.transpose() * apart / ((count - 1.0) * count);
  const double total = mean.sum();
  if (!(total > kSure * std::sqrt(spread.sum()))) return std::nullopt;
  const double part = mean[1] / total;
  const Eigen::Vector2d slope = Eigen::Vector2d(-part, 1.0 - part) / total;
  const double variance = slope.dot(spread * slope);
  return RepeatedNoise{static_cast<double>(place - kLag + kNoiseReach) + part,
                       std::sqrt(variance + kAnswer * kAnswer), total};
}

}  // namespace jointid::signals
