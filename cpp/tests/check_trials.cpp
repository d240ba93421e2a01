// Many searches in parallel: each gives the same as alone, for any number of threads, and the poll
// ends them.

#include <cmath>
#include <stdexcept>

#include "check.hpp"
#include "search/random_search.hpp"
#include "search/trials.hpp"

namespace {

using namespace jointid;
using search::GaOptions;
using search::Trial;

// Slow enough by count, with valleys, and evaluated by the pool like the direct sum.
const search::Objective rippled = [](const Eigen::MatrixXd& candidates, Eigen::VectorXd& penalties,
                                     base::Pool& pool) {
  penalties.resize(candidates.cols());
  pool.for_each(static_cast<std::size_t>(candidates.cols()),
                [&](std::size_t begin, std::size_t end) {
                  for (std::size_t k = begin; k < end; ++k) {
                    const auto x = candidates.col(static_cast<Eigen::Index>(k)).array();
                    penalties(static_cast<Eigen::Index>(k)) =
                        x.square().sum() + 1.0 - (5.0 * x).cos().sum() / 4.0;
                  }
                });
};

search::Domain cube() {
  return {Eigen::VectorXd::Constant(4, -3.0), Eigen::VectorXd::Constant(4, 4.0)};
}

std::vector<Trial> trials() {
  std::vector<Trial> result;
  for (int i = 0; i < 12; ++i) {
    Trial trial;
    trial.options.population = 6 + 7 * (i % 3);
    trial.options.generations = 4 + 30 * (i % 4);
    trial.seed = static_cast<std::uint64_t>(100 - i);
    result.push_back(trial);
  }
  return result;
}

}  // namespace

CHECK_CASE("trials: each is the search alone, for 1, 2 and 7 threads") {
  for (const auto searcher : {search::Searcher::genetic, search::Searcher::random}) {
    for (const int threads : {1, 2, 7}) {
      base::Pool pool(threads);
      const auto many = search::minimise_trials(rippled, cube(), trials(), searcher, pool);
      CHECK(many.size() == 12);
      for (std::size_t i = 0; i < many.size(); ++i) {
        const auto [options, seed] = trials()[i];
        base::Pool own(1);
        const auto alone =
            searcher == search::Searcher::genetic
                ? search::minimise_genetic(rippled, cube(), options, seed, 0, own, {})
                : search::minimise_random(rippled, cube(), options, seed, 0, own, {});
        CHECK(many[i].best == alone.best && many[i].penalty == alone.penalty);
        CHECK(many[i].evaluations == alone.evaluations && many[i].stop == alone.stop);
        CHECK(many[i].generations == alone.history.back().number);
      }
    }
  }
}

CHECK_CASE("trials: none are no work, and bad options are refused first") {
  base::Pool pool(2);
  CHECK(search::minimise_trials(rippled, cube(), {}, search::Searcher::genetic, pool).empty());
  auto bad = trials();
  bad.back().options.population = 1;
  CHECK_REFUSED(search::minimise_trials(rippled, cube(), bad, search::Searcher::genetic, pool),
                "population");
}

CHECK_CASE("trials: an exception of the poll ends all of them") {
  struct Enough {};
  auto endless = trials();
  for (auto& trial : endless) {
    trial.options.generations = 10'000'000;
    trial.options.tolerance = 0.0;
  }
  base::Pool pool(2, [] { throw Enough{}; });
  bool ended = false;
  try {
    search::minimise_trials(rippled, cube(), endless, search::Searcher::genetic, pool);
  } catch (const Enough&) {
    ended = true;
  }
  CHECK(ended);
}
