#pragma once
// Functions to search, with known minima.

#include "base/elementary.hpp"
#include "search/genetic.hpp"

namespace jointid::tests {

using Candidate = Eigen::Ref<const Eigen::VectorXd>;
using Function = double (*)(const Candidate&);

inline search::Objective each(Function function) {
  return
      [function](const Eigen::MatrixXd& candidates, Eigen::VectorXd& penalties, base::Pool& pool) {
        penalties.resize(candidates.cols());
        pool.for_each(static_cast<std::size_t>(candidates.cols()),
                      [&](std::size_t begin, std::size_t end) {
                        for (std::size_t i = begin; i < end; ++i) {
                          const auto column = static_cast<Eigen::Index>(i);
                          penalties[column] = function(candidates.col(column));
                        }
                      });
      };
}

/// One valley, 0 at (0.1, 0.2, ...).
inline double sphere(const Candidate& x) {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const double off = x[i] - 0.1 * static_cast<double>(i + 1);
    sum += off * off;
  }
  return sum;
}

/// Many valleys, 0 at the origin.
inline double rippled(const Candidate& x) {
  double sum = 0.0;
  for (const double value : x) sum += value * value + 3.0 - 3.0 * base::cos(6.0 * value);
  return sum;
}

inline search::Domain cube(Eigen::Index n, double low, double high) {
  return {Eigen::VectorXd::Constant(n, low), Eigen::VectorXd::Constant(n, high)};
}

inline search::GaResult search_for(Function function, const search::Domain& domain,
                                   const search::GaOptions& options, std::uint64_t seed,
                                   int threads = 1, std::uint32_t trial = 0) {
  base::Pool pool(threads);
  return search::minimise_genetic(each(function), domain, options, seed, trial, pool, {});
}

/// Whether best, penalty and the whole history agree bit by bit.
inline bool same_run(const search::GaResult& a, const search::GaResult& b) {
  bool same = a.best == b.best && a.penalty == b.penalty && a.evaluations == b.evaluations &&
              a.stop == b.stop && a.history.size() == b.history.size();
  for (std::size_t i = 0; same && i < a.history.size(); ++i) {
    const auto& one = a.history[i];
    const auto& two = b.history[i];
    same = one.number == two.number && one.best == two.best && one.mean == two.mean &&
           one.diversity == two.diversity && one.evaluations == two.evaluations &&
           one.crossover_probability == two.crossover_probability &&
           one.mutation_probability == two.mutation_probability;
  }
  return same;
}

}  // namespace jointid::tests
