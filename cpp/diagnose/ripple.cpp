#include "diagnose/ripple.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/circle.hpp"
#include "base/clones.hpp"

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

constexpr std::size_t kLanes = 8;  // windows side by side

/// Adds residual times cosine and sine of `halves` multiples of the windows' angles, and the
/// cosines and sines alone: four sums a multiple, each in kLanes parts.
JOINTID_CLONES void turn(const double* mean, const double* cosine, const double* sine,
                         std::size_t halves, double* sums) {
  std::array<double, kLanes> real;
  std::array<double, kLanes> imaginary;
  for (std::size_t j = 0; j < kLanes; ++j) {
    real[j] = cosine[j];
    imaginary[j] = sine[j];
  }
  for (std::size_t h = 0; h < halves; ++h) {
    double* sum = sums + h * 4 * kLanes;
    for (std::size_t j = 0; j < kLanes; ++j) {
      sum[j] += mean[j] * real[j];
      sum[kLanes + j] += mean[j] * imaginary[j];
      sum[2 * kLanes + j] += real[j];
      sum[3 * kLanes + j] += imaginary[j];
      const double turned = real[j] * cosine[j] - imaginary[j] * sine[j];
      imaginary[j] = real[j] * sine[j] + imaginary[j] * cosine[j];
      real[j] = turned;
    }
  }
}

Sums sums_of(const identify::PenaltyParts& parts, std::size_t index, const Eigen::VectorXd& theta,
             double gear_ratio, int halves) {
  const auto part = parts.part(index);
  Eigen::VectorXd residual;
  part.residuals(theta, residual, nullptr);
  const double scale =
      part.residual() == identify::Residual::sensor ? theta[part.gain_index()] : 1.0;
  Sums sums;
  std::vector<double> means;
  std::vector<double> angles;
  for (std::size_t w = 0; w < part.windows().size(); ++w) {
    const auto row = static_cast<Eigen::Index>(w);
    const auto& position = parts.recording(part.recording_of()[w]).position;
    const double from = position[part.windows()[w].begin];
    const double to = position[part.windows()[w].end];
    if (!(std::fabs(to - from) * gear_ratio * 0.5 * halves < 4.0 * kPi)) continue;
    const double mean = scale * residual[row] / part.usable_duration()[row];
    means.push_back(mean);
    angles.push_back(0.5 * gear_ratio * 0.5 * (from + to));
    sums.residual += mean;
    sums.square += mean * mean;
  }
  const std::size_t count = means.size();
  const std::size_t padded = (count + kLanes - 1) / kLanes * kLanes;
  sums.windows = static_cast<std::int64_t>(count);
  means.resize(padded, 0.0);
  std::vector<double> cosine(padded, 0.0);  // what fills the last lanes adds nothing
  std::vector<double> sine(padded, 0.0);
  base::circle(angles.data(), count, cosine.data(), sine.data());
  const auto multiples = static_cast<std::size_t>(halves);
  std::vector<double> lanes(multiples * 4 * kLanes, 0.0);
  for (std::size_t w = 0; w < padded; w += kLanes) {
    turn(means.data() + w, cosine.data() + w, sine.data() + w, multiples, lanes.data());
  }
  sums.circle.setZero(halves, 4);
  const double* lane = lanes.data();
  for (Eigen::Index h = 0; h < halves; ++h) {
    for (Eigen::Index i = 0; i < 4; ++i, lane += kLanes) {
      for (std::size_t j = 0; j < kLanes; ++j) sums.circle(h, i) += lane[j];
    }
  }
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
