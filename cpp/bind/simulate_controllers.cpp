#include <limits>

#include "bind/simulate.hpp"

namespace jointid::bind {

using namespace simulate;

namespace {

constexpr const char* kStart =
    R"(Start the controller: return an object with a `step` that computes one torque.

Parameters
----------
period : float
    Time between steps [s].
torque_limit : float
    Limit on the magnitude of the torque [N·m]. Default: none.)";

template <class Law>
void add_start(py::class_<Law>& bound) {
  bound.def(
      "start",
      [](const Law& law, double period, double torque_limit) {
        return ControlRun(law, period, torque_limit);
      },
      py::arg("period"), py::arg("torque_limit") = std::numeric_limits<double>::max(), kStart);
}

/// `value` for a controller with a model of its joint: its own fields, then the estimates.
template <class Law, class... M>
py::class_<Law> compensating(py::module_& m, const char* name, const char* text,
                             Field<Law, M>... fields) {
  return value(
      m, name, text, fields...,
      inherited<Law>("inertia", &Estimates::inertia, "Estimated inertia of the drive [kg·m²]."),
      inherited<Law>("coulomb", &Estimates::coulomb, "Estimated Coulomb friction [N·m]."),
      inherited<Law>("static", &Estimates::static_excess,
                     "Estimated excess of static over Coulomb friction [N·m]."),
      inherited<Law>("stribeck", &Estimates::stribeck, "Estimated Stribeck coefficient [s²/rad²]."),
      inherited<Law>("viscous", &Estimates::viscous, "Estimated viscous friction [N·m·s/rad]."),
      inherited<Law>("sensor_gain", &Estimates::sensor_gain,
                     "Estimated gain of the torque sensor [N·m per unit of the reading]."),
      inherited<Law>("sensor_offset", &Estimates::sensor_offset,
                     "Estimated offset of the torque sensor [N·m]."),
      inherited<Law>("torque_feedback", &Estimates::torque_feedback,
                     "Compensate the link's torque that the torque sensor measures."),
      inherited<Law>("friction_velocity", &Estimates::friction_velocity,
                     "Compensate friction at the \"measured\" velocity or at the \"reference\" "
                     "velocity. The reference helps a joint that sticks."));
}

}  // namespace

void bind_controllers(py::module_& m) {
  py::class_<ControlRun>(m, "ControlRun", "A running controller, one step at a time.")
      .def(
          "step",
          [](ControlRun& run, double time, double position, double velocity, double sensor,
             double reference, double reference_velocity, double reference_acceleration) {
            return run.checked_step({time,
                                     position,
                                     velocity,
                                     sensor,
                                     {reference, reference_velocity, reference_acceleration},
                                     run.period()});
          },
          py::kw_only(), py::arg("time"), py::arg("position"), py::arg("velocity"),
          py::arg("sensor") = 0.0, py::arg("reference") = 0.0, py::arg("reference_velocity") = 0.0,
          py::arg("reference_acceleration") = 0.0,
          R"(Return the torque [N·m] to hold until the next step.

Parameters
----------
time, position, velocity : float
    [s], [rad], [rad/s], as measured.
sensor : float
    Raw reading of the torque sensor. Default 0.
reference, reference_velocity, reference_acceleration : float
    Desired motion [rad], [rad/s], [rad/s²]. Default 0.

Raises
------
ValueError
    One of them is not finite.)")
      .def_property_readonly("period", &ControlRun::period)
      .def_property_readonly("torque_limit", &ControlRun::torque_limit)
      .def_property_readonly("saturations", &ControlRun::saturations,
                             "Number of steps in which the limit cut the torque.");

  auto open_loop =
      value(m, "OpenLoop", "No feedback: the trajectory is the torque.",
            Field{"gain", &OpenLoop::gain, "Torque [N·m] per unit of the trajectory."});
  add_start(open_loop);
  auto pd = value(m, "Pd", "Proportional and derivative feedback.",
                  Field{"stiffness", &Pd::stiffness, "[N·m/rad]"},
                  Field{"damping", &Pd::damping, "[N·m·s/rad]"});
  add_start(pd);
  const auto stiffness = "[N·m/rad]";
  const auto integral = "Gain on the error's integral [N·m/(rad·s)].";
  const auto damping = "[N·m·s/rad]";
  const auto limit = "Limit on the torque of the integral [N·m], against wind-up.";
  auto pid =
      value(m, "Pid", "Proportional, integral and derivative feedback.",
            Field{"stiffness", &Pid::stiffness, stiffness},
            Field{"integral", &Pid::integral, integral}, Field{"damping", &Pid::damping, damping},
            Field{"integral_limit", &Pid::integral_limit, limit});
  add_start(pid);
  using Fixed = CompensatedPid;
  auto fixed = compensating<Fixed>(m, "CompensatedPid",
                                   "PID with a fixed model: inertia and friction are fed forward, "
                                   "the sensed torque is fed back.",
                                   inherited<Fixed>("stiffness", &Pid::stiffness, stiffness),
                                   inherited<Fixed>("integral", &Pid::integral, integral),
                                   inherited<Fixed>("damping", &Pid::damping, damping),
                                   inherited<Fixed>("integral_limit", &Pid::integral_limit, limit));
  add_start(fixed);
  using Robust = AdaptiveRobust;
  auto robust = compensating<Robust>(
      m, "AdaptiveRobust", R"(The decomposition-based adaptive and robust law (4-8 to 4-15).

With the filtered error r = ė + bandwidth · e, it commands the torque of its model of drive, friction and
sensed link torque, minus an adaptive and a robust term. All values are at the output of the gear:
`from_motor_side` converts gains of the motor side. Adaptation diverges on fast motion. The thesis's joint
with an encoder, moved by ±60° at 2 ms, tolerates a gain of 0.0005 (motor side) but not 0.001 in cycles of
6 s, and 0.0002 but not 0.0005 in cycles of 3 s.)",
      Field{"bandwidth", &Robust::bandwidth, "lambda [1/s]"},
      Field{"robust_term", &Robust::robust_term, "Whether the robust term acts."},
      Field{"robust_torque", &Robust::robust_torque,
            "rho, the torque outside the boundary layer [N·m]."},
      Field{"boundary", &Robust::boundary,
            "epsilon, the boundary layer of r [rad/s]; the robust term is linear inside."},
      Field{"adaptation", &Robust::adaptation, "Whether the law adapts friction."},
      Field{"adaptation_dry", &Robust::adaptation_dry,
            "Gain of the terms with the velocity's sign [N·m/rad]."},
      Field{"adaptation_viscous", &Robust::adaptation_viscous,
            "Gain of the terms with v and with the Stribeck coefficient [N·m·s²/rad³]."});
  robust.def_static("from_motor_side", &Robust::from_motor_side, py::kw_only(),
                    py::arg("gear_ratio"), py::arg("bandwidth") = 80.0,
                    py::arg("robust_torque") = 0.05, py::arg("boundary") = 0.9,
                    py::arg("adaptation_gain") = 0.0,
                    R"(Gains as on the motor side of a gear, without estimates of the joint.

Defaults: Table 6-1 of the thesis, with adaptation off (its table: 0.005, its code: 0.001).)");
  add_start(robust);
  using Observer = LugreObserver;
  auto observer = compensating<Observer>(
      m, "LugreObserver",
      "Friction compensation by an observer of its bristles (LuGre), with inertia and torque "
      "feedback.",
      Field{"bandwidth", &Observer::bandwidth, "Bandwidth of the tracking error [1/s]."},
      Field{"bristle_stiffness", &Observer::bristle_stiffness, "sigma_0 [N·m/rad]"},
      Field{"bristle_damping", &Observer::bristle_damping, "sigma_1 [N·m·s/rad]"},
      Field{"observer_gain", &Observer::observer_gain,
            "Gain of the filtered error on the bristles [1]."});
  add_start(observer);
}

}  // namespace jointid::bind
