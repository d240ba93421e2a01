#include "search/genetic.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "base/digits.hpp"
#include "base/input_error.hpp"
#include "search/breeder.hpp"

namespace jointid::search {

namespace {

// From this number of individuals on, breeding takes longer than waking the threads.
constexpr Eigen::Index kWorthThreads = 2000;

class Run {
 public:
  Run(const Objective& objective, const Domain& domain, const GaOptions& options,
      std::uint64_t seed, std::uint32_t trial, base::Pool& pool)
      : objective_(objective),
        pool_(pool),
        population_(domain, individuals(options)),
        children_(population_.genes.rows(), population_.genes.cols()),
        islands_(static_cast<std::size_t>(options.islands), Island(options, seed, trial)) {
    state_.options = options;
    state_.seed = seed;
    state_.trial = trial;
    state_.domain = domain;
  }

  void start() {
    islands_.front().breeder.first(population_.genes);
    evaluate();
    record();
  }

  void resume(const GaState& state) {
    state_ = state;
    population_.genes = state.genes;
    population_.penalties = state.penalties;
    require_same_penalty();
    observe();
  }

  void advance() {
    migrate();
    ++state_.generation;
    each_island([&](Eigen::Index island) {
      auto& now = islands_[static_cast<std::size_t>(island)];
      const Eigen::Index offset = island * state_.options.population;
      now.select.prepare(of(population_.penalties, island));
      now.breeder.next(state_.generation, now.probabilities, now.select,
                       population_.genes.middleCols(offset, state_.options.population), offset,
                       children_.middleCols(offset, state_.options.population));
    });
    population_.genes.swap(children_);
    evaluate();
    record();
  }

  [[nodiscard]] bool converged() const {
    const double best = population_.penalties.minCoeff();
    const double spread = population_.penalties.maxCoeff() - best;
    const double tolerance = state_.options.tolerance;
    return tolerance > 0.0 && spread <= tolerance * std::fabs(best);
  }

  /// The run so far, with the population.
  const GaState& state() {
    state_.genes = population_.genes;
    state_.penalties = population_.penalties;
    return state_;
  }
  [[nodiscard]] int generation() const { return state_.generation; }
  [[nodiscard]] const Generation& latest() const { return state_.history.back(); }

 private:
  struct Island {
    Island(const GaOptions& options, std::uint64_t seed, std::uint32_t trial)
        : select(options), breeder(options, seed, trial) {}

    Selector select;
    Breeder breeder;
    double diversity = 0.0;
    Probabilities probabilities{};
  };

  static Eigen::Index individuals(const GaOptions& options) {
    return static_cast<Eigen::Index>(options.population) * options.islands;
  }

  [[nodiscard]] Penalties of(const Eigen::VectorXd& penalties, Eigen::Index island) const {
    return penalties.segment(island * state_.options.population, state_.options.population);
  }

  /// On the calling thread if there is little to do; no bit depends on that.
  template <class Work>
  void each_island(const Work& work) {
    if (islands_.size() == 1 || individuals(state_.options) < kWorthThreads) {
      for (std::size_t island = 0; island < islands_.size(); ++island) {
        work(static_cast<Eigen::Index>(island));
      }
      return;
    }
    pool_.for_each(islands_.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t island = begin; island < end; ++island) {
        work(static_cast<Eigen::Index>(island));
      }
    });
  }

  void evaluate() {
    population_.evaluate(objective_, pool_);
    state_.evaluations += population_.penalties.size();
    observe();
  }

  /// Diversity, and the probabilities that follow from it.
  void observe() {
    for (std::size_t i = 0; i < islands_.size(); ++i) {
      auto& island = islands_[i];
      island.diversity =
          diversity_of(state_.options, of(population_.penalties, static_cast<Eigen::Index>(i)));
      island.probabilities = adapted(state_.options, island.diversity);
    }
  }

  void record() {
    Eigen::Index place = 0;
    const double best = population_.penalties.minCoeff(&place);
    if (state_.history.empty() || best < state_.penalty) {
      state_.penalty = best;
      state_.best = population_.candidate(place);
    }
    Generation now{state_.generation, state_.penalty, population_.penalties.mean(), 0.0, 0.0, 0.0,
                   state_.evaluations};
    for (const auto& island : islands_) {
      now.diversity += island.diversity;
      now.crossover_probability += island.probabilities.crossover;
      now.mutation_probability += island.probabilities.mutation;
    }
    const auto count = static_cast<double>(islands_.size());
    now.diversity /= count;
    now.crossover_probability /= count;
    now.mutation_probability /= count;
    state_.history.push_back(now);
  }

  /// Each island's best, from before the migration, replaces the next island's worst.
  void migrate() {
    const Eigen::Index count = state_.options.population;
    if (islands_.size() == 1 || state_.generation == 0 ||
        state_.generation % state_.options.migration_interval != 0) {
      return;
    }
    std::vector<Eigen::Index> best;
    std::vector<Eigen::Index> worst;
    for (std::size_t i = 0; i < islands_.size(); ++i) {
      const auto island = static_cast<Eigen::Index>(i);
      const auto order = ranked(of(population_.penalties, island));
      best.push_back(island * count + order.front());
      worst.push_back(island * count + order.back());
    }
    // No individual is both best and worst: there are at least four, and the order breaks ties.
    for (std::size_t i = 0; i < islands_.size(); ++i) {
      const auto to = worst[(i + 1) % islands_.size()];
      population_.genes.col(to) = population_.genes.col(best[i]);
      population_.penalties[to] = population_.penalties[best[i]];
    }
  }

  void require_same_penalty() {
    Eigen::VectorXd again(1);
    objective_(state_.best, again, pool_);
    const bool finite = std::isfinite(state_.penalty);
    if (finite ? std::fabs(again[0] - state_.penalty) <= 1e-9 * std::fabs(state_.penalty)
               : !std::isfinite(again[0])) {
      return;
    }
    throw base::InputError("the state's best has penalty " + base::with_digits(state_.penalty, 10) +
                               " in its own run and " + base::with_digits(again[0], 10) +
                               " here; it belongs to another recording, model or windows",
                           "resume");
  }

  const Objective& objective_;
  base::Pool& pool_;
  Population population_;
  Eigen::MatrixXd children_;
  std::vector<Island> islands_;
  GaState state_;
};

}  // namespace

GaResult minimise_genetic(const Objective& objective, const Domain& domain,
                          const GaOptions& options, std::uint64_t seed, std::uint32_t trial,
                          base::Pool& pool, const Observer& observer,
                          const Continuation& continuation) {
  options.validate();
  domain.validate();
  if (continuation.interval < 1) {
    throw std::invalid_argument("checkpoint_interval must be at least 1, got " +
                                std::to_string(continuation.interval));
  }
  bool fresh = continuation.resume == nullptr;
  if (!fresh) require_same_run(*continuation.resume, options, domain, seed, trial);
  Run run(objective, domain, options, seed, trial, pool);
  fresh ? run.start() : run.resume(*continuation.resume);
  GaResult result;
  for (;; fresh = true) {
    if (fresh) {  // the start of a resumed run was reported before
      pool.poll();
      const bool due = run.generation() > 0 && run.generation() % continuation.interval == 0;
      if (continuation.checkpoint && due) continuation.checkpoint(run.state());
      if (observer && observer(run.latest())) {
        result.stop = Stop::observer;
        break;
      }
    }
    if (run.converged()) {
      result.stop = Stop::converged;
      break;
    }
    if (run.generation() == options.generations) break;
    run.advance();
  }
  result.state = run.state();
  result.best = result.state->best;
  result.penalty = result.state->penalty;
  result.history = result.state->history;
  result.evaluations = result.state->evaluations;
  return result;
}

}  // namespace jointid::search
