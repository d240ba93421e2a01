#include "signals/balance_columns.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/clones.hpp"
#include "base/elementary.hpp"
#include "base/four.hpp"

namespace jointid::signals {

namespace {

using base::Four;
using base::kFour;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kLongestDecay =
    0.4;  // longest Stribeck speed over the peak speed; each next one is half
constexpr std::size_t kDecays = 6;
constexpr std::size_t kFriction = 10 + kDecays;
constexpr std::size_t kKept = 512;  // samples per block, for which friction is stored by columns
static_assert(2 * kLongestHalf + 4 <= kKept);
constexpr std::size_t kStride =
    kKept + 8;                      // padding: columns 4096 bytes apart share a few cache lines
constexpr double kNothing = 1e-75;  // smallest decay with a fourth power that is a normal number
constexpr std::int64_t kSmoothFrom = 7;  // samples in half a window: shorter windows smooth little

struct Samples {
  const double* velocity;
  const double* smooth;  ///< the velocity for the decays
  const double* cosine;
  const double* sine;
  double limit;  ///< speed of the longest decay
  double step;   ///< time scaled to -1/2 to 1/2
};

/// All columns of `count` samples from `first` on, in whole fours.
JOINTID_CLONES void friction_at(const Samples& of, std::size_t first, std::size_t count,
                                double* __restrict columns) {
  const double* __restrict velocity = of.velocity + first;
  const double* __restrict smooth = of.smooth + first;
  const double limit = of.limit;
  double* decays = columns + 4 * kStride;
  for (std::size_t i = 0; i < count; ++i) {
    columns[i] = (velocity[i] > 0.0 ? 1.0 : 0.0) - (velocity[i] < 0.0 ? 1.0 : 0.0);
  }
  for (std::size_t i = 0; i < count; ++i) {
    const double ratio = smooth[i] / limit;
    decays[i] = base::exp_decay(ratio * ratio);
  }
  const auto start = static_cast<double>(first);
  Four place{start, start + 1.0, start + 2.0, start + 3.0};
  Four half;
  Four next;
  base::fill(half, 0.5);
  base::fill(next, 4.0);
  for (std::size_t i = 0; i < count; i += kFour) {
    Four sign;
    Four v;
    Four cosine;
    Four sine;
    Four decay;
    base::load(sign, columns + i);
    base::load(v, velocity + i);
    base::load(cosine, of.cosine + first + i);
    base::load(sine, of.sine + first + i);
    base::load(decay, decays + i);
    Four speed = v;
    base::take_size(speed);
    const Four time = place * of.step - half;
    place = place + next;
    double* to = columns + i;
    const auto put = [&](std::size_t column, const Four& value) {
      base::store(to + column * kStride, value);
    };
    put(1, v);
    put(2, v * speed);
    put(3, speed);
    for (std::size_t k = 0; k < kDecays; ++k) {
      base::leave_out_small(decay, kNothing);
      put(4 + k, sign * decay);
      const Four square = decay * decay;
      decay = square * square;  // decay for half the speed
    }
    put(kFriction - 6, sign * cosine);
    put(kFriction - 5, sign * sine);
    put(kFriction - 4, v * cosine);
    put(kFriction - 3, v * sine);
    put(kFriction - 2, sign * time);
    put(kFriction - 1, v * time);
  }
}

/// Window means of friction: kFriction columns.
void friction_means(const EvenStretch& stretch, const SmoothWindows& windows,
                    const ColumnChoice& choice, Eigen::Ref<MatrixXd> means) {
  const auto& used = windows.used;
  const auto count = static_cast<std::int64_t>(stretch.velocity.size());
  const std::int64_t half = windows.weight.size() / 2;
  VectorXd smooth;
  if (stretch.derived || half + 1 >= kSmoothFrom)
    smooth = smoothed(stretch.velocity, windows.weight);
  const VectorXd weight = filled_up(windows.weight);
  const double peak = std::max(stretch.velocity.cwiseAbs().maxCoeff(), 1e-300);
  const Samples samples{
      stretch.velocity.data(), smooth.size() > 0 ? smooth.data() : stretch.velocity.data(),
      choice.cosine.data(),    choice.sine.data(),
      kLongestDecay * peak,    1.0 / static_cast<double>(std::max<std::int64_t>(1, count - 1))};
  constexpr auto kMost = static_cast<std::int64_t>(kKept);
  VectorXd columns(static_cast<Index>(kFriction * kStride));
  for (std::size_t w = 0; w < used.size();) {
    const std::int64_t first = used[w] - half;
    std::size_t end = w + 1;
    while (end < used.size() && used[end] - half + weight.size() - first <= kMost) ++end;
    const auto needed = static_cast<std::size_t>(used[end - 1] - half + weight.size() - first);
    const std::size_t whole = (needed + kFour - 1) / kFour * kFour;  // the stretch ends later
    friction_at(samples, static_cast<std::size_t>(first), whole, columns.data());
    for (std::size_t c = 0; c < kFriction; ++c) {
      sum_windows(columns.data() + static_cast<Index>(c * kStride) - (first + half), weight.data(),
                  static_cast<std::size_t>(weight.size()), used.data() + w, end - w,
                  means.col(static_cast<Index>(c)).data() + w);
    }
    w = end;
  }
}

}  // namespace

MatrixXd balance_columns(const EvenStretch& stretch, const SmoothWindows& windows,
                         const ColumnChoice& choice) {
  const auto rows = static_cast<Index>(windows.used.size());
  const auto own = static_cast<Index>(choice.own.size() + choice.own_friction.size());
  const Index friction = choice.friction ? static_cast<Index>(kFriction) : 0;
  MatrixXd result(rows, 4 + (choice.varying ? 4 : 0) + friction + own);
  Index to = 0;
  const auto mean = [&](const Signal& signal, const VectorXd& weight) {
    window_means(signal, weight, windows.used, result.col(to++).data());
  };
  if (stretch.derived) {
    const auto half = (windows.weight.size() + 1) / 2;
    mean(stretch.position, curvature_weight(half, stretch.period()));
  } else {
    mean(stretch.velocity, windows.slope);
  }
  if (choice.jumping) {
    // Differences between each sample and the previous one; differences of the weights give the
    // same.
    const VectorXd& weight = windows.weight;
    VectorXd change(weight.size() + 1);
    change.head(weight.size()) = -weight;
    change[weight.size()] = 0.0;
    change.tail(weight.size()) += weight;
    VectorXd jump(rows);
    window_means(*choice.jumping, change, windows.used, jump.data());
    result.col(0) -= choice.answer * jump;
  }
  mean(choice.cosine, windows.weight);
  mean(choice.sine, windows.weight);
  result.col(to++).setOnes();
  if (choice.varying) {
    const Signal& v = stretch.velocity;
    VectorXd along = v.cwiseProduct(choice.cosine);
    VectorXd across = v.cwiseProduct(choice.sine);
    mean({along.data(), along.size()}, windows.slope);
    mean({across.data(), across.size()}, windows.slope);
    along.array() *= v.array();
    across.array() *= v.array();
    mean({along.data(), along.size()}, windows.weight);
    mean({across.data(), across.size()}, windows.weight);
  }
  for (const auto& each : choice.own) mean(each, windows.slope);
  if (choice.friction) {
    friction_means(stretch, windows, choice, result.middleCols(to, friction));
    to += friction;
  }
  for (const auto& each : choice.own_friction) mean(each, windows.slope);
  return result;
}

VectorXd mean_rates(const Signal& signal, const SmoothWindows& windows) {
  VectorXd result(static_cast<Index>(windows.used.size()));
  window_means(signal, windows.slope, windows.used, result.data());
  return result;
}

}  // namespace jointid::signals
