#include "design/candidate.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/elementary.hpp"
#include "base/require.hpp"

namespace jointid::design {

namespace {

constexpr double kTwoPi = 0x1.921fb54442d18p+2;
constexpr double kLeast = 0.25;  // share of the limits that a motion uses
constexpr double kPerPeriod =
    32;  // samples per period of the fastest sine: peaks are missed by 0.5 %
constexpr double kMissed = 0.995;

/// The largest factor on the sines that keeps all bounds.
double largest(const Family& family, const Sines& sines) {
  const Bounds& bounds = family.bounds;
  Sines moved = sines;
  moved.offset = 0.0;
  const simulate::Trajectory trajectory = moved.trajectory();
  const double apart =
      std::min(kTwoPi / (kPerPeriod * sines.frequency.maxCoeff()), family.fade / kPerPeriod);
  const auto count = static_cast<std::size_t>(std::ceil(family.duration / apart));
  thread_local std::vector<simulate::Reference> wanted;
  wanted.resize(count + 1);
  trajectory.sample(family.duration / static_cast<double>(count), wanted);
  double high = 0.0;
  double low = 0.0;
  double speed = 0.0;
  double acceleration = 0.0;
  double effort = 0.0;
  for (const simulate::Reference& at : wanted) {
    high = std::max(high, at.position);
    low = std::min(low, at.position);
    speed = std::max(speed, std::fabs(at.velocity));
    acceleration = std::max(acceleration, std::fabs(at.acceleration));
    effort = std::max(effort,
                      std::fabs(bounds.inertia * at.acceleration + bounds.viscous * at.velocity));
  }
  double share = 1e300;
  const auto keep = [&](double reached, double allowed) {
    if (reached > 0.0) share = std::min(share, allowed / reached);
  };
  keep(high, bounds.highest - sines.offset);
  keep(-low, sines.offset - bounds.lowest);
  keep(speed, bounds.velocity);
  keep(acceleration, bounds.acceleration);
  keep(effort, bounds.torque - bounds.dry);
  return kMissed * share;
}

}  // namespace

void Bounds::validate() const {
  const base::Requirement require("limits");
  require.finite("position", lowest);
  require.that(highest > lowest && std::isfinite(highest), "position", highest,
               "above its lower end");
  require.above_zero("velocity", velocity);
  require.above_zero("acceleration", acceleration);
  require.that(torque > dry, "torque", torque, "above what dry friction and load need");
}

void Family::validate() const {
  const base::Requirement require("design");
  require.that(sines >= 1 && sines <= 64, "sines", sines, "1 to 64");
  require.above_zero("duration", duration);
  require.that(fade > 0.0 && 2.0 * fade <= duration, "fade", fade,
               "above 0 and at most half the duration");
  require.above_zero("slowest", slowest);
  require.that(fastest > slowest, "fastest", fastest, "above the slowest");
  bounds.validate();
}

search::Domain Family::domain() const {
  return {Eigen::VectorXd::Zero(genes()), Eigen::VectorXd::Ones(genes())};
}

simulate::Trajectory Sines::trajectory() const {
  return simulate::Trajectory::multisine(amplitude, frequency, phase, offset, duration, fade);
}

Sines motion_of(const Family& family, const Eigen::VectorXd& genes) {
  const Eigen::Index count = family.sines;
  Sines sines{
      Eigen::VectorXd(count), Eigen::VectorXd(count), Eigen::VectorXd(count), 0.0, family.fade,
      family.duration};
  const double span = base::log(family.fastest / family.slowest);
  for (Eigen::Index i = 0; i < count; ++i) {
    const double frequency = family.slowest * base::exp(span * genes[i]);
    const double size = genes[count + i];
    sines.frequency[i] = frequency;
    // Interpolates between equal angles and equal speeds. A size of 0 is likely enough that some
    // motions have fewer sines.
    sines.amplitude[i] = size * size / std::sqrt(frequency / family.slowest);
    sines.phase[i] = kTwoPi * genes[2 * count + i];
  }
  const Bounds& bounds = family.bounds;
  sines.offset = bounds.lowest + (0.05 + 0.9 * genes[3 * count]) * (bounds.highest - bounds.lowest);
  const double used = kLeast + (1.0 - kLeast) * std::min(1.0, 1.25 * genes[3 * count + 1]);
  if (sines.amplitude.maxCoeff() > 0.0) sines.amplitude *= used * largest(family, sines);
  return sines;
}

}  // namespace jointid::design
