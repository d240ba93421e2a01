#include "identify/balance/decays.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "base/clones.hpp"
#include "base/elementary.hpp"
#include "base/four.hpp"

namespace jointid::identify {

namespace {

// Several rates in parallel, in the lanes of a vector. Windows hold some ten samples, which is too
// few for lanes along the samples.
constexpr std::size_t kLanes = 8;

JOINTID_CLONES void squares(const double* speed, std::size_t count, double* x) {
  for (std::size_t i = 0; i < count; ++i) x[i] = speed[i] * speed[i];
}

// Arguments are at most some hundreds, so exp needs no special cases. A speed of 0 has the
// logarithm -infinity and the power 0.
JOINTID_CLONES void powers(const double* speed, double exponent, std::size_t count, double* x) {
  for (std::size_t i = 0; i < count; ++i) {
    const double logarithm = base::log_normal(speed[i] > 0.0 ? speed[i] : 1.0);
    x[i] = speed[i] > 0.0 ? base::exp(exponent * logarithm) : 0.0;
  }
}

constexpr std::size_t kNodes = 12;  // largest number in a run; three vectors of four
constexpr std::size_t kDegree = 24;

/// Neighbouring nodes of a window with similar speeds. Taylor's series about the middle of their
/// range sums weight exp(-rate x) over them, with one exponential for all nodes.
struct Run {
  std::size_t begin;
  std::size_t end;
  double middle;
  double half;                              ///< half the range of x
  double least;                             ///< smallest x
  std::array<double, kDegree + 1> moments;  ///< sums of weight ((x - middle) / half)^j / j!
};

constexpr std::array<double, kDegree + 1> kInverseFactorials = [] {
  std::array<double, kDegree + 1> result{1.0};
  for (std::size_t j = 1; j <= kDegree; ++j) result[j] = result[j - 1] / static_cast<double>(j);
  return result;
}();

/// The number of terms that leaves y^(d+1) / (d+1)! below 2^-54, relative to the largest decay of a
/// run; kNone if there are not enough terms.
constexpr std::size_t kNone = kDegree + 1;
std::size_t degree_at(double y) {
  if (y <= 5.8e-3) return 5;
  if (y <= 0.107) return 9;
  if (y <= 0.41) return 13;
  if (y <= 1.1) return 18;
  return y <= 2.5 ? kDegree : kNone;
}

/// The moments up to `degree`, which is the highest degree of any group of rates.
JOINTID_CLONES void take_moments(const double* x, const double* weight, std::size_t degree,
                                 Run& run) {
  std::array<double, kNodes> place{};
  std::array<double, kNodes> power{};
  // A vanishing range has no inverse; its nodes lie in the middle.
  const double scale = run.half > 1e-300 ? 1.0 / run.half : 0.0;
  for (std::size_t i = 0; i < run.end - run.begin; ++i) {
    place[i] = (x[run.begin + i] - run.middle) * scale;
    power[i] = weight[run.begin + i];
  }
  constexpr std::size_t kFours = kNodes / base::kFour;
  std::array<base::Four, kFours> at;
  std::array<base::Four, kFours> now;
  for (std::size_t f = 0; f < kFours; ++f) {
    base::load(at[f], place.data() + f * base::kFour);
    base::load(now[f], power.data() + f * base::kFour);
  }
  for (std::size_t j = 0; j <= degree; ++j) {
    run.moments[j] = base::sum_of(now[0] + now[1] + now[2]) * kInverseFactorials[j];
    for (std::size_t f = 0; f < kFours; ++f) now[f] = now[f] * at[f];
  }
}

/// Divides windows into runs; `first` counts from first[0]. `fastest` is the largest of all rates.
std::vector<Run> runs_of(const std::vector<double>& x, const double* weight,
                         const std::size_t* first, std::size_t windows, double fastest,
                         std::vector<std::size_t>& first_run) {
  std::vector<Run> runs;
  runs.reserve(windows + x.size() / kNodes);
  first_run.reserve(windows + 1);
  for (std::size_t w = 0; w < windows; ++w) {
    first_run.push_back(runs.size());
    const std::size_t end = first[w + 1] - first[0];
    for (std::size_t begin = first[w] - first[0]; begin < end; begin += kNodes) {
      auto& run = runs.emplace_back();
      run.begin = begin;
      run.end = std::min(end, begin + kNodes);
      double low = x[begin];
      double high = low;
      for (std::size_t i = begin + 1; i < run.end; ++i) {
        low = std::min(low, x[i]);
        high = std::max(high, x[i]);
      }
      run.least = low;
      run.half = 0.5 * (high - low);
      run.middle = low + run.half;
      take_moments(x.data(), weight, std::min(degree_at(fastest * run.half), kDegree), run);
    }
  }
  first_run.push_back(runs.size());
  return runs;
}

struct Lanes {
  std::array<double, kLanes> rates;
  std::size_t count;
  double fastest;    ///< the largest |rate|
  double vanishing;  ///< x from which all decays vanish
};

/// The series at y, without a loop: the loop over the lanes must vectorise.
template <std::size_t... Terms>
[[gnu::always_inline]] inline double series(const double* moments, double y,
                                            std::index_sequence<Terms...>) {
  constexpr std::size_t kTerms = sizeof...(Terms);
  double result = moments[kTerms];
  ((result = result * y + moments[kTerms - 1 - Terms]), ...);
  return result;
}

/// Adds a run's sums by the series up to `Degree`.
template <std::size_t Degree>
[[gnu::always_inline]] inline void add_series(const Run& run, const double* rates, double* sum) {
  const double half = run.half;
  const double middle = run.middle;
  const double* moments = run.moments.data();
  for (std::size_t l = 0; l < kLanes; ++l) {
    const double part = series(moments, -rates[l] * half, std::make_index_sequence<Degree>());
    sum[l] += part * base::exp_decay(rates[l] * middle);
  }
}

/// For every window w, sums[w + lane * stride] = sum of weight exp(-rates[lane] x), except for runs
/// with vanishing decays.
JOINTID_CLONES void window_sums(const double* x, const double* weight, const Run* runs,
                                const std::size_t* first_run, std::size_t windows,
                                const Lanes& lanes, double* sums, std::size_t stride) {
  const std::array<double, kLanes> rates = lanes.rates;
  for (std::size_t w = 0; w < windows; ++w) {
    std::array<double, kLanes> sum{};
    for (std::size_t r = first_run[w]; r < first_run[w + 1]; ++r) {
      const Run& run = runs[r];
      if (run.least >= lanes.vanishing) continue;
      const std::size_t degree = degree_at(lanes.fastest * run.half);
      if (degree == 5) {
        add_series<5>(run, rates.data(), sum.data());
      } else if (degree == 9) {
        add_series<9>(run, rates.data(), sum.data());
      } else if (degree == 13) {
        add_series<13>(run, rates.data(), sum.data());
      } else if (degree == 18) {
        add_series<18>(run, rates.data(), sum.data());
      } else if (degree == kDegree) {
        add_series<kDegree>(run, rates.data(), sum.data());
      } else {
        for (std::size_t i = run.begin; i < run.end; ++i) {
          for (std::size_t l = 0; l < kLanes; ++l) {
            sum[l] += weight[i] * base::exp_decay(rates[l] * x[i]);
          }
        }
      }
    }
    for (std::size_t l = 0; l < lanes.count; ++l) sums[w + l * stride] = sum[l];
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
  const double* weight = nodes.weight.data() + begin;
  std::vector<std::size_t> first_run;
  double fastest = 0.0;
  for (const double rate : group.rates) fastest = std::max(fastest, std::fabs(rate));
  const auto runs =
      runs_of(x, weight, nodes.first.data() + windows.begin, rows, fastest, first_run);
  for (std::size_t from = 0; from < group.rates.size(); from += kLanes) {
    if (cancel != nullptr) cancel->check();
    Lanes lanes{{}, std::min(kLanes, group.rates.size() - from), 0.0, 0.0};
    double least = group.rates[from];
    for (std::size_t l = 0; l < lanes.count; ++l) {
      lanes.rates[l] = group.rates[from + l];
      lanes.fastest = std::max(lanes.fastest, std::fabs(lanes.rates[l]));
      least = std::min(least, lanes.rates[l]);
    }
    lanes.vanishing = vanishing_at(least);
    window_sums(x.data(), weight, runs.data(), first_run.data(), rows, lanes,
                columns.col(static_cast<Eigen::Index>(from)).data(),
                static_cast<std::size_t>(columns.outerStride()));
  }
}

}  // namespace jointid::identify
