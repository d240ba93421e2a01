// A search interrupted at any place continues to the same bits, also through the bytes of a
// checkpoint.

#include <limits>
#include <string>
#include <vector>

#include "check.hpp"
#include "landscapes.hpp"

namespace jointid::tests {
namespace {

using search::Continuation;
using search::GaOptions;
using search::GaResult;
using search::GaState;
using search::Generation;
using search::minimise_genetic;
using search::state_from_bytes;
using search::Stop;
using search::to_bytes;

const auto kDomain = cube(4, -4.0, 5.0);

GaResult go(const GaOptions& options, const Continuation& parts, int threads = 2,
            const search::Observer& observer = {}, Function function = rippled) {
  base::Pool pool(threads);
  return minimise_genetic(each(function), kDomain, options, 9, 3, pool, observer, parts);
}

std::vector<GaOptions> variants() {
  GaOptions plain;
  GaOptions islands;
  islands.islands = 3;
  islands.population = 11;
  islands.migration_interval = 5;
  islands.adaptive = true;
  GaOptions binary;
  binary.coding = search::Coding::binary;
  std::vector<GaOptions> all{plain, islands, binary, GaOptions::thesis(), GaOptions::thesis_code()};
  for (auto& options : all) {
    options.generations = 40;
    options.population = std::min(options.population, 30);
  }
  return all;
}

CHECK_CASE("genetic state: every checkpoint leads to the uninterrupted run's bits") {
  for (const auto& options : variants()) {
    std::vector<std::string> states;
    const auto whole =
        go(options, {nullptr, [&](const GaState& s) { states.push_back(to_bytes(s)); }, 7});
    CHECK(states.size() == 5);
    for (const auto& bytes : states) {
      const GaState state = state_from_bytes(bytes);
      CHECK(to_bytes(state) == bytes);
      for (const int threads : {1, 7})
        CHECK(same_run(go(options, {&state, {}, 7}, threads), whole));
    }
  }
}

CHECK_CASE("genetic state: stopped, resumed, stopped and resumed again") {
  for (const auto& options : variants()) {
    const auto whole = go(options, {});
    const auto stop_at = [](int number) {
      return [number](const Generation& g) { return g.number == number; };
    };
    const auto first = go(options, {}, 2, stop_at(0));
    CHECK(first.stop == Stop::observer && first.state->generation == 0);
    std::vector<int> seen;
    const auto second = go(options, {&*first.state, {}, 50}, 2, [&](const Generation& g) {
      seen.push_back(g.number);
      return g.number == 13;
    });
    CHECK(seen.size() == 13 && seen.front() == 1);
    const auto third = go(options, {&*second.state, {}, 50});
    CHECK(same_run(third, whole));
    CHECK(to_bytes(*third.state) == to_bytes(*whole.state));
    // A finished run stays finished.
    CHECK(same_run(go(options, {&*whole.state, {}, 50}), whole));
  }
}

CHECK_CASE("genetic state: a converged run stays converged") {
  GaOptions options;
  options.generations = 5000;
  options.mutation_probability = 0.0;
  options.tolerance = 1e-6;
  const Function raised = [](const Candidate& x) { return 1.0 + sphere(x); };
  const auto whole = go(options, {}, 2, {}, raised);
  CHECK(whole.stop == Stop::converged);
  CHECK(same_run(go(options, {&*whole.state, {}, 50}, 2, {}, raised), whole));
}

CHECK_CASE("genetic state: the spread is relative to the best, and a tolerance of 0 is none") {
  GaOptions options;
  options.generations = 5;
  options.tolerance = 1e-3;
  const Function high = [](const Candidate& x) { return 1e5 + sphere(x); };
  CHECK(go(options, {}, 2, {}, high).stop == Stop::converged);
  const Function low = [](const Candidate& x) { return 1e-6 * (1.0 + sphere(x)); };
  options.mutation_probability = 1.0;
  CHECK(go(options, {}, 2, {}, low).stop != Stop::converged);
  options.tolerance = 0.0;
  const Function same = [](const Candidate&) { return 5.0; };
  CHECK(go(options, {}, 2, {}, same).stop != Stop::converged);
}

CHECK_CASE("genetic state: another penalty is refused, also an infinite one") {
  GaOptions options;
  options.generations = 5;
  const Function raised = [](const Candidate& x) { return 1.0 + sphere(x); };
  const Function infinite = [](const Candidate&) {
    return std::numeric_limits<double>::infinity();
  };
  const auto state = *go(options, {}, 2, {}, raised).state;
  const Function rounded = [](const Candidate& x) { return (1.0 + 1e-12) * (1.0 + sphere(x)); };
  const Function other = [](const Candidate& x) { return (1.0 + 1e-6) * (1.0 + sphere(x)); };
  CHECK(go(options, {&state, {}, 50}, 2, {}, rounded).stop == Stop::generations);
  CHECK_REFUSED(go(options, {&state, {}, 50}, 2, {}, other), "another recording");
  CHECK_REFUSED(go(options, {&state, {}, 50}, 2, {}, infinite), "another recording");
  const auto nowhere = *go(options, {}, 2, {}, infinite).state;
  CHECK(go(options, {&nowhere, {}, 50}, 2, {}, infinite).stop == Stop::generations);
  CHECK_REFUSED(go(options, {&nowhere, {}, 50}, 2, {}, raised), "another recording");
}

CHECK_CASE("genetic state: bytes that are not a whole state are refused") {
  GaOptions options;
  options.generations = 3;
  options.population = 4;
  const std::string bytes = to_bytes(*go(options, {}).state);
  CHECK_REFUSED(state_from_bytes(""), "this is not a checkpoint file");
  CHECK_REFUSED(state_from_bytes("PK\x03\x04"), "this is not a checkpoint file");
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    CHECK_REFUSED(state_from_bytes(std::string_view(bytes).substr(0, length)), "checkpoint");
  }
  for (std::size_t place = 0; place < bytes.size(); ++place) {
    std::string damaged = bytes;
    damaged[place] = static_cast<char>(damaged[place] ^ 4);
    CHECK_REFUSED(state_from_bytes(damaged), "checkpoint");
  }
  CHECK_REFUSED(state_from_bytes(bytes + "x"), "checkpoint");
}

CHECK_CASE("genetic state: another run's state is refused with the difference") {
  GaOptions options;
  options.generations = 5;
  options.population = 10;
  const auto state = *go(options, {}).state;
  const auto resumed = [&](auto spoil) {
    GaOptions other = options;
    spoil(other);
    return [&state, other] { return go(other, {&state, {}, 50}); };
  };
  CHECK_REFUSED(resumed([](GaOptions& o) { o.population = 20; })(), "population 10, not 20");
  CHECK_REFUSED(resumed([](GaOptions& o) { o.generations = 6; })(), "generations 5, not 6");
  CHECK_REFUSED(resumed([](GaOptions& o) { o.selection = search::Selection::rank; })(),
                "selection tournament, not rank");
  const auto other_run = [&](const search::Domain& domain, std::uint64_t seed,
                             std::uint32_t trial) {
    base::Pool pool(1);
    const Continuation parts{&state, {}, 50};
    return minimise_genetic(each(rippled), domain, options, seed, trial, pool, {}, parts);
  };
  CHECK_REFUSED(other_run(kDomain, 8, 3), "seed 9, not 8");
  CHECK_REFUSED(other_run(kDomain, 9, 4), "trial 3, not 4");
  CHECK_REFUSED(other_run(cube(4, -4.0, 6.0), 9, 3), "upper bound of parameter 0 5, not 6");
  CHECK_REFUSED(other_run(cube(3, -4.0, 5.0), 9, 3), "a number of parameters of 4, not 3");
  CHECK_REFUSED(go(options, {&state, {}, 50}, 1, {}, sphere), "another recording");
  CHECK_REFUSED(go(options, {nullptr, {}, 0}), "checkpoint_interval must be at least 1, got 0");
}

}  // namespace
}  // namespace jointid::tests
