// The penalty and the genetic algorithm of the thesis's MATLAB listing, statement by statement in
// scalar C++, as a plain translation compiled with -O2. Only those computations are outside the
// loops that are outside in the listing itself.
//
//   genetic RECORDING POPULATION GENERATIONS SEED   ->  "seconds candidates best_penalty"
//
// RECORDING holds time, position, velocity, torque and sensor, one sample per line.

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <random>
#include <vector>

namespace {

constexpr int kGenes = 6;  // coulomb, static, stribeck, viscous, offset, gain
using Chromosome = std::array<double, kGenes>;
constexpr Chromosome kLow = {0, 0, 0, 0, -30, 0.1};
constexpr Chromosome kHigh = {50, 40, 200, 40, 30, 5};

struct Recording {
  std::vector<double> time, position, velocity, torque, sensor;
};

struct Individual {
  Chromosome genes{};
  double fitness = 0;  // the penalty, then its distance from the sum of all
};

double sign(double x) {
  return x > 0 ? 1.0 : (x < 0 ? -1.0 : 0.0);
}

// Running integral of the sensor's reading.
std::vector<double> sensor_integral(const Recording& r) {
  std::vector<double> sum(r.time.size(), 0.0);
  for (std::size_t i = 1; i < r.time.size(); ++i) {
    const double dt = r.time[i] - r.time[i - 1];
    sum[i] = sum[i - 1] + (r.sensor[i] + r.sensor[i - 1]) / 2 * dt;
  }
  return sum;
}

// The same integral from the model.
std::vector<double> model_integral(const Chromosome& p, const Recording& r) {
  const double inertia = 101.0 * 101.0 * 0.0002472;
  std::vector<double> sum(r.time.size(), 0.0);
  for (std::size_t i = 1; i < r.time.size(); ++i) {
    const double dt = r.time[i] - r.time[i - 1];
    const double now = r.velocity[i];
    const double before = r.velocity[i - 1];
    const double viscous = p[3] * (r.position[i] - r.position[i - 1]);
    const double coulomb = p[0] * dt;
    const double decay =
        std::exp(-std::fabs(p[2] * now * now)) + std::exp(-std::fabs(p[2] * before * before));
    const double exponential = p[1] * decay / 2 * dt;
    const double friction = viscous + (coulomb + exponential) * sign(now);
    const double dynamic = inertia * (now - before);
    const double input = (r.torque[i] + r.torque[i - 1]) / 2 * dt;
    sum[i] = (input - dynamic - friction - p[4] * dt) / p[5] + sum[i - 1];
  }
  return sum;
}

// The listing integrates the sensor again for every candidate.
double penalty(const Chromosome& p, const Recording& r) {
  const std::vector<double> sensed = sensor_integral(r);
  const std::vector<double> modelled = model_integral(p, r);
  double sum = 0;
  for (std::size_t i = 0; i < sensed.size(); ++i) {
    sum += (sensed[i] - modelled[i]) * (sensed[i] - modelled[i]);
  }
  return sum;
}

class Search {
 public:
  Search(const Recording& recording, int population, int generations, unsigned seed)
      : recording_(recording), size_(population), last_(generations), engine_(seed) {}

  double run() {
    std::vector<Individual> population(static_cast<std::size_t>(size_));
    for (auto& one : population) {
      for (std::size_t m = 0; m < kGenes; ++m) {
        one.genes[m] = kLow[m] + uniform() * (kHigh[m] - kLow[m]);
      }
    }
    double best = evaluate(population);
    for (int generation = 2; generation <= last_; ++generation) {
      population = breed(population, generation);
      best = std::min(best, evaluate(population));
    }
    return best;
  }

  long candidates = 0;

 private:
  double uniform() { return std::uniform_real_distribution<double>(0, 1)(engine_); }

  // Penalties, then fitness = sum - penalty; returns the least penalty.
  double evaluate(std::vector<Individual>& population) {
    penalty_sum_ = 0;
    for (auto& one : population) {
      one.fitness = penalty(one.genes, recording_);
      penalty_sum_ += one.fitness;
      ++candidates;
    }
    mean_ = penalty_sum_ / size_;
    fitness_sum_ = 0;
    most_ = 0;
    for (auto& one : population) {
      one.fitness = (1 - one.fitness / penalty_sum_) * penalty_sum_;
      fitness_sum_ += one.fitness;
      most_ = std::max(most_, one.fitness);
    }
    return penalty_sum_ - most_;
  }

  std::size_t select(const std::vector<Individual>& population) {
    const double drawn = uniform() * fitness_sum_;
    double sum = 0;
    for (std::size_t j = 0; j < population.size(); ++j) {
      sum += population[j].fitness;
      if (sum >= drawn) return j;
    }
    return population.size() - 1;
  }

  std::vector<Individual> breed(const std::vector<Individual>& old, int generation) {
    const double alike = (penalty_sum_ - most_) / mean_;
    const double share = std::clamp((alike - 0.7) / (0.95 - 0.7), 0.0, 1.0);
    const double cross = 0.9 - share * (0.9 - 0.8);
    const double mutate = 0.03 + share * (0.15 - 0.03);
    std::vector<Individual> next(old.size());
    for (std::size_t i = 0; i + 1 < old.size(); i += 2) {
      const Individual& a = old[select(old)];
      const Individual& b = old[select(old)];
      if (uniform() <= cross) {
        for (std::size_t n = 0; n < kGenes; ++n) {
          sbx(a.genes[n], b.genes[n], n, next[i], next[i + 1]);
        }
      } else {
        next[i].genes = old[i].genes;
        next[i + 1].genes = old[i + 1].genes;
      }
    }
    for (auto& one : next) {
      if (uniform() <= mutate) mutation(one.genes, generation);
    }
    return next;
  }

  // The smaller parent's gene goes first; children above the upper bound are set to it, negative
  // ones change sign.
  void sbx(double a, double b, std::size_t n, Individual& first, Individual& second) {
    const double u = uniform();
    const double spread = std::pow(u <= 0.5 ? 2 * u : 1 / (2 * (1 - u)), 1.0 / 5);
    const double low = std::min(a, b);
    const double high = std::max(a, b);
    const double near = 0.5 * ((1 + spread) * low + (1 - spread) * high);
    const double far = 0.5 * ((1 - spread) * low + (1 + spread) * high);
    first.genes[n] = std::min(std::fabs(near), kHigh[n]);
    second.genes[n] = std::min(std::fabs(far), kHigh[n]);
  }

  void mutation(Chromosome& genes, int generation) {
    const auto n = std::min<std::size_t>(static_cast<std::size_t>(uniform() * kGenes), kGenes - 1);
    const double p = std::pow(1.0 - static_cast<double>(generation) / last_, 2) * uniform();
    const double bound = uniform() < 0.5 ? kLow[n] : kHigh[n];
    genes[n] = std::fabs((1 - p) * genes[n] + p * bound);
    if (genes[n] > kHigh[n]) genes[n] = kHigh[n] / 2;
  }

  const Recording& recording_;
  int size_;
  int last_;
  std::mt19937_64 engine_;
  double penalty_sum_ = 0, fitness_sum_ = 0, mean_ = 0, most_ = 0;
};

}  // namespace

int main(int count, char** arguments) {
  if (count != 5) {
    std::fprintf(stderr, "usage: genetic RECORDING POPULATION GENERATIONS SEED\n");
    return 2;
  }
  Recording r;
  std::ifstream file(arguments[1]);
  double t = 0, q = 0, v = 0, tau = 0, raw = 0;
  while (file >> t >> q >> v >> tau >> raw) {
    r.time.push_back(t);
    r.position.push_back(q);
    r.velocity.push_back(v);
    r.torque.push_back(tau);
    r.sensor.push_back(raw);
  }
  if (r.time.size() < 2) {
    std::fprintf(stderr, "%s holds no recording\n", arguments[1]);
    return 2;
  }
  const auto began = std::chrono::steady_clock::now();
  Search search(r, std::atoi(arguments[2]), std::atoi(arguments[3]),
                static_cast<unsigned>(std::atoi(arguments[4])));
  const double best = search.run();
  const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - began;
  std::printf("%.6f %ld %.17g\n", spent.count(), search.candidates, best);
  return 0;
}
