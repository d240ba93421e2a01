#include "diagnose/ripple.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/elementary.hpp"

namespace jointid::diagnose {

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr std::int64_t kSamples = 1 << 18;

struct Sums {
  std::int64_t windows = 0;
  double residual = 0.0;
  double square = 0.0;
  /// A row a multiple: residual times cosine, times sine; cosine, sine.
  Eigen::Matrix<double, Eigen::Dynamic, 4> circle;
};

Sums sums_of(const identify::PenaltyParts& parts, std::size_t index, const Eigen::VectorXd& theta,
             double gear_ratio, int halves) {
  const auto part = parts.part(index);
  Eigen::VectorXd residual;
  part.residuals(theta, residual, nullptr);
  const double scale =
      part.residual() == identify::Residual::sensor ? theta[part.gain_index()] : 1.0;
  Sums sums;
  sums.circle.setZero(halves, 4);
  constexpr std::size_t kLanes = 8;  // side by side: one turn after the other would wait for itself
  std::array<double, kLanes> mean{};
  std::array<double, kLanes> cosine{};
  std::array<double, kLanes> sine{};
  std::size_t lane = 0;
  const auto turn = [&] {
    std::array<double, kLanes> real = cosine;
    std::array<double, kLanes> imaginary = sine;
    for (int h = 0; h < halves; ++h) {
      std::array<double, 4> sum{};
      for (std::size_t j = 0; j < lane; ++j) {
        sum[0] += mean[j] * real[j];
        sum[1] += mean[j] * imaginary[j];
        sum[2] += real[j];
        sum[3] += imaginary[j];
      }
      for (int i = 0; i < 4; ++i) sums.circle(h, i) += sum[static_cast<std::size_t>(i)];
      for (std::size_t j = 0; j < kLanes; ++j) {
        const double turned = real[j] * cosine[j] - imaginary[j] * sine[j];
        imaginary[j] = real[j] * sine[j] + imaginary[j] * cosine[j];
        real[j] = turned;
      }
    }
    lane = 0;
  };
  for (std::size_t w = 0; w < part.windows().size(); ++w) {
    const auto row = static_cast<Eigen::Index>(w);
    const auto& position = parts.recording(part.recording_of()[w]).position;
    const double from = position[part.windows()[w].begin];
    const double to = position[part.windows()[w].end];
    if (!(std::fabs(to - from) * gear_ratio * 0.5 * halves < 4.0 * kPi)) continue;
    const double angle = 0.5 * gear_ratio * 0.5 * (from + to);
    mean[lane] = scale * residual[row] / part.usable_duration()[row];
    cosine[lane] = base::cos(angle);
    sine[lane] = base::sin(angle);
    ++sums.windows;
    sums.residual += mean[lane];
    sums.square += mean[lane] * mean[lane];
    if (++lane == kLanes) turn();
  }
  turn();
  return sums;
}

}  // namespace

Spectrum ripple_spectrum(const identify::PenaltyParts& parts, const Eigen::VectorXd& theta,
                         double gear_ratio, int halves, base::Pool* pool) {
  const auto stride =
      static_cast<std::size_t>(std::max<std::int64_t>(1, parts.samples() / kSamples));
  std::vector<Sums> each((parts.count() + stride - 1) / stride);
  identify::for_each(each.size(), pool, [&](std::size_t i) {
    each[i] = sums_of(parts, i * stride, theta, gear_ratio, halves);
  });
  Sums all = each[0];
  for (std::size_t i = 1; i < each.size(); ++i) {
    all.windows += each[i].windows;
    all.residual += each[i].residual;
    all.square += each[i].square;
    all.circle += each[i].circle;
  }
  Spectrum result;
  result.windows = all.windows;
  result.multiple = Eigen::VectorXd::Zero(halves);
  if (all.windows == 0) return result;
  const double mean = all.residual / static_cast<double>(all.windows);
  result.power = std::max(0.0, all.square - mean * all.residual);
  for (int h = 0; h < halves; ++h) {
    const double real = all.circle(h, 0) - mean * all.circle(h, 2);
    const double imaginary = all.circle(h, 1) - mean * all.circle(h, 3);
    result.multiple[h] = std::sqrt(real * real + imaginary * imaginary);
  }
  return result;
}

}  // namespace jointid::diagnose
