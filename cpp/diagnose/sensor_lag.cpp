#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "base/elementary.hpp"
#include "diagnose/consistency.hpp"

namespace jointid::diagnose {

namespace {

constexpr Eigen::Index kLength = 4;  // samples a block
constexpr std::size_t kFewest = 50;  // blocks
constexpr double kNotFree = 0.5;     // of the reading's variance is left: other torques act
constexpr double kSingular = 1e-13;  // of the largest eigenvalue

/// Velocity change, integrals of cosine and sine of the angle, duration; the reading's integral.
struct Block {
  std::array<double, 4> motion;
  double reading;
  double middle;
};

/// Cosine and sine of the samples of a block, summed with the trapezoid's weights: one angle is
/// turned by small differences, whose series end early.
void integrate_circle(const Signal& time, const Signal& position, Eigen::Index first,
                      Block& block) {
  const double centre = position[first + kLength / 2];
  const double cosine = base::cos(centre);
  const double sine = base::sin(centre);
  double sum_cosine = 0.0;
  double sum_sine = 0.0;
  for (Eigen::Index k = first; k <= first + kLength; ++k) {
    const double before = k > first ? time[k] - time[k - 1] : 0.0;
    const double after = k < first + kLength ? time[k + 1] - time[k] : 0.0;
    const double weight = 0.5 * (before + after);
    const double turn = position[k] - centre;
    const double z = turn * turn;
    double c = 1.0 - 0.5 * z * (1.0 - z / 12.0 * (1.0 - z / 30.0));
    double s = turn * (1.0 - z / 6.0 * (1.0 - z / 20.0 * (1.0 - z / 42.0)));
    if (z > 0.04) {
      c = base::cos(turn);
      s = base::sin(turn);
    }
    sum_cosine += weight * (cosine * c - sine * s);
    sum_sine += weight * (sine * c + cosine * s);
  }
  block.motion[1] = sum_cosine;
  block.motion[2] = sum_sine;
}

/// Normal equations of N columns, each scaled to unit norm; directions that are none are left out.
template <int N>
class Normal {
 public:
  using Vector = Eigen::Matrix<double, N, 1>;
  void add(const Vector& row, double target) {
    gram_.template triangularView<Eigen::Lower>() += row * row.transpose();
    right_ += target * row;
  }
  void solve() {
    gram_ = gram_.template selfadjointView<Eigen::Lower>();
    Vector scale = gram_.diagonal().cwiseSqrt();
    for (int i = 0; i < N; ++i) scale[i] = scale[i] > 0.0 ? 1.0 / scale[i] : 0.0;
    const Eigen::Matrix<double, N, N> scaled = scale.asDiagonal() * gram_ * scale.asDiagonal();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, N, N>> eigen(scaled);
    Vector inverse = eigen.eigenvalues();
    const double least = kSingular * inverse[N - 1];
    for (int i = 0; i < N; ++i) inverse[i] = inverse[i] > least ? 1.0 / inverse[i] : 0.0;
    const auto& basis = eigen.eigenvectors();
    inverse_ = scale.asDiagonal() * (basis * inverse.asDiagonal() * basis.transpose()) *
               scale.asDiagonal();
    solution = inverse_ * right_;
  }
  [[nodiscard]] double inverse(int i) const { return inverse_(i, i); }
  Vector solution = Vector::Zero();

 private:
  Eigen::Matrix<double, N, N> gram_ = Eigen::Matrix<double, N, N>::Zero();
  Eigen::Matrix<double, N, N> inverse_;
  Vector right_ = Vector::Zero();
};

std::vector<Block> cut(const Signal& time, const Signal& position, const Signal& velocity,
                       const Signal& sensor, double period, const base::Cancel* cancel) {
  std::vector<Block> blocks;
  blocks.reserve(static_cast<std::size_t>(time.size() / kLength + 1));
  const double usual = 1.5 * static_cast<double>(kLength) * period;
  for (Eigen::Index first = 0; first + kLength < time.size(); first += kLength) {
    if (cancel != nullptr && first % 65536 == 0) cancel->check();
    const Eigen::Index last = first + kLength;
    if (!(time[last] - time[first] < usual)) continue;
    Block block{};
    block.motion[0] = velocity[last] - velocity[first];
    integrate_circle(time, position, first, block);
    block.motion[3] = time[last] - time[first];
    for (Eigen::Index k = first; k < last; ++k) {
      block.reading += 0.5 * (sensor[k] + sensor[k + 1]) * (time[k + 1] - time[k]);
    }
    block.middle = 0.5 * (time[first] + time[last]);
    blocks.push_back(block);
  }
  return blocks;
}

}  // namespace

SensorLag sensor_lag(const Signal& time, const Signal& position, const Signal& velocity,
                     const Signal& sensor, double period, const base::Cancel* cancel) {
  const SensorLag none{0.0, std::numeric_limits<double>::infinity()};
  const auto range = extremes(sensor);
  if (range.lowest == range.highest) return none;
  const auto blocks = cut(time, position, velocity, sensor, period, cancel);
  if (blocks.size() < kFewest) return none;
  using Four = Eigen::Matrix<double, 4, 1>;
  using Five = Eigen::Matrix<double, 5, 1>;
  const auto motion = [](const Block& block) {
    return Eigen::Map<const Four>(block.motion.data());
  };
  Normal<4> smooth;
  double mean = 0.0;
  for (const auto& block : blocks) {
    smooth.add(motion(block), block.reading);
    mean += block.reading;
  }
  smooth.solve();
  mean /= static_cast<double>(blocks.size());
  std::vector<double> level(blocks.size());
  double left = 0.0;
  double spread = 0.0;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const double explained = motion(blocks[i]).dot(smooth.solution);
    level[i] = explained / blocks[i].motion[3];
    left += (blocks[i].reading - explained) * (blocks[i].reading - explained);
    spread += (blocks[i].reading - mean) * (blocks[i].reading - mean);
  }
  if (left > kNotFree * spread) return none;
  if (cancel != nullptr) cancel->check();
  const auto row = [&](std::size_t i) {
    const double rate =
        (level[i + 1] - level[i - 1]) / (blocks[i + 1].middle - blocks[i - 1].middle);
    Five result;
    result << motion(blocks[i]), -rate * blocks[i].motion[3];
    return result;
  };
  Normal<5> shifted;
  for (std::size_t i = 1; i + 1 < blocks.size(); ++i) shifted.add(row(i), blocks[i].reading);
  shifted.solve();
  double missed = 0.0;
  for (std::size_t i = 1; i + 1 < blocks.size(); ++i) {
    const double miss = blocks[i].reading - row(i).dot(shifted.solution);
    missed += miss * miss;
  }
  const double variance = missed / static_cast<double>(blocks.size() - 2 - 5);
  return {shifted.solution[4], std::sqrt(variance * shifted.inverse(4))};
}

}  // namespace jointid::diagnose
