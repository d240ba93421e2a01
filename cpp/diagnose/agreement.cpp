#include <cmath>
#include <limits>
#include <vector>

#include "base/clones.hpp"
#include "base/four.hpp"
#include "base/quantile.hpp"
#include "diagnose/consistency.hpp"

namespace jointid::diagnose {

namespace {

constexpr Eigen::Index kLength = 8;  // samples a block
constexpr std::size_t kFewest = 20;  // blocks
constexpr double kTrim = 9.0;        // medians of what is missed

struct Row {
  double path;
  double change;
  double moved;
};

/// Of a velocity over a block, by the trapezoid rule.
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

/// Least squares of two columns by orthogonalising the second to the first.
struct Fit {
  double scale = 0.0;
  double lag = 0.0;
  double path = 0.0;   ///< norm of the first column
  double cross = 0.0;  ///< of the second along it
  double own = 0.0;    ///< norm of what is left of the second

  [[nodiscard]] double miss(const Row& row) const {
    return row.moved - (scale * row.path + lag * row.change);
  }
  /// Smaller singular value over the larger one.
  [[nodiscard]] double condition() const {
    const double sum = path * path + cross * cross + own * own;
    const double product = path * own;
    const double root = std::sqrt(std::fmax(0.0, sum * sum - 4.0 * product * product));
    const double largest = 0.5 * (sum + root);
    return largest > 0.0 ? product / largest : 0.0;
  }
};

Fit fit(const std::vector<Row>& rows, const std::vector<char>& kept) {
  double square = 0.0;
  double product = 0.0;
  double along = 0.0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (kept[i] == 0) continue;
    square += rows[i].path * rows[i].path;
    product += rows[i].path * rows[i].change;
    along += rows[i].path * rows[i].moved;
  }
  const double slope = square > 0.0 ? product / square : 0.0;
  const double first = square > 0.0 ? along / square : 0.0;
  double own = 0.0;
  double rest = 0.0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (kept[i] == 0) continue;
    const double left = rows[i].change - slope * rows[i].path;
    own += left * left;
    rest += left * (rows[i].moved - first * rows[i].path);
  }
  Fit result;
  result.lag = own > 0.0 ? rest / own : 0.0;
  result.scale = first - slope * result.lag;
  result.path = std::sqrt(square);
  result.cross = slope * result.path;
  result.own = std::sqrt(own);
  return result;
}

}  // namespace

std::optional<Agreement> velocity_agreement(const Signal& time, const Signal& position,
                                            const Signal& velocity, double period,
                                            const base::Cancel* cancel) {
  std::vector<Row> rows;
  rows.reserve(static_cast<std::size_t>(time.size() / kLength + 1));
  const double usual = 1.5 * static_cast<double>(kLength) * period;
  for (Eigen::Index first = 0; first + kLength < time.size(); first += kLength) {
    if (cancel != nullptr && first % 65536 == 0) cancel->check();
    const Eigen::Index last = first + kLength;
    if (!(time[last] - time[first] < usual)) continue;
    const double path = path_of(time.data() + first, velocity.data() + first);
    rows.push_back({path, velocity[last] - velocity[first], position[last] - position[first]});
  }
  if (rows.size() < kFewest) return std::nullopt;
  std::vector<char> kept(rows.size(), 1);
  std::size_t count = rows.size();
  Fit found;
  double left = 0.0;
  for (int round = 0; round < 3; ++round) {  // a spike or a jump must not look like a lag
    found = fit(rows, kept);
    const double median = base::quantile(
        rows.size(), count, 0.5,
        [&](std::size_t i, double& size) {
          size = std::fabs(found.miss(rows[i]));
          return kept[i] != 0;
        },
        cancel);
    const double limit = kTrim * median + 1e-300;
    count = 0;
    left = 0.0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const double miss = found.miss(rows[i]);
      kept[i] = std::fabs(miss) <= limit ? 1 : 0;
      count += kept[i] != 0 ? 1 : 0;
      left += kept[i] != 0 ? miss * miss : 0.0;
    }
  }
  const Fit last = fit(rows, kept);
  const double precision = static_cast<double>(count) * std::numeric_limits<double>::epsilon();
  if (count < kFewest || last.condition() <= precision) return std::nullopt;
  const double variance = left / static_cast<double>(count - 2);
  return Agreement{found.scale, found.lag, std::sqrt(variance) / last.own};
}

}  // namespace jointid::diagnose
