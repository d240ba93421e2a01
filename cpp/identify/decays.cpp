#include "identify/decays.hpp"

#include <algorithm>
#include <array>

#include "base/clones.hpp"
#include "base/elementary.hpp"

namespace jointid::identify {

namespace {

constexpr std::size_t kBlock = 1024;  // three buffers stay in the first-level cache

JOINTID_CLONES void squares(const double* speed, std::size_t count, double* x) {
  for (std::size_t i = 0; i < count; ++i) x[i] = speed[i] * speed[i];
}

// Its argument is at most some hundreds, where exp needs no care; a speed of 0 has the logarithm
// -infinity and the power 0.
JOINTID_CLONES void powers(const double* logarithm, double exponent, std::size_t count, double* x) {
  for (std::size_t i = 0; i < count; ++i) x[i] = base::exp(exponent * logarithm[i]);
}

JOINTID_CLONES void weighted_decay(const double* x, const double* weight, double rate,
                                   std::size_t count, double* value) {
  for (std::size_t i = 0; i < count; ++i) value[i] = weight[i] * base::exp(-rate * x[i]);
}

}  // namespace

void integrate_decays(const FrictionNodes& nodes, const Stretch& windows, const DecayRates& group,
                      const base::Cancel* cancel, Eigen::Ref<Eigen::MatrixXd> columns) {
  columns.setZero();
  std::array<double, kBlock> logarithm;
  std::array<double, kBlock> x;
  std::array<double, kBlock> value;
  const bool general = group.exponent != 2.0;
  std::size_t window = windows.begin;
  const std::size_t last = nodes.first[windows.end];
  for (std::size_t begin = nodes.first[windows.begin]; begin < last; begin += kBlock) {
    if (cancel != nullptr) cancel->check();
    const std::size_t count = std::min(kBlock, last - begin);
    const double* speed = nodes.speed.data() + begin;
    const double* weight = nodes.weight.data() + begin;
    if (general) {
      for (std::size_t i = 0; i < count; ++i) logarithm[i] = base::log(speed[i]);
    }
    while (nodes.first[window + 1] <= begin) ++window;
    general ? powers(logarithm.data(), group.exponent, count, x.data())
            : squares(speed, count, x.data());
    Eigen::Index column = 0;
    for (const double rate : group.rates) {
      weighted_decay(x.data(), weight, rate, count, value.data());
      std::size_t at = window;
      for (std::size_t i = 0; i < count;) {
        while (nodes.first[at + 1] <= begin + i) ++at;
        const std::size_t stop = std::min(count, nodes.first[at + 1] - begin);
        double sum = 0.0;
        for (; i < stop; ++i) sum += value[i];
        columns(static_cast<Eigen::Index>(at - windows.begin), column) += sum;
      }
      ++column;
    }
  }
}

}  // namespace jointid::identify
