#include "identify/balance/decays.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "base/clones.hpp"
#include "base/elementary.hpp"

namespace jointid::identify {

namespace {

// Rates side by side: the lanes of a vector. Windows hold some ten samples, too few to sum along.
constexpr std::size_t kLanes = 8;

JOINTID_CLONES void squares(const double* speed, std::size_t count, double* x) {
  for (std::size_t i = 0; i < count; ++i) x[i] = speed[i] * speed[i];
}

// Arguments of at most some hundreds, where exp needs no care; a speed of 0 has the logarithm
// -infinity and the power 0.
JOINTID_CLONES void powers(const double* speed, double exponent, std::size_t count, double* x) {
  for (std::size_t i = 0; i < count; ++i) {
    const double logarithm = base::log_normal(speed[i] > 0.0 ? speed[i] : 1.0);
    x[i] = speed[i] > 0.0 ? base::exp(exponent * logarithm) : 0.0;
  }
}

/// For every window w, sums[w * kLanes + lane] = sum of weight exp(-rates[lane] x), but for x of
/// `vanishing` and more. first[w] counts from first[0].
JOINTID_CLONES void window_sums(const double* x, const double* weight, const std::size_t* first,
                                std::size_t windows, const double* rates, double vanishing,
                                double* sums) {
  for (std::size_t w = 0; w < windows; ++w) {
    std::array<double, kLanes> sum{};
    for (std::size_t i = first[w] - first[0]; i < first[w + 1] - first[0]; ++i) {
      if (x[i] >= vanishing) continue;
      for (std::size_t l = 0; l < kLanes; ++l) {
        sum[l] += weight[i] * base::exp_decay(rates[l] * x[i]);
      }
    }
    for (std::size_t l = 0; l < kLanes; ++l) sums[w * kLanes + l] = sum[l];
  }
}

}  // namespace

void integrate_decays(const FrictionNodes& nodes, const Stretch& windows, const DecayRates& group,
                      const base::Cancel* cancel, Eigen::Ref<Eigen::MatrixXd> columns) {
  const std::size_t begin = nodes.first[windows.begin];
  const std::size_t count = nodes.first[windows.end] - begin;
  const std::size_t rows = windows.end - windows.begin;
  std::vector<double> x(count);
  const double* speed = nodes.speed.data() + begin;
  group.exponent == 2.0 ? squares(speed, count, x.data())
                        : powers(speed, group.exponent, count, x.data());
  Eigen::VectorXd sums(static_cast<Eigen::Index>(rows * kLanes));  // not set to zero before
  for (std::size_t from = 0; from < group.rates.size(); from += kLanes) {
    if (cancel != nullptr) cancel->check();
    const std::size_t lanes = std::min(kLanes, group.rates.size() - from);
    std::array<double, kLanes> rates{};
    std::copy_n(group.rates.begin() + static_cast<std::ptrdiff_t>(from), lanes, rates.begin());
    const double least = *std::min_element(rates.begin(), rates.begin() + lanes);
    window_sums(x.data(), nodes.weight.data() + begin, nodes.first.data() + windows.begin, rows,
                rates.data(), vanishing_at(least), sums.data());
    const Eigen::Map<const Eigen::MatrixXd> found(sums.data(), kLanes,
                                                  static_cast<Eigen::Index>(rows));
    columns.middleCols(static_cast<Eigen::Index>(from), static_cast<Eigen::Index>(lanes)) =
        found.topRows(static_cast<Eigen::Index>(lanes)).transpose();
  }
}

}  // namespace jointid::identify
