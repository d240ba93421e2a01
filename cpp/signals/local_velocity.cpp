#include "signals/local_velocity.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "base/quantile.hpp"

namespace jointid::signals {

namespace {

constexpr std::array<Eigen::Index, 13> kHalves{2, 3, 4, 5, 6, 8, 10, 13, 17, 22, 28, 38, 50};
constexpr double kWidth = 1.8;      // half width of an interval, in standard deviations
constexpr double kHarmless = 3e-4;  // of the largest speed
constexpr double kOdd = 3.0;        // times the usual noise: a difference over a wrong time stamp
constexpr double kEven = 2e-3;      // of a period: intervals with a smaller difference are equal
constexpr Eigen::Index kReach = 4;  // samples on either side for the speed
constexpr Eigen::Index kChunk = 4096;

/// Slope in the middle of 2h + 1 evenly spaced samples: sum of weight[j] (q[+j] - q[-j]), j = 1 ..
/// h.
struct Kernel {
  std::vector<double> weight;
  double norm =
      0.0;  ///< standard deviation of the slope times the period, for noise of deviation 1
};

Kernel kernel_of(Eigen::Index half) {
  double second = 0.0;
  double fourth = 0.0;
  double sixth = 0.0;
  for (Eigen::Index j = 1; j <= half; ++j) {
    const auto square = static_cast<double>(j * j);
    second += 2.0 * square;
    fourth += 2.0 * square * square;
    sixth += 2.0 * square * square * square;
  }
  const double determinant = second * sixth - fourth * fourth;
  Kernel kernel;
  for (Eigen::Index j = 1; j <= half; ++j) {
    const auto at = static_cast<double>(j);
    kernel.weight.push_back((sixth * at - fourth * at * at * at) / determinant);
  }
  kernel.norm = std::sqrt(sixth / determinant);
  return kernel;
}

/// Slope, and its standard deviation for noise of deviation 1.
struct Slope {
  double value;
  double spread;
};

/// The cubic through the samples around one sample. Samples are added from the inside out.
class Cubic {
 public:
  Cubic(const Signal& time, const Signal& position, Eigen::Index at, double unit)
      : time_(time), position_(position), at_(at), unit_(unit) {
    moment_[0] = 1.0;
  }

  void add(Eigen::Index k) {
    const double x = (time_[k] - time_[at_]) / unit_;
    const double y = position_[k] - position_[at_];
    double power = 1.0;
    for (std::size_t i = 0; i < moment_.size(); ++i) {
      moment_[i] += power;
      if (i < product_.size()) product_[i] += power * y;
      power *= x;
    }
  }

  /// Powers are scaled by `reach` [units], which keeps the equations well conditioned.
  [[nodiscard]] Slope slope(double reach) const {
    std::array<double, 7> scale;
    scale[0] = 1.0;
    for (std::size_t i = 1; i < scale.size(); ++i) scale[i] = scale[i - 1] / reach;
    std::array<std::array<double, 4>, 4> lower{};
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        double sum = moment_[i + j] * scale[i + j];
        for (std::size_t m = 0; m < j; ++m) sum -= lower[i][m] * lower[j][m];
        if (i == j) {
          if (!(sum > 1e-12 * moment_[i + i] * scale[i + i])) return none();
          lower[i][i] = std::sqrt(sum);
        } else {
          lower[i][j] = sum / lower[j][j];
        }
      }
    }
    const std::array<double, 4> right{product_[0], product_[1] * scale[1], product_[2] * scale[2],
                                      product_[3] * scale[3]};
    const auto value = solve(lower, right);
    const auto spread = solve(lower, {0.0, 1.0, 0.0, 0.0});
    return {value[1] / (reach * unit_), std::sqrt(spread[1]) / (reach * unit_)};
  }

 private:
  static Slope none() { return {0.0, std::numeric_limits<double>::infinity()}; }

  static std::array<double, 4> solve(const std::array<std::array<double, 4>, 4>& lower,
                                     std::array<double, 4> x) {
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j < i; ++j) x[i] -= lower[i][j] * x[j];
      x[i] /= lower[i][i];
    }
    for (std::size_t i = 4; i-- > 0;) {
      for (std::size_t j = i + 1; j < 4; ++j) x[i] -= lower[j][i] * x[j];
      x[i] /= lower[i][i];
    }
    return x;
  }

  const Signal& time_;
  const Signal& position_;
  Eigen::Index at_;
  double unit_;
  std::array<double, 7> moment_{};
  std::array<double, 4> product_{};
};

/// The intersection of intervals, and the slope of the last length that agreed with it.
class Intersection {
 public:
  /// A deviating first value is kept only if no better one follows.
  Intersection(double value, double spread, bool odd) : slope_{value, spread} {
    constexpr double kAny = std::numeric_limits<double>::infinity();
    low_ = odd ? -kAny : value - kWidth * spread;
    high_ = odd ? kAny : value + kWidth * spread;
  }
  /// False if this length does not agree with the shorter ones.
  bool take(double value, double spread) {
    if (!(spread < slope_.spread)) return true;  // a cubic over five samples is not better
    const double low = std::fmax(low_, value - kWidth * spread);
    const double high = std::fmin(high_, value + kWidth * spread);
    if (!(low <= high)) return false;
    low_ = low;
    high_ = high;
    slope_ = {value, spread};
    return true;
  }
  [[nodiscard]] const Slope& slope() const { return slope_; }

 private:
  Slope slope_;
  double low_;
  double high_;
};

/// Standard deviation of the second-order difference, for noise of deviation 1.
double difference_spread(const Signal& time, const Stretch& stretch, Eigen::Index k) {
  if (stretch.end - stretch.begin < 3) return std::numeric_limits<double>::infinity();
  const Eigen::Index middle = std::clamp(k, stretch.begin + 1, stretch.end - 2);
  double square = 0.0;
  for (Eigen::Index j = middle - 1; j <= middle + 1; ++j) {
    // Derivative at sample k of the Lagrange polynomial of sample j.
    const Eigen::Index a = j == middle - 1 ? middle : middle - 1;
    const Eigen::Index b = j == middle + 1 ? middle : middle + 1;
    const double weight =
        ((time[k] - time[a]) + (time[k] - time[b])) / ((time[j] - time[a]) * (time[j] - time[b]));
    square += weight * weight;
  }
  return std::sqrt(square);
}

bool even(const Signal& time, const Stretch& stretch) {
  const double period = (time[stretch.end - 1] - time[stretch.begin]) /
                        static_cast<double>(stretch.end - stretch.begin - 1);
  for (Eigen::Index k = stretch.begin + 1; k < stretch.end; ++k) {
    if (!(std::fabs(time[k] - time[k - 1] - period) < kEven * period)) return false;
  }
  return true;
}

struct Chunk {
  Stretch stretch;
  bool even;
  Eigen::Index begin;
  Eigen::Index end;
};

}  // namespace

LocalVelocity local_velocity(const Signal& time, const Signal& position, const Signal& difference,
                             const std::vector<Stretch>& stretches, const PositionNoise& noise,
                             base::Pool* pool) {
  const Eigen::Index n = time.size();
  LocalVelocity result;
  result.velocity = difference;
  result.noise.setZero(n);
  const auto sigma_at = [&](const Stretch& stretch, Eigen::Index k) {
    const Eigen::Index from = std::max(stretch.begin, k - kReach);
    const Eigen::Index to = std::min(stretch.end - 1, k + kReach);
    const double speed =
        to > from ? (position[to] - position[from]) / (time[to] - time[from]) : 0.0;
    const double moved = noise.timing * speed;
    return std::sqrt(noise.sigma * noise.sigma + moved * moved);
  };
  std::vector<Chunk> chunks;
  for (const auto& stretch : stretches) {
    if (stretch.end - stretch.begin < 3) continue;
    for (Eigen::Index k = stretch.begin; k < stretch.end; ++k) {
      result.noise[k] = sigma_at(stretch, k) * difference_spread(time, stretch, k);
    }
    const bool is_even = even(time, stretch);
    for (Eigen::Index k = stretch.begin; k < stretch.end; k += kChunk) {
      chunks.push_back({stretch, is_even, k, std::min(stretch.end, k + kChunk)});
    }
  }
  const auto count = static_cast<std::size_t>(n);
  const double usual = base::quantile(count, count, 0.5, [&](std::size_t k, double& out) {
    out = result.noise[static_cast<Eigen::Index>(k)];
    return true;
  });
  const double peak = difference.cwiseAbs().maxCoeff();
  if (!(usual > kHarmless * peak) || !std::isfinite(usual)) return result;
  result.refined = true;
  std::vector<Kernel> kernels;
  for (const auto half : kHalves) kernels.push_back(kernel_of(half));
  const auto work = [&](const Chunk& chunk) {
    const auto [begin, end] = chunk.stretch;
    const double period = (time[end - 1] - time[begin]) / static_cast<double>(end - begin - 1);
    for (Eigen::Index k = chunk.begin; k < chunk.end; ++k) {
      const double sigma = sigma_at(chunk.stretch, k);
      Intersection found(difference[k], result.noise[k], !(result.noise[k] <= kOdd * usual));
      const Eigen::Index room = std::min(k - begin, end - 1 - k);
      if (chunk.even && room >= kHalves.back()) {
        for (std::size_t i = 0; i < kHalves.size(); ++i) {
          double sum = 0.0;
          for (Eigen::Index j = 1; j <= kHalves[i]; ++j) {
            sum += kernels[i].weight[static_cast<std::size_t>(j - 1)] *
                   (position[k + j] - position[k - j]);
          }
          if (!found.take(sum / period, sigma * kernels[i].norm / period)) break;
        }
      } else {
        Cubic cubic(time, position, k, period);
        Eigen::Index before = 0;
        for (const auto half : kHalves) {
          for (Eigen::Index j = before + 1; j <= half; ++j) {
            if (k - j >= begin) cubic.add(k - j);
            if (k + j < end) cubic.add(k + j);
          }
          before = half;
          const auto [value, spread] = cubic.slope(static_cast<double>(half));
          if (!found.take(value, sigma * spread)) break;
          if (k - half < begin && k + half >= end) break;
        }
      }
      result.velocity[k] = found.slope().value;
      result.noise[k] = found.slope().spread;
    }
  };
  if (pool == nullptr) {
    for (const auto& chunk : chunks) work(chunk);
  } else {
    pool->for_each(
        chunks.size(),
        [&](std::size_t from, std::size_t to) {
          for (std::size_t i = from; i < to; ++i) {
            pool->cancel().check();
            work(chunks[i]);
          }
        },
        1);
  }
  return result;
}

}  // namespace jointid::signals
