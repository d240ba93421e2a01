#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "base/clones.hpp"
#include "base/four.hpp"
#include "base/quantile.hpp"
#include "diagnose/consistency.hpp"

namespace jointid::diagnose {

namespace {

constexpr Eigen::Index kLength = 8;  // samples per block
constexpr std::size_t kFewest = 20;  // blocks
constexpr double kTrim = 9.0;        // medians of the residual
constexpr std::size_t kLanes = 8;

/// Blocks, one column per quantity.
struct Blocks {
  std::vector<double> path;    ///< travel by the velocity
  std::vector<double> change;  ///< change of the velocity
  std::vector<double> moved;   ///< travel by the position
  std::vector<double> kept;    ///< 1 or 0
  Eigen::VectorXd missed;      ///< sizes of the residuals
  [[nodiscard]] std::size_t count() const { return path.size(); }
};

/// Integral of a velocity over a block, by the trapezoidal rule.
JOINTID_CLONES double path_of(const double* time, const double* velocity) {
  base::Four sum;
  base::fill(sum, 0.0);
  for (std::size_t i = 0; i < kLength; i += base::kFour) {
    base::Four speed;
    base::Four next;
    base::Four taken;
    base::Four before;
    base::load(speed, velocity + i);
    base::load(next, velocity + i + 1);
    base::load(taken, time + i + 1);
    base::load(before, time + i);
    base::subtract(taken, before);
    sum = sum + (speed + next) * taken;
  }
  return 0.5 * base::sum_of(sum);
}

/// Least squares of two columns: the second is orthogonalised to the first.
struct Fit {
  double scale = 0.0;
  double lag = 0.0;
  double path = 0.0;   ///< norm of the first column
  double cross = 0.0;  ///< part of the second column along the first
  double own = 0.0;    ///< norm of the rest of the second column

  /// Smaller singular value over the larger one.
  [[nodiscard]] double condition() const {
    const double sum = path * path + cross * cross + own * own;
    const double product = path * own;
    const double root = std::sqrt(std::fmax(0.0, sum * sum - 4.0 * product * product));
    const double largest = 0.5 * (sum + root);
    return largest > 0.0 ? product / largest : 0.0;
  }
};

/// Sum of products of three series, in eight parts.
JOINTID_CLONES double sum_of(const double* weight, const double* one, const double* other,
                             std::size_t count) {
  std::array<double, kLanes> sum{};
  std::size_t i = 0;
  for (; i + kLanes <= count; i += kLanes) {
    for (std::size_t l = 0; l < kLanes; ++l) sum[l] += weight[i + l] * one[i + l] * other[i + l];
  }
  for (std::size_t l = 0; i + l < count; ++l) sum[l] += weight[i + l] * one[i + l] * other[i + l];
  return ((sum[0] + sum[1]) + (sum[2] + sum[3])) + ((sum[4] + sum[5]) + (sum[6] + sum[7]));
}

/// A series minus a multiple of another one.
JOINTID_CLONES void subtract(const double* series, double factor, const double* other,
                             std::size_t count, double* left) {
  for (std::size_t i = 0; i < count; ++i) left[i] = series[i] - factor * other[i];
}

Fit fit(const Blocks& blocks) {
  const std::size_t count = blocks.count();
  const double* weight = blocks.kept.data();
  const double* path = blocks.path.data();
  const double square = sum_of(weight, path, path, count);
  const double product = sum_of(weight, path, blocks.change.data(), count);
  const double along = sum_of(weight, path, blocks.moved.data(), count);
  const double slope = square > 0.0 ? product / square : 0.0;
  const double first = square > 0.0 ? along / square : 0.0;
  Eigen::VectorXd left(static_cast<Eigen::Index>(count));
  Eigen::VectorXd rest(static_cast<Eigen::Index>(count));
  subtract(blocks.change.data(), slope, path, count, left.data());
  subtract(blocks.moved.data(), first, path, count, rest.data());
  const double own = sum_of(weight, left.data(), left.data(), count);
  Fit result;
  result.lag = own > 0.0 ? sum_of(weight, left.data(), rest.data(), count) / own : 0.0;
  result.scale = first - slope * result.lag;
  result.path = std::sqrt(square);
  result.cross = slope * result.path;
  result.own = std::sqrt(own);
  return result;
}

/// Residual of a fit in each block.
JOINTID_CLONES void take_misses(const double* path, const double* change, const double* moved,
                                double scale, double lag, std::size_t count, double* missed) {
  for (std::size_t i = 0; i < count; ++i) {
    missed[i] = std::fabs(moved[i] - (scale * path[i] + lag * change[i]));
  }
}

/// Keeps blocks with a residual within the limit. Returns their number, and the number of changes
/// since the last call. Counted in doubles, which is exact.
struct Trimmed {
  double kept;
  double changed;
};
JOINTID_CLONES Trimmed trim(const double* missed, double limit, std::size_t count, double* kept) {
  double all = 0.0;
  double changed = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const double within = missed[i] <= limit ? 1.0 : 0.0;
    changed += within == kept[i] ? 0.0 : 1.0;
    kept[i] = within;
    all += within;
  }
  return {all, changed};
}

double usual_miss(const Blocks& blocks, std::size_t kept, const base::Cancel* cancel) {
  return base::quantile(
      blocks.count(), kept, 0.5,
      [&](std::size_t i, double& size) {
        size = blocks.missed.data()[i];
        return blocks.kept[i] != 0.0;
      },
      cancel);
}

/// Kept blocks in which the position changes.
std::size_t moving(const Blocks& blocks) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < blocks.count(); ++i) {
    if (blocks.kept[i] != 0.0 && blocks.moved[i] != 0.0) ++count;
  }
  return count;
}

Blocks blocks_of(const Signal& time, const Signal& position, const Signal& velocity, double period,
                 const base::Cancel* cancel) {
  Blocks blocks;
  const auto most = static_cast<std::size_t>(time.size() / kLength + 1);
  for (auto* column : {&blocks.path, &blocks.change, &blocks.moved}) column->reserve(most);
  const double usual = 1.5 * static_cast<double>(kLength) * period;
  for (Eigen::Index first = 0; first + kLength < time.size(); first += kLength) {
    if (cancel != nullptr && first % 65536 == 0) cancel->check();
    const Eigen::Index last = first + kLength;
    if (!(time[last] - time[first] < usual)) continue;
    blocks.path.push_back(path_of(time.data() + first, velocity.data() + first));
    blocks.change.push_back(velocity[last] - velocity[first]);
    blocks.moved.push_back(position[last] - position[first]);
  }
  blocks.kept.assign(blocks.count(), 1.0);
  blocks.missed.resize(static_cast<Eigen::Index>(blocks.count()));
  return blocks;
}

}  // namespace

std::optional<Agreement> velocity_agreement(const Signal& time, const Signal& position,
                                            const Signal& velocity, double period,
                                            const base::Cancel* cancel) {
  Blocks blocks = blocks_of(time, position, velocity, period, cancel);
  if (blocks.count() < kFewest) return std::nullopt;
  std::size_t count = blocks.count();
  Fit found = fit(blocks);
  double left = 0.0;
  for (int round = 0; round < 3; ++round) {  // a spike or a jump must not look like a lag
    take_misses(blocks.path.data(), blocks.change.data(), blocks.moved.data(), found.scale,
                found.lag, blocks.count(), blocks.missed.data());
    const double limit = kTrim * usual_miss(blocks, count, cancel) + 1e-300;
    const auto [kept, changed] =
        trim(blocks.missed.data(), limit, blocks.count(), blocks.kept.data());
    count = static_cast<std::size_t>(kept);
    left = sum_of(blocks.kept.data(), blocks.missed.data(), blocks.missed.data(), blocks.count());
    if (changed == 0.0) break;  // further rounds would be the same
    found = fit(blocks);
  }
  const double precision = static_cast<double>(count) * std::numeric_limits<double>::epsilon();
  // In a joint that is mostly at rest, the trimming removes the motion itself.
  if (moving(blocks) < kFewest || found.condition() <= precision) return std::nullopt;
  const double variance = left / static_cast<double>(count - 2);
  return Agreement{found.scale, found.lag, std::sqrt(variance) / found.own};
}

}  // namespace jointid::diagnose
