// Closed loops: lanes and threads change no bit, noise is a function of the seed, Ctrl-C ends a
// long run, and impossible settings are refused.

#include "simulate/simulator.hpp"

#include <stdexcept>
#include <string>

#include "base/input_error.hpp"
#include "check.hpp"
#include "simulated.hpp"

namespace jointid::tests {
namespace {

using simulate::AdaptiveRobust;
using simulate::Outcome;
using simulate::Scenario;
using simulate::Setup;

Scenario short_scenario() {
  Scenario scenario;
  scenario.duration = 0.4;
  scenario.settling = 0.1;
  return scenario;
}

std::vector<Setup> candidates(int count) {
  std::vector<Setup> setups;
  for (int i = 0; i < count; ++i) {
    Setup setup = thesis_setup();
    setup.seed = static_cast<std::uint64_t>(i);
    std::get<AdaptiveRobust>(setup.controller).coulomb = 10.0 + i;
    setup.joint.friction[2].positive = 15.0 + i;
    setup.joint.harmonics = {{3.0, 0.1 * i, 1.0}};
    setup.joint.bristles = i % 7 == 6;
    setup.joint.bristle_stiffness = 1e5;
    if (i % 5 == 4) setup.controller = simulate::Pd{2000.0, 100.0};
    setups.push_back(setup);
  }
  return setups;
}

std::vector<double> all(const Outcome& o) {
  std::vector<double> values{o.rms_error, o.peak_error};
  for (const auto* signal :
       {&o.signals.position, &o.signals.velocity, &o.signals.torque, &o.signals.reading,
        &o.signals.friction, &o.signals.link_torque, &o.signals.true_acceleration}) {
    values.insert(values.end(), signal->begin(), signal->end());
  }
  return values;
}

CHECK_CASE("simulator: alone or in lanes, on one thread or three, the bits are the same") {
  Scenario scenario = short_scenario();
  scenario.sensors.encoder_counts = 8000;
  scenario.sensors.velocity = simulate::VelocityEstimate::counts;
  scenario.sensors.torque_noise = 0.5;
  scenario.sensors.filter_order = 2;
  scenario.sensors.filter_frequency = 100.0;
  const auto trajectory = thesis_trajectory(60.0, 0.5, 0.4);
  const auto setups = candidates(29);
  base::Pool one(1);
  base::Pool three(3);
  const auto first = simulate::simulate(scenario, trajectory, setups, true, one);
  const auto second = simulate::simulate(scenario, trajectory, setups, true, three);
  for (std::size_t i = 0; i < setups.size(); ++i) {
    const auto alone = simulate::simulate(scenario, trajectory, {setups[i]}, true, one);
    CHECK(alone[0].signals.position.size() == 400);
    CHECK_WITH(all(alone[0]) == all(first[i]), std::to_string(i));
    CHECK_WITH(all(first[i]) == all(second[i]), std::to_string(i));
  }
}

CHECK_CASE("simulator: noise is a function of the seed") {
  Scenario scenario = short_scenario();
  scenario.sensors.torque_noise = 0.5;
  const auto trajectory = thesis_trajectory(60.0, 0.5, 0.4);
  base::Pool pool(1);
  Setup setup = thesis_setup();
  const auto first = simulate::simulate(scenario, trajectory, {setup}, true, pool);
  const auto again = simulate::simulate(scenario, trajectory, {setup}, true, pool);
  setup.seed = 1;
  const auto other = simulate::simulate(scenario, trajectory, {setup}, true, pool);
  CHECK(all(first[0]) == all(again[0]));
  CHECK(first[0].signals.reading != other[0].signals.reading);
}

CHECK_CASE("simulator: a true estimate tracks better than a wrong one") {
  Scenario scenario = short_scenario();
  scenario.duration = 3.0;
  const auto trajectory = thesis_trajectory(60.0, 3.0, 3.0);
  Setup right = thesis_setup();
  auto& law = std::get<AdaptiveRobust>(right.controller);
  law.coulomb = 25.0;
  law.static_excess = 20.0;
  law.stribeck = 100.0;
  law.viscous = 20.0;
  law.sensor_gain = 2.4;
  law.sensor_offset = 15.0;
  base::Pool pool(2);
  const auto both = simulate::simulate(scenario, trajectory, {thesis_setup(), right}, false, pool);
  CHECK(both[1].rms_error < 0.2 * both[0].rms_error);
  CHECK(both[0].signals.position.empty());
}

CHECK_CASE("simulator: the poll ends a long run") {
  Scenario scenario = short_scenario();
  scenario.duration = 1e5;
  int calls = 0;
  base::Pool pool(1, [&] {
    if (++calls == 2) throw std::runtime_error("enough");
  });
  const std::string message = message_of<std::runtime_error>(
      [&] {
        static_cast<void>(simulate::simulate(scenario, thesis_trajectory(60.0, 3.0, 1e5),
                                             {thesis_setup()}, false, pool));
      },
      "a long run", __FILE__, __LINE__);
  CHECK(message == "enough");
}

CHECK_CASE("simulator: an unstable loop is reported, not returned") {
  Setup setup = thesis_setup();
  setup.joint.torque_limit = 1e200;
  setup.controller = simulate::Pd{1e9, 0.0};
  base::Pool pool(1);
  const std::string message = message_of<base::InputError>(
      [&] {
        static_cast<void>(simulate::simulate(short_scenario(), thesis_trajectory(60.0, 0.5, 0.4),
                                             {setup}, false, pool));
      },
      "an unstable loop", __FILE__, __LINE__);
  CHECK(contains(message, "not stable"));
}

CHECK_CASE("simulator: impossible settings are refused with their name") {
  base::Pool pool(1);
  const auto trajectory = thesis_trajectory(60.0, 0.5, 0.4);
  const auto tried = [&](auto change) {
    Scenario scenario = short_scenario();
    Setup setup = thesis_setup();
    change(scenario, setup);
    return simulate::simulate(scenario, trajectory, {setup}, false, pool);
  };
  CHECK_REFUSED(tried([](auto& s, auto&) { s.integration_step = 3e-4; }), "integration_step");
  CHECK_REFUSED(tried([](auto& s, auto&) { s.duration = 1e-5; }), "duration");
  CHECK_REFUSED(tried([](auto& s, auto&) { s.sensors.filter_order = 3; }), "filter_order");
  CHECK_REFUSED(tried([](auto&, auto& s) { s.joint.inertia = 0.0; }), "inertia");
  CHECK_REFUSED(tried([](auto&, auto& s) { s.joint.friction[0].negative = -1.0; }),
                "friction.negative");
  CHECK_REFUSED(tried([](auto&, auto& s) { s.sensor_gain = 0.0; }), "sensor_gain");
  CHECK_REFUSED(tried([](auto&, auto& s) { s.controller = simulate::Pd{-1.0, 0.0}; }),
                "Pd.stiffness");
}

}  // namespace
}  // namespace jointid::tests
