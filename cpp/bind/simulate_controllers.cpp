#include <limits>

#include "bind/simulate.hpp"

namespace jointid::bind {

using namespace simulate;

namespace {

constexpr const char* kStart = R"(Start the controller: an object whose `step` gives one torque.

Parameters
----------
period : float
    Between steps [s].
torque_limit : float
    On the magnitude of the torque [N·m]. Default: none.)";

template <class Law>
void add_start(py::class_<Law>& bound) {
  bound.def(
      "start",
      [](const Law& law, double period, double torque_limit) {
        return ControlRun(law, period, torque_limit);
      },
      py::arg("period"), py::arg("torque_limit") = std::numeric_limits<double>::max(), kStart);
}

/// `value` for a controller that knows its joint: its own fields, then the estimates.
template <class Law, class... M>
py::class_<Law> compensating(py::module_& m, const char* name, const char* text,
                             Field<Law, M>... fields) {
  return value(
      m, name, text, fields...,
      inherited<Law>("inertia", &Estimates::inertia, "Estimate, of the drive [kg·m²]."),
      inherited<Law>("coulomb", &Estimates::coulomb, "Estimate [N·m]."),
      inherited<Law>("static", &Estimates::static_excess, "Estimate, excess over Coulomb [N·m]."),
      inherited<Law>("stribeck", &Estimates::stribeck, "Estimate [s²/rad²]."),
      inherited<Law>("viscous", &Estimates::viscous, "Estimate [N·m·s/rad]."),
      inherited<Law>("sensor_gain", &Estimates::sensor_gain, "Estimate [N·m per reading]."),
      inherited<Law>("sensor_offset", &Estimates::sensor_offset, "Estimate [N·m]."),
      inherited<Law>("torque_feedback", &Estimates::torque_feedback,
                     "Carry the link's torque as the torque sensor tells it."),
      inherited<Law>("friction_velocity", &Estimates::friction_velocity,
                     "Compensate friction for the \"measured\" velocity, or the \"reference\" one, "
                     "which helps a joint that sticks."));
}

}  // namespace

void bind_controllers(py::module_& m) {
  py::class_<ControlRun>(m, "ControlRun", "A controller at work, one step at a time.")
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
                             "How often the limit cut the torque.");

  auto open_loop =
      value(m, "OpenLoop", "No feedback: the trajectory is read as the torque.",
            Field{"gain", &OpenLoop::gain, "Torque [N·m] per unit of the trajectory."});
  add_start(open_loop);
  auto pd = value(m, "Pd", "Proportional and derivative feedback.",
                  Field{"stiffness", &Pd::stiffness, "[N·m/rad]"},
                  Field{"damping", &Pd::damping, "[N·m·s/rad]"});
  add_start(pd);
  const auto stiffness = "[N·m/rad]";
  const auto integral = "Of the error's integral [N·m/(rad·s)].";
  const auto damping = "[N·m·s/rad]";
  const auto limit = "On the torque of the integral [N·m], against wind-up.";
  auto pid =
      value(m, "Pid", "Proportional, integral and derivative feedback.",
            Field{"stiffness", &Pid::stiffness, stiffness},
            Field{"integral", &Pid::integral, integral}, Field{"damping", &Pid::damping, damping},
            Field{"integral_limit", &Pid::integral_limit, limit});
  add_start(pid);
  using Fixed = CompensatedPid;
  auto fixed = compensating<Fixed>(
      m, "CompensatedPid",
      "PID with a fixed model: inertia and friction fed forward, the sensed torque fed back.",
      inherited<Fixed>("stiffness", &Pid::stiffness, stiffness),
      inherited<Fixed>("integral", &Pid::integral, integral),
      inherited<Fixed>("damping", &Pid::damping, damping),
      inherited<Fixed>("integral_limit", &Pid::integral_limit, limit));
  add_start(fixed);
  using Robust = AdaptiveRobust;
  auto robust = compensating<Robust>(
      m, "AdaptiveRobust", R"(The decomposition-based adaptive and robust law (4-8 to 4-15).

With the filtered error r = ė + bandwidth · e it asks for the torque that its model of drive, friction
and sensed link torque gives, less an adaptive and a robust term. All at the output of the gear:
`from_motor_side` converts gains of the motor's side. Adaptation diverges on fast motion: the thesis's
joint with an encoder, moved by ±60° at 2 ms, takes a gain of 0.0005 (motor's side) in cycles of 6 s but
not 0.001, and 0.0002 in cycles of 3 s but not 0.0005.)",
      Field{"bandwidth", &Robust::bandwidth, "lambda [1/s]"},
      Field{"robust_term", &Robust::robust_term, "Whether the robust term acts."},
      Field{"robust_torque", &Robust::robust_torque, "rho, outside the boundary layer [N·m]."},
      Field{"boundary", &Robust::boundary, "epsilon, on r [rad/s]; inside the term is linear."},
      Field{"adaptation", &Robust::adaptation, "Whether friction is adapted."},
      Field{"adaptation_dry", &Robust::adaptation_dry,
            "Gain of the terms in the velocity's sign [N·m/rad]."},
      Field{"adaptation_viscous", &Robust::adaptation_viscous,
            "Gain of the terms in v and in the Stribeck coefficient [N·m·s²/rad³]."});
  robust.def_static("from_motor_side", &Robust::from_motor_side, py::kw_only(),
                    py::arg("gear_ratio"), py::arg("bandwidth") = 80.0,
                    py::arg("robust_torque") = 0.05, py::arg("boundary") = 0.9,
                    py::arg("adaptation_gain") = 0.0,
                    R"(Gains as on the motor's side of a gear, without estimates of the joint.

Defaults: Table 6-1 of the thesis, adaptation off (its table: 0.005, its code: 0.001).)");
  add_start(robust);
  using Observer = LugreObserver;
  auto observer = compensating<Observer>(
      m, "LugreObserver",
      "Friction compensated by an observer of its bristles (LuGre), around inertia and torque "
      "feedback.",
      Field{"bandwidth", &Observer::bandwidth, "Of the tracking error [1/s]."},
      Field{"bristle_stiffness", &Observer::bristle_stiffness, "sigma_0 [N·m/rad]"},
      Field{"bristle_damping", &Observer::bristle_damping, "sigma_1 [N·m·s/rad]"},
      Field{"observer_gain", &Observer::observer_gain,
            "How much of the filtered error moves the bristles [1]."});
  add_start(observer);
}

}  // namespace jointid::bind
