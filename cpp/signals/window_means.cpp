#include "signals/window_means.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/circle.hpp"
#include "base/clones.hpp"
#include "base/elementary.hpp"

namespace jointid::signals {

namespace {

constexpr std::size_t kLanes = 8;  // samples side by side
constexpr std::size_t kDecays = 6;
constexpr std::size_t kColumns = 10 + kDecays;

/// Sums of `width` samples' weighted values, kLanes outputs side by side.
JOINTID_CLONES void smooth_inside(const double* signal, const double* weight, std::size_t width,
                                  std::size_t count, double* result) {
  std::size_t i = 0;
  for (; i + kLanes <= count; i += kLanes) {
    std::array<double, kLanes> sum{};
    for (std::size_t k = 0; k < width; ++k) {
      for (std::size_t l = 0; l < kLanes; ++l) sum[l] += weight[k] * signal[i + k + l];
    }
    for (std::size_t l = 0; l < kLanes; ++l) result[i + l] = sum[l];
  }
  for (; i < count; ++i) {
    double sum = 0.0;
    for (std::size_t k = 0; k < width; ++k) sum += weight[k] * signal[i + k];
    result[i] = sum;
  }
}

// As numbers: integers are not made into doubles side by side before AVX-512.
constexpr std::array<double, kLanes> kPlaces{0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0};

struct Samples {
  const double* velocity;
  const double* smooth;
  const double* cosine;
  const double* sine;
  double limit;  ///< speed of the longest decay
  double step;   ///< of a time that goes from -1/2 to 1/2
};

/// All columns of one sample after the other.
JOINTID_CLONES void friction_at(const Samples& of, std::size_t count, double* rows) {
  std::array<std::array<double, kLanes>, kColumns> columns;
  std::array<double, kLanes> decay;
  std::array<std::array<double, kLanes>, 4> last{};  // samples that do not fill the lanes
  for (std::size_t begin = 0; begin < count; begin += kLanes) {
    const std::size_t lanes = std::min(kLanes, count - begin);
    std::array<const double*, 4> from{of.velocity + begin, of.smooth + begin, of.cosine + begin,
                                      of.sine + begin};
    for (std::size_t k = 0; lanes < kLanes && k < 4; ++k) {
      for (std::size_t l = 0; l < lanes; ++l) last[k][l] = from[k][l];
      from[k] = last[k].data();
    }
    const auto first = static_cast<double>(begin);
    const double* velocity = from[0];
    const double* smooth = from[1];
    const double* cosine = from[2];
    const double* sine = from[3];
    for (std::size_t l = 0; l < kLanes; ++l) {
      const double v = velocity[l];
      const double speed = std::fabs(v);
      const double sign = (v > 0.0 ? 1.0 : 0.0) - (v < 0.0 ? 1.0 : 0.0);
      const double time = (first + kPlaces[l]) * of.step - 0.5;
      const double ratio = smooth[l] / of.limit;
      decay[l] = base::exp_decay(ratio * ratio);
      columns[0][l] = sign;
      columns[1][l] = v;
      columns[2][l] = v * speed;
      columns[3][l] = speed;
      columns[kColumns - 6][l] = sign * cosine[l];
      columns[kColumns - 5][l] = sign * sine[l];
      columns[kColumns - 4][l] = v * cosine[l];
      columns[kColumns - 3][l] = v * sine[l];
      columns[kColumns - 2][l] = sign * time;
      columns[kColumns - 1][l] = v * time;
    }
    for (std::size_t k = 0; k < kDecays; ++k) {
      for (std::size_t l = 0; l < kLanes; ++l) {
        columns[4 + k][l] = columns[0][l] * decay[l];
        const double square = decay[l] * decay[l];
        decay[l] = square * square;  // of half the speed
      }
    }
    for (std::size_t l = 0; l < lanes; ++l) {
      double* row = rows + (begin + l) * kColumns;
      for (std::size_t k = 0; k < kColumns; ++k) row[k] = columns[k][l];
    }
  }
}

/// Sums of `width` rows, weighted; they lie one after the other.
JOINTID_CLONES void sum_rows(const double* rows, const double* weight, std::size_t width,
                             double* result) {
  std::array<double, kColumns> sum{};
  for (std::size_t k = 0; k < width; ++k) {
    for (std::size_t c = 0; c < kColumns; ++c) sum[c] += weight[k] * rows[k * kColumns + c];
  }
  for (std::size_t c = 0; c < kColumns; ++c) result[c] = sum[c];
}

/// Sums of `width` weighted samples from each of the firsts on. Windows are short: four of them
/// share what a loop costs.
void sum_windows(const double* signal, const double* weight, std::size_t width,
                 const std::int64_t* first, std::size_t count, double* result) {
  std::size_t w = 0;
  for (; w + 4 <= count; w += 4) {
    const double* one = signal + first[w];
    const double* two = signal + first[w + 1];
    const double* three = signal + first[w + 2];
    const double* four = signal + first[w + 3];
    double a = 0.0;
    double b = 0.0;
    double c = 0.0;
    double d = 0.0;
    for (std::size_t k = 0; k < width; ++k) {
      const double factor = weight[k];
      a += factor * one[k];
      b += factor * two[k];
      c += factor * three[k];
      d += factor * four[k];
    }
    result[w] = a;
    result[w + 1] = b;
    result[w + 2] = c;
    result[w + 3] = d;
  }
  for (; w < count; ++w) {
    const double* x = signal + first[w];
    double sum = 0.0;
    for (std::size_t k = 0; k < width; ++k) sum += weight[k] * x[k];
    result[w] = sum;
  }
}

}  // namespace

Eigen::VectorXd window_means(const Signal& signal, const Signal& weight, const Middles& middles) {
  Eigen::VectorXd result(static_cast<Eigen::Index>(middles.size()));
  sum_windows(signal.data() - weight.size() / 2, weight.data(),
              static_cast<std::size_t>(weight.size()), middles.data(), middles.size(),
              result.data());
  return result;
}

Eigen::VectorXd smoothed(const Signal& signal, const Signal& weight) {
  const auto half = static_cast<std::size_t>(weight.size()) / 2;
  const auto count = static_cast<std::size_t>(signal.size());
  Eigen::VectorXd padded = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(count + 2 * half));
  padded.segment(static_cast<Eigen::Index>(half), signal.size()) = signal;
  Eigen::VectorXd result(signal.size());
  smooth_inside(padded.data(), weight.data(), 2 * half + 1, count, result.data());
  return result;
}

Circle circle_of(const Signal& angle) {
  Circle result{Eigen::VectorXd(angle.size()), Eigen::VectorXd(angle.size())};
  base::circle(angle.data(), static_cast<std::size_t>(angle.size()), result.cosine.data(),
               result.sine.data());
  return result;
}

Eigen::MatrixXd friction_means(const Rubbing& rubbing, double longest, const Signal& weight,
                               const Middles& middles) {
  const auto count = static_cast<std::size_t>(rubbing.velocity.size());
  Eigen::MatrixXd result(static_cast<Eigen::Index>(middles.size()),
                         static_cast<Eigen::Index>(kColumns));
  if (middles.empty()) return result;
  const double peak = std::max(rubbing.velocity.cwiseAbs().maxCoeff(), 1e-300);
  const Samples samples{
      rubbing.velocity.data(), rubbing.smooth.data(),
      rubbing.cosine.data(),   rubbing.sine.data(),
      longest * peak,          1.0 / static_cast<double>(std::max<std::size_t>(1, count - 1))};
  Eigen::VectorXd rows(static_cast<Eigen::Index>(count * kColumns));  // not set to zero before
  friction_at(samples, count, rows.data());
  const auto width = static_cast<std::size_t>(weight.size());
  std::array<double, kColumns> sum;
  for (std::size_t w = 0; w < middles.size(); ++w) {
    const auto first = static_cast<std::size_t>(middles[w]) - width / 2;
    sum_rows(rows.data() + first * kColumns, weight.data(), width, sum.data());
    for (std::size_t c = 0; c < kColumns; ++c) {
      result(static_cast<Eigen::Index>(w), static_cast<Eigen::Index>(c)) = sum[c];
    }
  }
  return result;
}

}  // namespace jointid::signals
