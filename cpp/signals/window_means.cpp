#include "signals/window_means.hpp"

#include <algorithm>
#include <array>

#include "base/circle.hpp"
#include "base/clones.hpp"
#include "base/four.hpp"

namespace jointid::signals {

namespace {

using base::Four;
using base::kFour;

/// The weighted sums that start at four neighbouring samples.
[[gnu::always_inline]] inline void smooth_four(const double* signal, const double* weight,
                                               std::size_t width, Four& sum) {
  sum = Four{};
  for (std::size_t k = 0; k < width; ++k) {
    Four samples;
    base::load(samples, signal + k);
    sum = sum + samples * weight[k];
  }
}

/// Sums of `width` samples' weighted values from each sample on, sixteen outputs in parallel.
JOINTID_CLONES void smooth_inside(const double* signal, const double* weight, std::size_t width,
                                  std::size_t count, double* result) {
  std::size_t i = 0;
  for (; i + 4 * kFour <= count; i += 4 * kFour) {
    Four one{}, two{}, three{}, four{};  // an array would live in memory
    for (std::size_t k = 0; k < width; ++k) {
      const double* x = signal + i + k;
      Four a, b, c, d;
      base::load(a, x);
      base::load(b, x + kFour);
      base::load(c, x + 2 * kFour);
      base::load(d, x + 3 * kFour);
      one = one + a * weight[k];
      two = two + b * weight[k];
      three = three + c * weight[k];
      four = four + d * weight[k];
    }
    base::store(result + i, one);
    base::store(result + i + kFour, two);
    base::store(result + i + 2 * kFour, three);
    base::store(result + i + 3 * kFour, four);
  }
  for (; i + kFour <= count; i += kFour) {
    Four sum;
    smooth_four(signal + i, weight, width, sum);
    base::store(result + i, sum);
  }
  for (; i < count; ++i) {
    double sum = 0.0;
    for (std::size_t k = 0; k < width; ++k) sum += weight[k] * signal[i + k];
    result[i] = sum;
  }
}

/// One window's weighted samples, in four parallel sums.
[[gnu::always_inline]] inline void weigh(const double* samples, const double* weight,
                                         std::size_t fours, Four& sum) {
  sum = Four{};
  for (std::size_t k = 0; k < fours; ++k) {
    Four some;
    Four factor;
    base::load(some, samples + kFour * k);
    base::load(factor, weight + kFour * k);
    sum = sum + some * factor;
  }
}

[[gnu::always_inline]] inline void sum_fours(const double* signal, const double* weight,
                                             std::size_t fours, const std::int64_t* first,
                                             std::size_t count, double* sums) {
  std::size_t w = 0;
  for (; w + kFour <= count; w += kFour) {
    std::array<Four, kFour> each;
    for (std::size_t l = 0; l < kFour; ++l) weigh(signal + first[w + l], weight, fours, each[l]);
    Four together;
    base::sums_of(each, together);
    base::store(sums + w, together);
  }
  for (; w < count; ++w) {
    Four sum;
    weigh(signal + first[w], weight, fours, sum);
    sums[w] = base::sum_of(sum);
  }
}

/// The shortest windows are the usual ones, so their loops are unrolled.
JOINTID_CLONES void sum_some(const double* signal, const double* weight, std::size_t fours,
                             const std::int64_t* first, std::size_t count, double* sums) {
  if (fours == 3) {
    sum_fours(signal, weight, 3, first, count, sums);
  } else {
    sum_fours(signal, weight, fours, first, count, sums);
  }
}

}  // namespace

void sum_windows(const double* signal, const double* weight, std::size_t width,
                 const std::int64_t* first, std::size_t count, double* sums) {
  sum_some(signal, weight, width / kFour, first, count, sums);
}

Eigen::VectorXd filled_up(const Eigen::VectorXd& weight) {
  const auto fours = static_cast<Eigen::Index>(kFour);
  Eigen::VectorXd result = Eigen::VectorXd::Zero((weight.size() + fours - 1) / fours * fours);
  result.head(weight.size()) = weight;
  return result;
}

void window_means(const Signal& signal, const Eigen::VectorXd& weight, const Middles& middles,
                  double* means) {
  if (middles.empty()) return;
  const Eigen::VectorXd filled = filled_up(weight);
  const auto width = static_cast<std::size_t>(filled.size());
  const std::int64_t before = weight.size() / 2;
  if (middles.back() - before + filled.size() <= signal.size()) {
    sum_windows(signal.data() - before, filled.data(), width, middles.data(), middles.size(),
                means);
    return;
  }
  Eigen::VectorXd longer = Eigen::VectorXd::Zero(signal.size() + filled.size());
  longer.head(signal.size()) = signal;
  sum_windows(longer.data() - before, filled.data(), width, middles.data(), middles.size(), means);
}

Eigen::VectorXd smoothed(const Signal& signal, const Eigen::VectorXd& weight) {
  const Eigen::Index half = weight.size() / 2;
  const Eigen::Index count = signal.size();
  Eigen::VectorXd result(count);
  const Eigen::Index inside = std::max<Eigen::Index>(0, count - 2 * half);
  if (inside > 0) {
    smooth_inside(signal.data(), weight.data(), static_cast<std::size_t>(weight.size()),
                  static_cast<std::size_t>(inside), result.data() + half);
  }
  const auto beside = [&](Eigen::Index from, Eigen::Index to) {
    for (Eigen::Index i = from; i < to; ++i) {
      double sum = 0.0;
      for (Eigen::Index k = std::max<Eigen::Index>(0, half - i);
           k < weight.size() && i + k - half < count; ++k) {
        sum += weight[k] * signal[i + k - half];
      }
      result[i] = sum;
    }
  };
  beside(0, std::min(half, count));
  beside(std::min(half, count) + inside, count);
  return result;
}

Circle circle_of(const Signal& angle) {
  Circle result{Eigen::VectorXd(angle.size()), Eigen::VectorXd(angle.size())};
  base::circle(angle.data(), static_cast<std::size_t>(angle.size()), result.cosine.data(),
               result.sine.data());
  return result;
}

}  // namespace jointid::signals
