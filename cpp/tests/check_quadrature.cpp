// Window integrals compared with closed forms.

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/random.hpp"
#include "check.hpp"
#include "identify/balance/quadrature.hpp"
#include "synthetic.hpp"

namespace jointid::tests {
namespace {

using identify::FrictionNodes;
using identify::Integral;
using identify::Recording;
using identify::Window;

/// Velocity start + slope t, position its integral.
Recording ramp(int samples, double duration, double start, double slope) {
  Recording r;
  r.time = Eigen::VectorXd::LinSpaced(samples, 0.0, duration);
  r.velocity = start + slope * r.time.array();
  r.position = start * r.time.array() + 0.5 * slope * r.time.array().square();
  r.torque.setZero(samples);
  return r;
}

struct Whole {
  explicit Whole(const Recording& r)
      : usable(static_cast<std::size_t>(r.samples() - 1), 1), windows{{0, r.samples() - 1}} {}
  std::vector<std::uint8_t> usable;
  std::vector<Window> windows;
};

identify::Term term_of(Integral integral) {
  for (const auto& term : identify::term_table()) {
    if (term.integral == integral && term.harmonic == identify::Harmonic::none) return term;
  }
  throw std::logic_error("no such term");
}

double integral_of(const identify::Term& term, const Recording& r, double gear_ratio = 1.0) {
  const Whole whole(r);
  Eigen::VectorXd result(1);
  identify::integrate(term, gear_ratio, r, whole.usable, whole.windows, result);
  return result[0];
}

double integral_of(Integral integral, const Recording& r) {
  return integral_of(term_of(integral), r);
}

double sign(double v) {
  return v > 0.0 ? 1.0 : (v < 0.0 ? -1.0 : 0.0);
}

const identify::Term kStatic = identify::find_term("static");

/// A column and its derivative by the only shape.
void decayed_column(const FrictionNodes& nodes, double shape, const base::Cancel* cancel,
                    Eigen::VectorXd& column, Eigen::VectorXd* change) {
  identify::integrate_friction(kStatic, nodes, &shape, cancel, column);
  if (change != nullptr) {
    Eigen::MatrixXd both(column.size(), 2);
    identify::integrate_slopes(kStatic, nodes, &shape, cancel, both);
    CHECK(both.col(0) == column);
    *change = both.col(1);
  }
}

double friction_of(const Recording& r, double shape, double* slope = nullptr) {
  const Whole whole(r);
  FrictionNodes nodes;
  identify::append_nodes(r, whole.usable, whole.windows, nodes);
  Eigen::VectorXd column(1);
  Eigen::VectorXd change(1);
  decayed_column(nodes, shape, nullptr, column, &change);
  if (slope != nullptr) *slope = change[0];
  return column[0];
}

/// Integral of exp(-s v^2) over v from 0 to v.
double decayed(double shape, double v) {
  return 0.5 * std::sqrt(std::numbers::pi / shape) * std::erf(std::sqrt(shape) * v);
}

CHECK_CASE("quadrature: constant velocity") {
  for (const double v : {0.7, -0.7}) {
    const auto r = ramp(101, 2.0, v, 0.0);
    CHECK_CLOSE(integral_of(Integral::friction, r), std::copysign(2.0, v), 1e-14);
    CHECK_CLOSE(integral_of(Integral::displacement, r), 2.0 * v, 1e-14);
    CHECK_CLOSE(integral_of(Integral::velocity_change, r), 0.0, 1e-15);
    CHECK_CLOSE(integral_of(Integral::duration, r), 2.0, 1e-14);
    CHECK_CLOSE(friction_of(r, 3.0), std::copysign(2.0 * std::exp(-3.0 * v * v), v), 1e-14);
    // Integral of cos(v t): sin(v T) / v, second order in the step.
    CHECK_CLOSE(integral_of(Integral::cosine, r), std::sin(2.0 * v) / v, 1e-4);
    CHECK_CLOSE(integral_of(Integral::sine, r), (1.0 - std::cos(2.0 * v)) / v, 1e-4);
  }
}

CHECK_CASE("quadrature: a reversal anywhere in an interval counts exactly") {
  base::Random random(1, 0, 0, 0);
  for (int trial = 0; trial < 500; ++trial) {
    const double turn = 0.02 + 0.96 * random.uniform();
    const double slope = (random.uniform() < 0.5 ? -1.0 : 1.0) * (0.1 + 5.0 * random.uniform());
    const auto r = ramp(3 + static_cast<int>(random.below(40)), 1.0, -slope * turn, slope);
    const double exact = std::copysign(1.0 - 2.0 * turn, slope);
    CHECK_CLOSE(integral_of(Integral::friction, r), slope > 0 ? 1.0 - 2.0 * turn : 2.0 * turn - 1.0,
                1e-12);
    CHECK_CLOSE(std::fabs(exact), std::fabs(integral_of(Integral::friction, r)), 1e-12);
    CHECK_CLOSE(integral_of(Integral::velocity_change, r), slope, 1e-13);
    CHECK_CLOSE(integral_of(Integral::displacement, r), slope * (0.5 - turn), 1e-12);
  }
}

CHECK_CASE("quadrature: a reversal exactly on a sample") {
  const auto r = ramp(11, 1.0, -0.5, 1.0);
  CHECK_CLOSE(r.velocity[5], 0.0, 1e-16);
  CHECK_CLOSE(integral_of(Integral::friction, r), 0.0, 1e-15);
}

CHECK_CASE("quadrature: static friction over a ramp is second order to the error function") {
  const double shape = 40.0;
  for (const double start : {0.05, -0.313}) {
    const double slope = 0.9;
    const double end = start + slope;
    // Odd in v: from -|start| back to 0 it counts negative.
    const double exact = (decayed(shape, end) - decayed(shape, std::fabs(start))) / slope;
    for (const int samples : {51, 101, 201, 401, 1601}) {
      const double found = friction_of(ramp(samples, 1.0, start, slope), shape);
      const double step = 1.0 / (samples - 1);
      // The bound of the trapezoidal rule: step^2 / 12 times the largest second derivative over
      // time.
      CHECK_CLOSE(found, exact, step * step / 12.0 * 2.0 * shape * slope * slope);
    }
  }
}

CHECK_CASE("quadrature: the shape's slope matches finite differences") {
  auto r = moving(1500, 0.004, true, 2);
  for (const double shape : {0.0, 0.5, 7.0, 60.0, 200.0}) {
    const double step = 1e-5 * (1.0 + shape);
    double slope = 0.0;
    friction_of(r, shape, &slope);
    const double above = friction_of(r, shape + step);
    const double below = friction_of(r, shape - step);
    CHECK_CLOSE(slope, (above - below) / (2.0 * step), 1e-6 * std::fabs(slope) + 1e-8);
  }
}

CHECK_CASE("quadrature: a held torque and a measured one") {
  auto r = ramp(6, 1.0, 1.0, 0.0);
  r.time << 0.0, 0.1, 0.3, 0.4, 0.8, 1.0;
  r.torque << 1.0, 2.0, 4.0, -1.0, 0.5, 100.0;
  const Whole whole(r);
  Eigen::VectorXd result(1);
  r.torque_hold = identify::Hold::zero_order;
  identify::integrate_torque(r, whole.usable, whole.windows, result);
  CHECK_CLOSE(result[0], 0.1 * 1.0 + 0.2 * 2.0 + 0.1 * 4.0 - 0.4 * 1.0 + 0.2 * 0.5, 1e-14);
  r.torque_hold = identify::Hold::linear;
  identify::integrate_torque(r, whole.usable, whole.windows, result);
  CHECK_CLOSE(result[0], 0.1 * 1.5 + 0.2 * 3.0 + 0.1 * 1.5 - 0.4 * 0.25 + 0.2 * 50.25, 1e-13);
}

CHECK_CASE("quadrature: windows and unusable intervals, compared with one interval at a time") {
  const auto r = moving(9000, 0.003, true, 3);  // several blocks of nodes
  std::vector<std::uint8_t> usable(8999, 1);
  base::Random random(4, 0, 0, 0);
  for (auto& flag : usable) flag = random.uniform() < 0.1 ? 0 : 1;
  std::fill(usable.begin() + 4000, usable.begin() + 4100, std::uint8_t{0});
  std::vector<Window> windows;
  for (std::int64_t begin = 0; begin < 8999;) {
    const auto end = std::min<std::int64_t>(8999, begin + 1 + random.below(60));
    windows.push_back({begin, end});
    begin = end + (random.uniform() < 0.2 ? 1 : 0);  // some intervals belong to no window
  }
  const auto count = static_cast<Eigen::Index>(windows.size());
  FrictionNodes nodes;
  identify::append_nodes(r, usable, windows, nodes);
  CHECK(nodes.first.size() == windows.size() + 1);
  Eigen::VectorXd column(count);
  Eigen::VectorXd change(count);
  Eigen::VectorXd moved(count);
  decayed_column(nodes, 30.0, nullptr, column, &change);
  identify::integrate(term_of(Integral::displacement), 1.0, r, usable, windows, moved);
  const auto decay = [](long double v) { return std::exp(-30.0L * v * v); };
  const auto slope = [](long double v) { return -v * v * std::exp(-30.0L * v * v); };
  for (Eigen::Index w = 0; w < count; ++w) {
    const auto& window = windows[static_cast<std::size_t>(w)];
    long double sum = 0;
    long double slope_sum = 0;
    long double displacement = 0;
    for (auto k = window.begin; k < window.end; ++k) {
      if (usable[static_cast<std::size_t>(k)] == 0) continue;
      const long double step = static_cast<long double>(r.time[k + 1]) - r.time[k];
      sum += friction_over(r.velocity[k], r.velocity[k + 1], step, decay);
      slope_sum += friction_over(r.velocity[k], r.velocity[k + 1], step, slope);
      displacement += static_cast<long double>(r.position[k + 1]) - r.position[k];
    }
    CHECK_CLOSE(column[w], sum, 1e-15);
    CHECK_CLOSE(change[w], slope_sum, 1e-15);
    CHECK_CLOSE(moved[w], displacement, 1e-14);
  }
}

CHECK_CASE("quadrature: windows without a usable interval integrate to zero") {
  const auto r = ramp(21, 1.0, 1.0, 1.0);
  const std::vector<std::uint8_t> none(20, 0);
  const std::vector<Window> windows{{0, 7}, {7, 20}};
  FrictionNodes nodes;
  identify::append_nodes(r, none, windows, nodes);
  Eigen::VectorXd column = Eigen::VectorXd::Constant(2, 99.0);
  Eigen::VectorXd change = column;
  decayed_column(nodes, 1.0, nullptr, column, &change);
  CHECK(column.isZero(0.0) && change.isZero(0.0));
  identify::integrate(term_of(Integral::duration), 1.0, r, none, windows, column);
  CHECK(column.isZero(0.0));
}

CHECK_CASE("quadrature: Simpson's rule minus the trapezoidal rule, where nothing reverses") {
  const auto r = ramp(40, 1.0, -0.4, 1.0);
  std::vector<std::uint8_t> usable(39, 1);
  usable[30] = 0;
  const std::vector<Window> windows{{0, 12}, {12, 25}, {25, 39}};
  const double shape = 4.0;
  const auto friction = [&](double v) { return sign(v) * std::exp(-shape * v * v); };
  Eigen::VectorXd bent(3);
  identify::integrate_bending(kStatic, Eigen::VectorXd::Constant(1, shape), r, usable, windows,
                              bent);
  for (Eigen::Index w = 0; w < 3; ++w) {
    double sum = 0.0;
    const auto& window = windows[static_cast<std::size_t>(w)];
    for (auto k = window.begin; k < window.end; ++k) {
      const double before = r.velocity[k];
      const double after = r.velocity[k + 1];
      if (usable[static_cast<std::size_t>(k)] == 0 || before * after < 0.0) continue;
      const double mean = 0.5 * (friction(before) + friction(after));
      const double simpson = (mean + 2.0 * friction(0.5 * (before + after))) / 3.0;
      sum += (simpson - mean) * (r.time[k + 1] - r.time[k]);
    }
    CHECK_CLOSE(bent[w], sum, 1e-15);
  }
}

CHECK_CASE("quadrature: reads the cancel flag") {
  const auto r = ramp(10'000, 1.0, 1.0, 1.0);
  const Whole whole(r);
  FrictionNodes nodes;
  identify::append_nodes(r, whole.usable, whole.windows, nodes);
  base::Cancel cancel;
  Eigen::VectorXd column(1);
  decayed_column(nodes, 1.0, &cancel, column, nullptr);
  cancel.request();
  bool cancelled = false;
  try {
    decayed_column(nodes, 1.0, &cancel, column, nullptr);
  } catch (const base::Cancelled&) {
    cancelled = true;
  }
  CHECK(cancelled);
}

CHECK_CASE("quadrature: separate directions add up to both") {
  const auto r = ramp(1001, 2.0, -0.7, 1.0);  // reverses inside an interval
  for (const std::string name : {"coulomb", "static"}) {
    const Whole whole(r);
    FrictionNodes nodes;
    identify::append_nodes(r, whole.usable, whole.windows, nodes);
    const double shape = 40.0;
    const auto column = [&](const std::string& key) {
      const auto term = identify::find_term(key);
      Eigen::VectorXd result(1);
      identify::integrate_friction(term, identify::nodes_of(term.direction, nodes), &shape, nullptr,
                                   result);
      return result[0];
    };
    CHECK(column(name + "_positive") > 0.0);
    CHECK(column(name + "_negative") < 0.0);
    CHECK_CLOSE(column(name + "_positive") + column(name + "_negative"), column(name), 1e-14);
  }
  // Viscous friction of one direction is the travel in that direction: 0.5 (1.3^2) and 0.5 (0.7^2).
  CHECK_CLOSE(integral_of(identify::find_term("viscous_positive"), r), 0.845, 1e-5);
  CHECK_CLOSE(integral_of(identify::find_term("viscous_negative"), r), -0.245, 1e-5);
}

CHECK_CASE("quadrature: Coulomb friction of one direction exists only in that direction") {
  for (const double v : {0.7, -0.7}) {
    const auto r = ramp(101, 2.0, v, 0.0);
    const auto of = [&](const char* key) { return integral_of(identify::find_term(key), r); };
    CHECK_CLOSE(of("coulomb_positive"), v > 0.0 ? 2.0 : 0.0, 1e-14);
    CHECK_CLOSE(of("coulomb_negative"), v > 0.0 ? 0.0 : -2.0, 1e-14);
  }
}

CHECK_CASE("quadrature: a sample at rest has no direction, at any place in a window") {
  for (const double side : {1.0, -1.0}) {
    for (const Eigen::Index rest : {0, 4, 10}) {
      auto r = ramp(11, 1.0, 0.5 * side, 0.0);
      r.velocity[rest] = 0.0;
      // Half of each neighbouring interval is without friction.
      const double time = rest == 4 ? 0.9 : 0.95;
      CHECK_CLOSE(integral_of(Integral::friction, r), side * time, 1e-14);
      CHECK_CLOSE(friction_of(r, 3.0), side * time * std::exp(-0.75), 1e-14);
    }
  }
}

CHECK_CASE("quadrature: harmonics count revolutions of the joint or of the motor") {
  const auto r = ramp(20001, 2.0, 0.7, 0.0);
  const auto integral = [](double frequency) {
    return (1.0 - std::cos(1.4 * frequency)) / (0.7 * frequency);
  };
  CHECK_CLOSE(integral_of(identify::find_term("position_sin_3"), r, 101.0), integral(3.0), 1e-7);
  CHECK_CLOSE(integral_of(identify::find_term("ripple_sin_2"), r, 101.0), integral(202.0), 1e-5);
  CHECK_CLOSE(integral_of(identify::find_term("ripple_cos_0.5"), r, 10.0),
              std::sin(5.0 * 1.4) / (0.7 * 5.0), 1e-7);
}

}  // namespace
}  // namespace jointid::tests
