#include "simulate/trajectory.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "base/elementary.hpp"
#include "base/require.hpp"

namespace jointid::simulate {

namespace {

constexpr double kPi = 0x1.921fb54442d18p+1;
constexpr base::Requirement require("Trajectory");

/// Second derivatives at the knots of the natural cubic spline (tridiagonal elimination).
Eigen::VectorXd curvatures(const Eigen::VectorXd& time, const Eigen::VectorXd& position) {
  const Eigen::Index n = time.size();
  Eigen::VectorXd curvature = Eigen::VectorXd::Zero(n);
  Eigen::VectorXd upper = Eigen::VectorXd::Zero(n);
  for (Eigen::Index i = 1; i + 1 < n; ++i) {
    const double before = time[i] - time[i - 1];
    const double after = time[i + 1] - time[i];
    const double turn =
        (position[i + 1] - position[i]) / after - (position[i] - position[i - 1]) / before;
    const double pivot = 2.0 * (before + after) - before * upper[i - 1];
    upper[i] = after / pivot;
    curvature[i] = (6.0 * turn - before * curvature[i - 1]) / pivot;
  }
  for (Eigen::Index i = n - 2; i > 0; --i) curvature[i] -= upper[i] * curvature[i + 1];
  return curvature;
}

/// Factor of the fade with two derivatives: 0 before the start and after the end.
Reference envelope(double duration, double fade, double time) {
  const double left = duration - time;
  const bool ending = left < time;
  const double x = std::clamp((ending ? left : time) / fade, 0.0, 1.0);
  const double y = 1.0 - x;
  const double rate = (ending ? -1.0 : 1.0) / fade;
  return {x * x * x * (10.0 - x * (15.0 - 6.0 * x)), rate * 30.0 * x * x * y * y,
          60.0 * x * y * (y - x) / (fade * fade)};
}

Reference faded(const Reference& sines, const Reference& share) {
  return {share.position * sines.position,
          share.velocity * sines.position + share.position * sines.velocity,
          share.acceleration * sines.position + 2.0 * share.velocity * sines.velocity +
              share.position * sines.acceleration};
}

}  // namespace

Trajectory::Trajectory(Form form, double duration) : form_(std::move(form)), duration_(duration) {
  require.above_zero("duration", duration);
}

Trajectory Trajectory::multisine(Eigen::VectorXd amplitude, Eigen::VectorXd frequency,
                                 Eigen::VectorXd phase, double offset, double duration,
                                 double fade) {
  if (amplitude.size() == 0 || amplitude.size() != frequency.size() ||
      amplitude.size() != phase.size()) {
    throw base::InputError(
        "amplitude, frequency and phase must have the same number of values, at least "
        "one, got " +
            std::to_string(amplitude.size()) + ", " + std::to_string(frequency.size()) + " and " +
            std::to_string(phase.size()),
        "Trajectory");
  }
  for (Eigen::Index i = 0; i < amplitude.size(); ++i) {
    require.finite("amplitude", amplitude[i]);
    require.above_zero("frequency", frequency[i]);
    require.finite("phase", phase[i]);
  }
  require.finite("offset", offset);
  require.that(fade >= 0.0 && 2.0 * fade <= duration, "fade", fade,
               "at least 0 and at most half the duration");
  return {Multisine{std::move(amplitude), std::move(frequency), std::move(phase), offset, duration,
                    fade},
          duration};
}

Trajectory Trajectory::sigmoid(double distance, double rise, double duration) {
  require.finite("distance", distance);
  require.above_zero("rise", rise);
  return {Sigmoid{distance, rise}, duration};
}

Trajectory Trajectory::step(double distance, double time, double duration) {
  require.finite("distance", distance);
  require.at_least_zero("time", time);
  return {Pieces{{-1.0, 0.0, 0.0, 0.0, 0.0}, {time, distance, 0.0, 0.0, 0.0}}, duration};
}

Trajectory Trajectory::trapezoid(double distance, double velocity, double acceleration,
                                 double duration) {
  require.finite("distance", distance);
  require.above_zero("velocity", velocity);
  require.above_zero("acceleration", acceleration);
  const double sign = distance < 0.0 ? -1.0 : 1.0;
  const double length = std::fabs(distance);
  const double peak = std::min(velocity, std::sqrt(acceleration * length));
  const double ramp = peak / acceleration;
  const double cruise = length > 0.0 ? length / peak - ramp : 0.0;
  const double covered = 0.5 * peak * ramp;
  return {Pieces{{0.0, 0.0, 0.0, sign * acceleration, 0.0},
                 {ramp, sign * covered, sign * peak, 0.0, 0.0},
                 {ramp + cruise, sign * (covered + peak * cruise), sign * peak,
                  -sign * acceleration, 0.0},
                 {2.0 * ramp + cruise, distance, 0.0, 0.0, 0.0}},
          duration};
}

Trajectory Trajectory::samples(const Eigen::VectorXd& time, const Eigen::VectorXd& position) {
  const Eigen::Index n = time.size();
  if (n < 2 || position.size() != n) {
    throw base::InputError(
        "time and position must have the same number of samples, at least two, got " +
            std::to_string(n) + " and " + std::to_string(position.size()),
        "Trajectory");
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    require.finite("time", time[i]);
    require.finite("position", position[i]);
    if (i > 0) require.that(time[i] > time[i - 1], "time", time[i], "strictly increasing");
  }
  const Eigen::VectorXd curvature = curvatures(time, position);
  Pieces pieces;
  pieces.reserve(static_cast<std::size_t>(n));
  for (Eigen::Index i = 0; i + 1 < n; ++i) {
    const double length = time[i + 1] - time[i];
    const double slope = (position[i + 1] - position[i]) / length -
                         length * (2.0 * curvature[i] + curvature[i + 1]) / 6.0;
    pieces.push_back({time[i] - time[0], position[i], slope, curvature[i],
                      (curvature[i + 1] - curvature[i]) / length});
  }
  pieces.push_back({time[n - 1] - time[0], position[n - 1], 0.0, 0.0, 0.0});
  return {std::move(pieces), time[n - 1] - time[0]};
}

Reference Trajectory::at(double time) const {
  return std::visit([&](const auto& form) { return value(form, time); }, form_);
}

void Trajectory::sample(double period, std::span<Reference> wanted) const {
  if (const auto* sines = std::get_if<Multisine>(&form_)) {
    sample(*sines, period, wanted);
    return;
  }
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    wanted[k] = at(static_cast<double>(k) * period);
  }
}

void Trajectory::sample(const Multisine& form, double period, std::span<Reference> wanted) {
  constexpr std::size_t kAnew = 64;  // samples after which the rotation restarts, to limit rounding
  std::fill(wanted.begin(), wanted.end(), Reference{});
  for (Eigen::Index i = 0; i < form.amplitude.size(); ++i) {
    const double rate = form.frequency[i];
    const double size = form.amplitude[i];
    const double turn_sine = base::sin(rate * period);
    const double turn_cosine = base::cos(rate * period);
    double sine = 0.0;
    double cosine = 0.0;
    for (std::size_t k = 0; k < wanted.size(); ++k) {
      if (k % kAnew == 0) {
        const double angle = rate * (static_cast<double>(k) * period) + form.phase[i];
        sine = size * base::sin(angle);
        cosine = size * base::cos(angle);
      } else {
        const double turned = sine * turn_cosine + cosine * turn_sine;
        cosine = cosine * turn_cosine - sine * turn_sine;
        sine = turned;
      }
      wanted[k].position += sine;
      wanted[k].velocity += rate * cosine;
      wanted[k].acceleration -= rate * rate * sine;
    }
  }
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    const double time = static_cast<double>(k) * period;
    const bool whole = form.fade <= 0.0 || (time >= form.fade && time <= form.duration - form.fade);
    if (!whole) wanted[k] = faded(wanted[k], envelope(form.duration, form.fade, time));
    wanted[k].position += form.offset;
  }
}

Reference Trajectory::value(const Multisine& form, double time) {
  Reference wanted{form.fade > 0.0 ? 0.0 : form.offset, 0.0, 0.0};
  for (Eigen::Index i = 0; i < form.amplitude.size(); ++i) {
    const double rate = form.frequency[i];
    const double angle = rate * time + form.phase[i];
    const double sine = form.amplitude[i] * base::sin(angle);
    wanted.position += sine;
    wanted.velocity += form.amplitude[i] * rate * base::cos(angle);
    wanted.acceleration -= rate * rate * sine;
  }
  if (form.fade > 0.0) {
    wanted = faded(wanted, envelope(form.duration, form.fade, time));
    wanted.position += form.offset;
  }
  return wanted;
}

Reference Trajectory::value(const Sigmoid& form, double time) {
  if (time >= form.rise) return {form.distance, 0.0, 0.0};
  const double rate = kPi / form.rise;
  const double angle = rate * std::max(time, 0.0);
  const double half = 0.5 * form.distance;
  return {half * (1.0 - base::cos(angle)), half * rate * base::sin(angle),
          half * rate * rate * base::cos(angle)};
}

Reference Trajectory::value(const Pieces& form, double time) {
  const auto after = std::upper_bound(form.begin(), form.end(), time,
                                      [](double t, const Piece& piece) { return t < piece.start; });
  if (after == form.begin()) return {form.front().position, 0.0, 0.0};
  const Piece& piece = *(after - 1);
  const double t = time - piece.start;
  return {
      piece.position + t * (piece.velocity + t * (0.5 * piece.acceleration + t * piece.jerk / 6.0)),
      piece.velocity + t * (piece.acceleration + 0.5 * t * piece.jerk),
      piece.acceleration + t * piece.jerk};
}

}  // namespace jointid::simulate
