#include "signals/repeated_noise.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/clones.hpp"

namespace jointid::signals {

namespace {

constexpr double kOfMedian = 1.4826;  // standard deviations of normal noise in a median of sizes
constexpr std::size_t kLanes = 8;     // lags side by side

double third(const double* x) {
  return ((x[3] - x[2]) - (x[2] - x[1])) - ((x[2] - x[1]) - (x[1] - x[0]));
}

/// Third differences over their usual size, clipped, and `beyond` zeros.
Eigen::VectorXd differences(const Signal& signal, double clipped, Eigen::Index beyond = 0) {
  const Eigen::Index count = std::max<Eigen::Index>(0, signal.size() - 3);
  Eigen::VectorXd result(count + beyond);
  result.tail(beyond).setZero();
  const double size = roughness(signal);
  if (!(size > 0.0)) return result.setZero();
  const double* x = signal.data();
  const double divisor = std::max(size, 1e-300);
  for (Eigen::Index i = 0; i < count; ++i) {
    const double change = third(x + i) / divisor;
    result[i] = std::min(std::max(change, -clipped), clipped);
  }
  return result;
}

/// Sums of reading times torque, the torque kLanes samples in turn: later[l] = torque[i + l].
JOINTID_CLONES void lagged_sums(const double* reading, const double* torque, std::size_t count,
                                double* sums) {
  std::array<double, kLanes> sum{};
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t l = 0; l < kLanes; ++l) sum[l] += reading[i] * torque[i + l];
  }
  for (std::size_t l = 0; l < kLanes; ++l) sums[l] = sum[l];
}

}  // namespace

double roughness(const Signal& signal) {
  const Eigen::Index differences = signal.size() - 3;
  if (differences <= 0) return 0.0;
  Eigen::VectorXd sizes((differences + 1) / 2);  // not set to zero before
  const double* x = signal.data();
  for (Eigen::Index i = 0; i < sizes.size(); ++i) sizes[i] = std::fabs(third(x + 2 * i));
  const auto middle = sizes.begin() + sizes.size() / 2;
  std::nth_element(sizes.begin(), middle, sizes.end());
  if (sizes.size() % 2 == 1) return kOfMedian * *middle;
  return kOfMedian * 0.5 * (*middle + *std::max_element(sizes.begin(), middle));
}

Eigen::MatrixXd noise_products(const Signal& reading, const Signal& torque, Eigen::Index blocks,
                               Eigen::Index longest, double clipped) {
  const Eigen::Index lags = 2 * longest + 1;
  const auto lanes = static_cast<Eigen::Index>(kLanes);
  const Eigen::VectorXd first = differences(reading, clipped);
  const Eigen::VectorXd second = differences(torque, clipped, lanes);
  if (!(first.array() != 0.0).any() || !(second.array() != 0.0).any()) {
    return Eigen::MatrixXd(0, lags);
  }
  const Eigen::Index length = (first.size() - 2 * longest) / blocks;
  Eigen::MatrixXd result(blocks, lags);
  std::array<double, kLanes> sums;
  for (Eigen::Index block = 0; block < blocks; ++block) {
    const Eigen::Index begin = block * length;
    // Column k has the torque `longest` - k samples behind the reading: columns from the last one.
    for (Eigen::Index lag = 0; lag < lags; lag += lanes) {
      lagged_sums(first.data() + longest + begin, second.data() + begin + lag,
                  static_cast<std::size_t>(length), sums.data());
      for (Eigen::Index l = 0; l < std::min(lanes, lags - lag); ++l) {
        result(block, lags - 1 - lag - l) =
            sums[static_cast<std::size_t>(l)] / static_cast<double>(length);
      }
    }
  }
  return result;
}

}  // namespace jointid::signals
