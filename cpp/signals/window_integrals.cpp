#include "signals/window_integrals.hpp"

namespace jointid::signals {

namespace {

template <class Step>
void sum_steps(const double* values, std::size_t width, const Bounds& windows, double* result,
               Step step) {
  for (Eigen::Index w = 0; w < windows.rows(); ++w, result += width) {
    for (auto k = windows(w, 0); k < windows(w, 1); ++k) {
      const double* here = values + static_cast<std::size_t>(k) * width;
      for (std::size_t i = 0; i < width; ++i) result[i] += step(k, here[i], here[i + width]);
    }
  }
}

/// The same with one value per sample, which needs no inner loop.
template <class Step>
void sum_single(const double* values, const Bounds& windows, double* result, Step step) {
  for (Eigen::Index w = 0; w < windows.rows(); ++w) {
    double sum = 0.0;
    for (auto k = windows(w, 0); k < windows(w, 1); ++k) sum += step(k, values[k], values[k + 1]);
    result[w] = sum;
  }
}

}  // namespace

SideBySide window_integrals(const double* values, std::size_t width, const Signal& weights,
                            const Bounds& windows, Summed summed) {
  SideBySide result = SideBySide::Zero(windows.rows(), static_cast<Eigen::Index>(width));
  const auto sum = [&](const auto& step) {
    width == 1 ? sum_single(values, windows, result.data(), step)
               : sum_steps(values, width, windows, result.data(), step);
  };
  if (summed == Summed::area) {
    sum([&](Eigen::Index k, double from, double to) { return 0.5 * (from + to) * weights[k]; });
  } else {
    sum([&](Eigen::Index k, double from, double to) { return weights[k] > 0.0 ? to - from : 0.0; });
  }
  return result;
}

}  // namespace jointid::signals
