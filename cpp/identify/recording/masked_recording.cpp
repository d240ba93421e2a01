#include "identify/recording/masked_recording.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "base/clones.hpp"
#include "base/elementary.hpp"
#include "base/quantile.hpp"

namespace jointid::identify {

namespace {

/// Sum of squared differences of samples `lag` apart, in four lanes with a fixed order.
double squared_changes(const double* v, Eigen::Index count, Eigen::Index lag) {
  std::array<double, 4> sum{};
  Eigen::Index k = 0;
  for (; k + 4 <= count; k += 4) {
    for (Eigen::Index j = 0; j < 4; ++j) {
      const double change = v[k + j + lag] - v[k + j];
      sum[static_cast<std::size_t>(j)] += change * change;
    }
  }
  for (; k < count; ++k) sum[0] += (v[k + lag] - v[k]) * (v[k + lag] - v[k]);
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

constexpr Eigen::Index kMostDecays = 1 << 18;  // samples

JOINTID_CLONES void decays_at(const double* velocity, std::size_t samples, const double* rates,
                              std::size_t count, double vanishing, double* speed, double* values) {
  for (std::size_t i = 0; i < samples; ++i) {
    speed[i] = std::fabs(velocity[i]);
    const double x = speed[i] * speed[i];
    const double kept = x < vanishing ? 1.0 : 0.0;
    for (std::size_t k = 0; k < count; ++k) {
      values[i * count + k] = kept * base::exp_decay(rates[k] * x);
    }
  }
}

}  // namespace

MaskedRecording::MaskedRecording(const RecordingView& recording, UsableIntervals usable)
    : recording_(recording), mask_(std::move(usable)) {
  const auto intervals = static_cast<Eigen::Index>(mask_.usable.size());
  for (Eigen::Index k = 0; k < intervals;) {
    if (mask_.usable[static_cast<std::size_t>(k)] == 0) {
      ++k;
      continue;
    }
    const auto from = mask_.usable.begin() + k;
    const auto stop = std::find(from, mask_.usable.end(), std::uint8_t{0});
    const Eigen::Index length = stop - from;
    runs_.push_back({k, k + length});
    usable_count_ += length;
    k += length;
  }
}

double MaskedRecording::period(const base::Cancel* cancel) const {
  const std::lock_guard lock(mutex_);
  if (period_ > 0.0) return period_;
  const auto& time = recording_.time;
  const auto count = mask_.usable.size();
  period_ = base::quantile(
      count, count, 0.5,
      [&](std::size_t k, double& step) {
        const auto i = static_cast<Eigen::Index>(k);
        step = time[i + 1] - time[i];
        return true;
      },
      cancel);
  return period_;
}

double MaskedRecording::noise(const base::Cancel* cancel) const {
  double noise = 0.0;
  for (const Eigen::Index lag : {1, 2}) {
    const double once = structure(lag, cancel);
    const double twice = structure(2 * lag, cancel);
    noise = std::max(noise, (4.0 * once - twice) / 3.0);
  }
  return noise;
}

double MaskedRecording::structure(Eigen::Index lag, const base::Cancel* cancel) const {
  const std::lock_guard lock(mutex_);
  const auto known = structure_.find(lag);
  if (known != structure_.end()) return known->second;
  constexpr Eigen::Index kBlock = 65536;  // samples between two checks of the cancel flag
  double sum = 0.0;
  Eigen::Index pairs = 0;
  for (const auto& run : runs_) {
    const Eigen::Index count = run.end - run.begin + 1 - lag;
    if (count <= 0) continue;
    pairs += count;
    for (Eigen::Index k = 0; k < count; k += kBlock) {
      if (cancel != nullptr) cancel->check();
      sum += squared_changes(recording_.velocity.data() + run.begin + k,
                             std::min(kBlock, count - k), lag);
    }
  }
  const double mean = pairs > 0 ? sum / static_cast<double>(pairs) : 0.0;
  structure_.emplace(lag, mean);
  return mean;
}

std::shared_ptr<const SampleDecays> MaskedRecording::decays(
    const std::vector<double>& rates) const {
  if (recording_.samples() > kMostDecays || rates.empty()) return nullptr;
  const std::lock_guard lock(mutex_);
  if (decays_ != nullptr && decays_->rates == rates) return decays_;
  const auto samples = static_cast<std::size_t>(recording_.samples());
  auto made = std::make_shared<SampleDecays>();
  made->rates = rates;
  made->speed.resize(recording_.samples());
  made->values.resize(recording_.samples() * static_cast<Eigen::Index>(rates.size()));
  decays_at(recording_.velocity.data(), samples, rates.data(), rates.size(),
            vanishing_at(*std::min_element(rates.begin(), rates.end())), made->speed.data(),
            made->values.data());
  decays_ = std::move(made);
  return decays_;
}

}  // namespace jointid::identify
