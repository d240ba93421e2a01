#pragma once
// One integration step of a joint under a held torque: the midpoint rule. Friction is set-valued at
// rest and solved for implicitly.
//
// Dry friction always acts against the mean velocity of the step, and the position moves with that
// velocity. So friction can only remove energy. Where the velocity would change its sign, the step
// is divided at the reversal. From there the joint either stays exactly at rest, or moves on for
// the remaining time. Both cases keep the second order.

#include "base/lanes.hpp"
#include "model/dry_friction.hpp"

namespace jointid::simulate {

using model::JointOf;

template <class Number>
struct MotionOf {
  Number position = 0.0;
  Number velocity = 0.0;
  Number varying = 0.0;  ///< friction that varies with the speed, from the last step: the first
                         ///< guess for the next step
  Number bristle = 0.0;  ///< mean deflection [rad] (Dahl, LuGre)
};

/// Torques on the joint at one instant.
template <class Number>
struct Dynamics {
  Number acceleration = 0.0;
  Number friction = 0.0;     ///< torque by which friction brakes the drive
  Number link_torque = 0.0;  ///< torque at the sensor: gravity and the link's inertia
  Number drive_torque =
      0.0;  ///< torque in the drive that depends on the angle: harmonics and offset
};

/// Torque of gravity and load on the link.
template <class Number>
Number gravity(const JointOf<Number>& joint, const Number& position) {
  Number sum = joint.load;
  for (const auto& weight : joint.weights) {
    sum = sum + weight.torque * base::cos(position + weight.angle);
  }
  return sum;
}

/// Torque in the drive that depends on the angle alone.
template <class Number>
Number drive_torque(const JointOf<Number>& joint, const Number& position) {
  Number sum = joint.torque_offset;
  for (const auto& harmonic : joint.harmonics) {
    const Number angle = position * Number(harmonic.order);
    sum = sum + harmonic.cos * base::cos(angle) + harmonic.sin * base::sin(angle);
  }
  return sum;
}

namespace detail {

/// Friction behind bristles (2-4 to 2-7). z' = v - rate z is solved exactly over the step for the
/// step's velocity. Friction is then linear in that velocity and implicit in it. If the step
/// resolves the bristles' oscillation, the means of velocity and deflection over the step count,
/// which gives second order. Otherwise their values at the end of the step count, which avoids
/// ringing. The speed in the rate is found by iteration.
template <class Number>
void advance_bristles(const JointOf<Number>& joint, MotionOf<Number>& motion, const Number& push,
                      const Number& dry_load, double step) {
  const Number h = step;
  const Number mass = joint.inertia + joint.link_inertia;
  const Number z = motion.bristle;
  const Number before = motion.velocity;
  const Number coarse = 0.25 * h * h * joint.bristle_stiffness / mass;
  const Number end = 1.0 - 1.0 / (1.0 + coarse * coarse);
  Number used = before;  // velocity that enters the friction
  Number after = before;
  Number rate = 0.0;
  Number mean = 1.0;
  for (int pass = 0; pass < 3; ++pass) {
    const Number speed = base::absolute(used);
    const auto forward = !(used < Number(0.0));
    const auto friction = model::directed(joint, forward, dry_load);
    rate = joint.bristle_stiffness * speed / friction.level(model::varying(joint, forward, speed));
    const Number x = rate * h;
    // (1 - e^-x) / x and (1 - that) / x, by series where the differences would cancel
    const auto small = x < Number(0.05);
    const Number safe = base::select(small, Number(1.0), x);
    const Number series = 0.5 - x * (1.0 / 6 - x * (1.0 / 24 - x * (1.0 / 120 - x * (1.0 / 720))));
    mean = base::select(small, 1.0 - x * series, (1.0 - base::exp(-safe)) / safe);
    const Number second = base::select(small, series, (1.0 - mean) / safe);
    const Number share =
        mean + end * (1.0 - x * mean - mean);  // weights of z and z' in the friction
    const Number held = share * z * (joint.bristle_stiffness - joint.bristle_damping * rate);
    const Number slope = joint.bristle_stiffness * h * (second + end * (mean - second)) +
                         joint.bristle_damping * share + friction.viscous;
    const Number half = 0.5 * h * slope;
    after =
        (before * (mass - half * (1.0 - end)) + h * (push - held)) / (mass + half * (1.0 + end));
    used = 0.5 * ((1.0 - end) * before + (1.0 + end) * after);
  }
  motion.bristle = z + h * mean * (used - rate * z);
  motion.velocity = after;
  motion.position = motion.position + h * used;
}

}  // namespace detail

/// `push`: accelerating torque without friction, held over the step; `dry_load`: dry friction of
/// the load.
template <class Number>
void advance_pushed(const JointOf<Number>& joint, MotionOf<Number>& motion, const Number& push,
                    const Number& dry_load, double step) {
  const Number zero = 0.0;
  const Number h = step;
  const Number half = 0.5 * step;
  const Number mass = joint.inertia + joint.link_inertia;
  const Number velocity = motion.velocity;
  if (joint.bristles) return detail::advance_bristles(joint, motion, push, dry_load, step);

  const auto resting = velocity == zero;
  const auto forward = zero < base::select(resting, push, velocity);
  const auto friction = model::directed(joint, forward, dry_load);
  const Number sign = base::select(forward, Number(1.0), Number(-1.0));
  const Number ahead = sign * push;
  const Number speed = sign * velocity;
  const Number guess =
      speed + half *
                  (ahead - friction.level(base::select(resting, friction.at_rest, motion.varying)) -
                   friction.viscous * speed) /
                  mass;
  const Number varying = model::varying(joint, forward, base::at_least(guess, 0.0));
  const Number viscous = half * friction.viscous;
  const Number after =
      (speed * (mass - viscous) + h * (ahead - friction.level(varying))) / (mass + viscous);
  const auto reversing = (!resting) & (after < zero);
  const auto stuck = resting & (!(friction.breakaway() < ahead));

  Number velocity_after = base::select(stuck, zero, sign * after + zero);
  Number position_after =
      base::select(stuck, motion.position, motion.position + half * (velocity + velocity_after));
  motion.varying = varying;
  if (base::any(reversing)) {
    // Until the stop, friction is that of the mean velocity, which is half the velocity at the
    // start.
    const Number braking = friction.level(varying) + 0.5 * friction.viscous * speed - ahead;
    const Number before = speed * mass / base::select(reversing, braking, Number(1.0));
    const Number rest = h - before;
    const auto onward = zero < push;
    const auto other = model::directed(joint, onward, dry_load);
    const Number spare = base::absolute(push) - other.breakaway();
    const auto goes = zero < spare;
    const Number middle = 0.5 * rest * base::select(goes, spare, zero) / mass;
    const Number next = model::varying(joint, onward, middle);
    const Number gained =
        rest * (base::absolute(push) - other.level(next)) / (mass + 0.5 * rest * other.viscous);
    const Number left =
        base::select(goes, base::select(onward, Number(1.0), Number(-1.0)) * gained, zero);
    velocity_after = base::select(reversing, left, velocity_after);
    position_after = base::select(
        reversing, motion.position + 0.5 * (before * velocity + rest * left), position_after);
    motion.varying = base::select(reversing, next, motion.varying);
  }
  motion.velocity = velocity_after;
  motion.position = position_after;
}

/// `torque`: torque of the drive, held over the step.
template <class Number>
void advance(const JointOf<Number>& joint, MotionOf<Number>& motion, const Number& torque,
             double step) {
  const Number there = motion.position + Number(0.5 * step) * motion.velocity;
  const Number push = torque - gravity(joint, there) - drive_torque(joint, there);
  advance_pushed(joint, motion, push, joint.load_friction * base::absolute(torque), step);
}

/// Torques at this instant for this torque of the drive.
template <class Number>
Dynamics<Number> dynamics(const JointOf<Number>& joint, const MotionOf<Number>& motion,
                          const Number& torque) {
  const Number zero = 0.0;
  const Number weight = gravity(joint, motion.position);
  const Number own = drive_torque(joint, motion.position);
  const Number push = torque - weight - own;
  const Number velocity = motion.velocity;
  const auto resting = velocity == zero;
  const auto forward = zero < base::select(resting, push, velocity);
  const Number speed = base::absolute(velocity);
  const auto directed =
      model::directed(joint, forward, joint.load_friction * base::absolute(torque));
  const Number level = directed.level(model::varying(joint, forward, speed));
  Number friction;
  if (joint.bristles) {
    const Number slip = velocity - joint.bristle_stiffness * speed / level * motion.bristle;
    friction = joint.bristle_stiffness * motion.bristle + joint.bristle_damping * slip +
               directed.viscous * velocity;
  } else {
    const Number sign = base::select(forward, Number(1.0), Number(-1.0));
    const auto stuck = resting & (!(directed.breakaway() < sign * push));
    friction = base::select(stuck, push, sign * (level + directed.viscous * speed));
  }
  const Number acceleration = (push - friction) / (joint.inertia + joint.link_inertia);
  return {acceleration, friction, joint.link_inertia * acceleration + weight, own};
}

}  // namespace jointid::simulate
