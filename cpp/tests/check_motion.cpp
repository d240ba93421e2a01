// One integration step: a stuck joint stays, friction only removes energy, the order holds through
// reversals, bristles are stable at any stiffness.

#include "simulate/integration_step.hpp"

#include <bit>
#include <cstdint>
#include <string>

#include "base/random.hpp"
#include "check.hpp"
#include "simulated.hpp"

namespace jointid::tests {
namespace {

using model::Joint;
using model::SpeedBasis;
using simulate::MotionOf;
using Motion = MotionOf<double>;

Joint thesis() {
  return thesis_setup().joint;
}

std::uint64_t bits(double x) {
  return std::bit_cast<std::uint64_t>(x);
}

/// Position after `time` under a torque that depends on time.
template <class Torque>
Motion moved(const Joint& joint, Motion motion, double time, int steps, Torque torque) {
  const double h = time / steps;
  for (int k = 0; k < steps; ++k) simulate::advance(joint, motion, torque((k + 0.5) * h), h);
  return motion;
}

CHECK_CASE("motion: below breakaway a resting joint keeps its bits") {
  const Joint joint = thesis();
  Motion motion;
  motion.position = 0.123456789;
  const auto position = bits(motion.position);
  const double weight = simulate::gravity(joint, motion.position);
  base::Random random(1, 0, 0, 0);
  for (int k = 0; k < 10000; ++k) {
    const double torque = weight + 44.999 * (2.0 * random.uniform() - 1.0);
    simulate::advance(joint, motion, torque, 1e-3);
    CHECK(bits(motion.position) == position);
    CHECK(bits(motion.velocity) == 0);
    CHECK(simulate::dynamics(joint, motion, torque).acceleration == 0.0);
    CHECK_CLOSE(simulate::dynamics(joint, motion, torque).friction, torque - weight, 1e-12);
  }
  simulate::advance(joint, motion, weight + 45.001, 1e-3);
  CHECK(motion.velocity > 0.0);
}

CHECK_CASE("motion: a joint that coasts stops, once, and stays") {
  Joint joint = thesis();
  joint.weights.clear();
  Motion motion;
  motion.velocity = 0.7;
  int stops = 0;
  for (int k = 0; k < 5000; ++k) {
    const double before = motion.velocity;
    simulate::advance(joint, motion, 0.0, 1e-3);
    CHECK(motion.velocity >= 0.0);
    CHECK(motion.velocity <= before);
    if (before != 0.0 && motion.velocity == 0.0) ++stops;
  }
  CHECK(stops == 1);
  CHECK(motion.velocity == 0.0);
}

CHECK_CASE("motion: asymmetric joints break away in the right direction") {
  Joint joint = thesis();
  joint.weights.clear();
  joint.friction[0].negative = 5.0;
  joint.friction[1].negative = 1.0;
  joint.load_friction = 0.5;
  Motion motion;
  simulate::advance(joint, motion, 89.0, 1e-3);  // 45 + half the torque
  CHECK(motion.velocity == 0.0);
  simulate::advance(joint, motion, -11.9, 1e-3);  // 6 + half the torque
  CHECK(motion.velocity == 0.0);
  simulate::advance(joint, motion, -12.1, 1e-3);
  CHECK(motion.velocity < 0.0);
}

CHECK_CASE("motion: friction only removes energy, for any joint and step") {
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    base::Random random(seed, 0, 0, 0);
    const auto up_to = [&](double most) { return most * random.uniform(); };
    Joint joint;
    joint.inertia = 0.01 + up_to(3.0);
    const auto term = [&](SpeedBasis basis, double most) {
      const double positive = up_to(most);
      joint.friction.push_back({basis, positive, up_to(most)});
    };
    term(SpeedBasis::constant, 50.0);
    term(seed % 3 == 0 ? SpeedBasis::general : SpeedBasis::gaussian, 40.0);
    auto& shapes = joint.friction.back().shapes;
    if (seed % 3 == 0) {
      shapes = {0.001 + up_to(1.0), 0.3 + up_to(2.0)};
    } else {
      shapes = {up_to(1000.0)};
    }
    term(SpeedBasis::linear, 40.0);
    joint.load_friction = up_to(0.3);
    joint.bristles = seed % 4 == 0;
    joint.bristle_stiffness = 1.0 + up_to(1e6);
    const double h = 1e-5 + up_to(5e-3);
    Motion motion;
    motion.velocity = 4.0 * random.uniform() - 2.0;
    const auto stored = [&] {
      const double spring =
          joint.bristles ? 0.5 * joint.bristle_stiffness * motion.bristle * motion.bristle : 0.0;
      return 0.5 * joint.inertia * motion.velocity * motion.velocity + spring;
    };
    for (int k = 0; k < 300; ++k) {
      const double torque = k < 150 ? 100.0 * (random.uniform() - 0.5) : 0.0;
      const double before = stored();
      const double start = motion.position;
      simulate::advance(joint, motion, torque, h);
      // No other force acts, so any energy beyond the torque's work would come from friction.
      const double gained = stored() - before - torque * (motion.position - start);
      CHECK_WITH(gained <= 1e-11 * (1.0 + before),
                 "seed " + std::to_string(seed) + ": " + std::to_string(gained));
    }
  }
}

CHECK_CASE("motion: second order, with reversals, under gravity and Stribeck friction") {
  for (const bool bristles : {false, true}) {
    Joint joint = thesis();
    joint.bristles = bristles;
    joint.bristle_stiffness = 2e3;
    joint.bristle_damping = 50.0;
    joint.harmonics = {{3.0, 0.5, 1.0}};
    const auto torque = [](double time) { return 90.0 * base::sin(5.0 * time); };
    const double fine = moved(joint, {}, 3.0, 192000, torque).position;
    double first = 0.0;
    double last = 0.0;
    for (const int steps : {3000, 6000, 12000, 24000}) {
      const double error = std::fabs(moved(joint, {}, 3.0, steps, torque).position - fine);
      // Four is the factor of second order. The place of a reversal in its step makes it uneven,
      // and with bristles a step may by chance be better than its order.
      if (last > 0.0 && !bristles) CHECK_WITH(error < last / 2.5, std::to_string(last / error));
      if (first == 0.0) first = error;
      last = error;
    }
    CHECK_WITH(last < first / 30.0, std::to_string(first / last));
    CHECK_CLOSE(last, 0.0, 1e-6);
  }
}

CHECK_CASE("motion: where a joint stops within a step is known") {
  // With only dry and viscous friction, the joint stops after m/c ln(1 + c v/F).
  Joint joint;
  joint.inertia = 2.0;
  joint.friction = {{SpeedBasis::constant, 10.0, 10.0}, {SpeedBasis::linear, 4.0, 4.0}};
  const double speed = 0.25;  // c v / F is a tenth
  const double share = 0.1;
  const double whole = joint.inertia * speed * speed / 10.0;
  const double expected = whole * (1.0 / share - std::log1p(share) / (share * share));
  for (const double side : {1.0, -1.0}) {
    Motion motion;
    motion.velocity = side * speed;
    simulate::advance(joint, motion, 0.0, 0.3);
    CHECK(motion.velocity == 0.0);
    CHECK_CLOSE(side * motion.position, expected, 0.02 * expected);
  }
}

CHECK_CASE("motion: a joint that reverses within a step gains what fine steps give it") {
  Joint joint = thesis();
  joint.weights.clear();
  const auto push = [](double) { return -150.0; };
  Motion start;
  start.velocity = 0.02;
  const double step = 2e-3;
  const Motion coarse = moved(joint, start, step, 1, push);
  const Motion fine = moved(joint, start, step, 4000, push);
  CHECK(fine.velocity < -0.05);
  CHECK_CLOSE(coarse.velocity, fine.velocity, 8e-3 * std::fabs(fine.velocity));
  CHECK_CLOSE(coarse.position, fine.position, 0.02 * std::fabs(fine.position));
}

CHECK_CASE("motion: bristles that a step resolves keep their energy") {
  Joint joint;
  joint.inertia = 2.0;
  joint.bristles = true;
  joint.bristle_stiffness = 2e4;  // without damping: it swings at 100 rad/s
  joint.friction = {{SpeedBasis::constant, 1e6, 1e6}};
  Motion motion;
  motion.velocity = 1e-3;
  const double period = 4.0 * kHalfPi / 100.0;
  motion = moved(joint, motion, 10.0 * period, 400, [](double) { return 0.0; });
  const double left = motion.velocity * motion.velocity + 1e4 * motion.bristle * motion.bristle;
  CHECK_CLOSE(left, 1e-6, 1e-9);
}

CHECK_CASE("motion: the friction of bristles follows the speed within a coarse step") {
  Joint joint = thesis();
  joint.weights.clear();
  joint.bristles = true;
  joint.bristle_stiffness = 2e3;
  joint.bristle_damping = 50.0;
  const auto push = [](double) { return 100.0; };
  for (const double speed : {0.05, 0.2, 1.0}) {
    Motion start;
    start.velocity = speed;
    start.bristle = 12.5 / joint.bristle_stiffness;
    const double coarse = moved(joint, start, 0.04, 4, push).velocity;
    CHECK_CLOSE(coarse, moved(joint, start, 0.04, 40'000, push).velocity, 1e-3);
  }
}

CHECK_CASE("motion: stiff bristles stay stable and hold the load") {
  Joint joint = thesis();
  joint.bristles = true;
  joint.bristle_damping = 10.0;
  for (const double stiffness : {1e3, 1e6, 1e9, 1e12}) {
    joint.bristle_stiffness = stiffness;
    Motion motion = moved(joint, {}, 2.0, 2000, [](double) { return 20.0; });
    CHECK_WITH(std::fabs(motion.velocity) < 1e-3, std::to_string(stiffness));
    CHECK_WITH(std::fabs(motion.position) < 60.0 / stiffness + 1e-3, std::to_string(stiffness));
    motion = moved(joint, {}, 2.0, 2000, [](double time) { return 120.0 * base::sin(7.0 * time); });
    CHECK(std::fabs(motion.velocity) < 10.0);
    CHECK(std::fabs(stiffness * motion.bristle) < 46.0);
  }
}

}  // namespace
}  // namespace jointid::tests
