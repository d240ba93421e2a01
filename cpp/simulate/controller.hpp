#pragma once
// Any of the controllers, and a running one: its state, its period, the limit on its torque. The
// simulator and a session on a real joint step the same object.

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <variant>

#include "simulate/adaptive_robust.hpp"
#include "simulate/lugre_observer.hpp"
#include "simulate/pid.hpp"

namespace jointid::simulate {

using Controller = std::variant<OpenLoop, Pd, Pid, CompensatedPid, AdaptiveRobust, LugreObserver>;

/// A running law.
template <class Law>
struct Running {
  Law config;
  typename Law::State state{};
};
using AnyRunning =
    std::variant<Running<OpenLoop>, Running<Pd>, Running<Pid>, Running<CompensatedPid>,
                 Running<AdaptiveRobust>, Running<LugreObserver>>;

// Structs, because clang 14 never instantiates generic lambdas in a class.
struct Begin {
  template <class Law>
  AnyRunning operator()(const Law& law) const {
    law.validate();
    return Running<Law>{law, {}};
  }
};

struct Ask {
  const ControlInput& input;

  template <class Law>
  double operator()(Running<Law>& running) const {
    return running.config.law(running.state, input);
  }
};

class ControlRun {
 public:
  ControlRun(const Controller& controller, double period, double torque_limit)
      : running_(std::visit(Begin{}, controller)), period_(period), torque_limit_(torque_limit) {
    const base::Requirement require("controller");
    require.above_zero("period", period);
    require.that(torque_limit > 0.0, "torque_limit", torque_limit, "above 0");
  }

  /// The torque to hold until the next step.
  double step(ControlInput input) {
    input.period = period_;
    const double asked = std::visit(Ask{input}, running_);
    if (std::fabs(asked) <= torque_limit_) return asked;
    ++saturations_;
    return std::clamp(asked, -torque_limit_, torque_limit_);
  }

  /// The same for external input, which is checked: a value that is not finite never reaches a
  /// joint.
  double checked_step(const ControlInput& input) {
    const base::Requirement require("step");
    require.finite("time", input.time);
    require.finite("position", input.position);
    require.finite("velocity", input.velocity);
    require.finite("sensor", input.reading);
    require.finite("reference", input.wanted.position);
    require.finite("reference_velocity", input.wanted.velocity);
    require.finite("reference_acceleration", input.wanted.acceleration);
    return step(input);
  }

  [[nodiscard]] double period() const { return period_; }
  [[nodiscard]] double torque_limit() const { return torque_limit_; }
  /// Number of steps in which the limit cut the torque.
  [[nodiscard]] long saturations() const { return saturations_; }

 private:
  AnyRunning running_;
  double period_;
  double torque_limit_;
  long saturations_ = 0;
};

}  // namespace jointid::simulate
