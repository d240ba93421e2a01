#include "diagnose/ripple.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/circle.hpp"
#include "base/clones.hpp"
#include "base/four.hpp"

namespace jointid::diagnose {

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr std::int64_t kSamples = 1 << 18;

constexpr std::size_t kLanes = 2 * base::kFour;  // windows side by side

/// Of the windows of one part that are looked at.
struct Looked {
  std::size_t windows = 0;
  double sum = 0.0;            ///< of the means
  std::vector<double> mean;    ///< of the residual; the last lanes are filled up
  std::vector<double> cosine;  ///< of half the motor's angle, 0 in what fills the lanes
  std::vector<double> sine;
};

/// Adds residual times cosine and sine of `halves` multiples of the windows' angles: two sums a
/// multiple, each in four parts. In explicit vectors, since compilers leave these lanes scalar.
JOINTID_CLONES void turn(const double* residual, const double* cosine, const double* sine,
                         std::size_t halves, double* sums) {
  using base::Four;
  std::array<Four, 2> value;
  std::array<Four, 2> first_real;
  std::array<Four, 2> first_imaginary;
  std::array<Four, 2> real;
  std::array<Four, 2> imaginary;
  for (std::size_t k = 0; k < 2; ++k) {
    base::load(value[k], residual + k * base::kFour);
    base::load(first_real[k], cosine + k * base::kFour);
    base::load(first_imaginary[k], sine + k * base::kFour);
    real[k] = first_real[k];
    imaginary[k] = first_imaginary[k];
  }
  for (std::size_t h = 0; h < halves; ++h) {
    double* sum = sums + h * 2 * base::kFour;
    base::add_to(sum, value[0] * real[0] + value[1] * real[1]);
    base::add_to(sum + base::kFour, value[0] * imaginary[0] + value[1] * imaginary[1]);
    for (std::size_t k = 0; k < 2; ++k) {
      const Four turned = real[k] * first_real[k] - imaginary[k] * first_imaginary[k];
      imaginary[k] = real[k] * first_imaginary[k] + imaginary[k] * first_real[k];
      real[k] = turned;
    }
  }
}

Looked look_at(const identify::PenaltyParts& parts, std::size_t index, const Eigen::VectorXd& theta,
               double gear_ratio, int halves) {
  const auto part = parts.part(index);
  Eigen::VectorXd residual;
  part.residuals(theta, residual, nullptr);
  const double scale =
      part.residual() == identify::Residual::sensor ? theta[part.gain_index()] : 1.0;
  Looked looked;
  std::vector<double> angles;
  const std::size_t windows = part.windows().size();
  looked.mean.reserve(windows + kLanes);
  angles.reserve(windows);
  for (std::size_t w = 0; w < windows; ++w) {
    const auto row = static_cast<Eigen::Index>(w);
    const auto& position = parts.recording(part.recording_of()[w]).position;
    const double from = position[part.windows()[w].begin];
    const double to = position[part.windows()[w].end];
    if (!(std::fabs(to - from) * gear_ratio * 0.5 * halves < 4.0 * kPi)) continue;
    const double mean = scale * residual[row] / part.usable_duration()[row];
    looked.mean.push_back(mean);
    angles.push_back(0.5 * gear_ratio * 0.5 * (from + to));
    looked.sum += mean;
  }
  looked.windows = looked.mean.size();
  const std::size_t padded = (looked.windows + kLanes - 1) / kLanes * kLanes;
  looked.mean.resize(padded, 0.0);
  looked.cosine.resize(padded, 0.0);
  looked.sine.resize(padded, 0.0);
  base::circle(angles.data(), looked.windows, looked.cosine.data(), looked.sine.data());
  return looked;
}

/// Of what is left after the mean: a row a multiple, the sums with cosine and sine.
struct Sums {
  double square = 0.0;
  Eigen::Matrix<double, Eigen::Dynamic, 2> circle;
};

Sums sums_of(Looked& looked, double mean, int halves) {
  Sums sums;
  for (std::size_t w = 0; w < looked.windows; ++w) {
    looked.mean[w] -= mean;
    sums.square += looked.mean[w] * looked.mean[w];
  }
  const auto multiples = static_cast<std::size_t>(halves);
  std::vector<double> lanes(multiples * 2 * base::kFour, 0.0);
  for (std::size_t w = 0; w < looked.mean.size(); w += kLanes) {
    turn(looked.mean.data() + w, looked.cosine.data() + w, looked.sine.data() + w, multiples,
         lanes.data());
  }
  sums.circle.setZero(halves, 2);
  const double* lane = lanes.data();
  for (Eigen::Index h = 0; h < halves; ++h) {
    for (Eigen::Index i = 0; i < 2; ++i, lane += base::kFour) {
      sums.circle(h, i) = (lane[0] + lane[1]) + (lane[2] + lane[3]);
    }
  }
  return sums;
}

}  // namespace

Spectrum ripple_spectrum(const identify::PenaltyParts& parts, const Eigen::VectorXd& theta,
                         double gear_ratio, int halves, base::Pool* pool) {
  const auto stride =
      static_cast<std::size_t>(std::max<std::int64_t>(1, parts.samples() / kSamples));
  std::vector<Looked> looked((parts.count() + stride - 1) / stride);
  identify::for_each(looked.size(), pool, [&](std::size_t i) {
    looked[i] = look_at(parts, i * stride, theta, gear_ratio, halves);
  });
  Spectrum result;
  result.multiple = Eigen::VectorXd::Zero(halves);
  double sum = 0.0;
  for (const auto& part : looked) {
    result.windows += static_cast<std::int64_t>(part.windows);
    sum += part.sum;
  }
  if (result.windows == 0) return result;
  const double mean = sum / static_cast<double>(result.windows);
  std::vector<Sums> each(looked.size());
  identify::for_each(each.size(), pool,
                     [&](std::size_t i) { each[i] = sums_of(looked[i], mean, halves); });
  Eigen::Matrix<double, Eigen::Dynamic, 2> circle = each[0].circle;
  result.power = each[0].square;
  for (std::size_t i = 1; i < each.size(); ++i) {
    result.power += each[i].square;
    circle += each[i].circle;
  }
  result.multiple = circle.rowwise().norm();
  return result;
}

}  // namespace jointid::diagnose
