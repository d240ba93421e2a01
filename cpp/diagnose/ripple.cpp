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

constexpr std::size_t kWindows = 2 * base::kFour;  // windows in parallel

/// Examined windows of one part.
struct Looked {
  std::size_t windows = 0;
  double sum = 0.0;        ///< of the mean residuals
  Eigen::VectorXd mean;    ///< mean residuals; the last lanes are filled up
  Eigen::VectorXd cosine;  ///< cosine and sine of half the motor's angle, 0 in the filled lanes
  Eigen::VectorXd sine;
};

/// A multiple, and the multiple before it.
struct Two {
  base::Four now;
  base::Four before;
};

[[gnu::always_inline]] inline void advance(Two& two, const base::Four& factor) {
  base::Four next = factor * two.now;
  base::subtract(next, two.before);
  two.before = two.now;
  two.now = next;
}

/// Adds residual times cosine and sine of `halves` multiples of the windows' angles: two sums per
/// multiple, each in four parts. Each multiple follows from the two before it,
/// cos (h + 1) a = 2 cos a cos h a - cos (h - 1) a. In explicit vectors, because compilers leave
/// these lanes scalar.
JOINTID_CLONES void turn(const double* residual, const double* cosine, const double* sine,
                         std::size_t halves, double* sums) {
  using base::Four;
  std::array<Four, 2> twice;
  std::array<Two, 2> real;
  std::array<Two, 2> imaginary;
  for (std::size_t k = 0; k < 2; ++k) {
    Four one;
    base::load(one, cosine + k * base::kFour);
    twice[k] = one + one;
    base::load(real[k].before, residual + k * base::kFour);
    real[k].now = real[k].before * one;
    base::fill(imaginary[k].before, 0.0);
    base::load(one, sine + k * base::kFour);
    imaginary[k].now = real[k].before * one;
  }
  for (std::size_t h = 0; h < halves; ++h) {
    double* sum = sums + h * 2 * base::kFour;
    base::add_to(sum, real[0].now + real[1].now);
    base::add_to(sum + base::kFour, imaginary[0].now + imaginary[1].now);
    for (std::size_t k = 0; k < 2; ++k) {
      advance(real[k], twice[k]);
      advance(imaginary[k], twice[k]);
    }
  }
}

Looked look_at(const identify::PenaltyParts& parts, std::size_t index, const Eigen::VectorXd& theta,
               double gear_ratio, int halves) {
  const auto part = parts.residuals(index, theta);
  const std::size_t windows = part.windows.size();
  const auto most = static_cast<Eigen::Index>(windows + kWindows);
  Looked looked;
  looked.mean.resize(most);
  looked.cosine.resize(most);
  looked.sine.resize(most);
  Eigen::VectorXd angles(most);
  const double turns = 4.0 * kPi / (gear_ratio * 0.5 * halves);
  const double half = 0.25 * gear_ratio;
  Eigen::Index kept = 0;
  for (std::size_t w = 0; w < windows;) {
    const int run = part.recording_of[w];
    const double* position = parts.recording(run).position.data();
    for (; w < windows && part.recording_of[w] == run; ++w) {  // each is written, most are kept
      const auto row = static_cast<Eigen::Index>(w);
      const double from = position[part.windows[w].begin];
      const double to = position[part.windows[w].end];
      const double mean = part.torque[row] / part.duration[row];
      const bool slow = std::fabs(to - from) < turns;
      looked.mean[kept] = mean;
      angles[kept] = half * (from + to);
      looked.sum += slow ? mean : 0.0;
      kept += slow ? 1 : 0;
    }
  }
  looked.windows = static_cast<std::size_t>(kept);
  base::circle(angles.data(), looked.windows, looked.cosine.data(), looked.sine.data());
  for (auto* each : {&looked.mean, &looked.cosine, &looked.sine}) {
    each->segment(kept, kWindows).setZero();
  }
  return looked;
}

/// Sums without the mean: one row per multiple, the sums with cosine and sine.
struct Sums {
  double square = 0.0;
  Eigen::Matrix<double, Eigen::Dynamic, 2> circle;
};

Sums sums_of(Looked& looked, double mean, int halves) {
  Sums sums;
  auto left = looked.mean.head(static_cast<Eigen::Index>(looked.windows));
  left.array() -= mean;
  sums.square = left.squaredNorm();
  const auto multiples = static_cast<std::size_t>(halves);
  std::vector<double> lanes(multiples * 2 * base::kFour, 0.0);
  for (std::size_t w = 0; w < looked.windows; w += kWindows) {
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
