#include "bind/simulate.hpp"

#include "simulate/stepped_joint.hpp"

namespace jointid::bind {

using namespace simulate;

namespace {

/// Read-only, so that a recording can take the array without a copy.
py::array_t<double> array_of(const std::vector<double>& values) {
  py::array_t<double> array(static_cast<py::ssize_t>(values.size()), values.data());
  array.attr("flags").attr("writeable") = false;
  return array;
}

py::dict signals_of(const Outcome& outcome) {
  const Signals& s = outcome.signals;
  py::dict result;
  result["position"] = array_of(s.position);
  result["velocity"] = array_of(s.velocity);
  result["torque"] = array_of(s.torque);
  result["reading"] = array_of(s.reading);
  result["reference"] = array_of(s.reference);
  result["true_position"] = array_of(s.true_position);
  result["true_velocity"] = array_of(s.true_velocity);
  result["true_acceleration"] = array_of(s.true_acceleration);
  result["friction"] = array_of(s.friction);
  result["link_torque"] = array_of(s.link_torque);
  return result;
}

void bind_trajectory(py::module_& m) {
  py::class_<Trajectory>(m, "Trajectory", "A desired motion; use it through jointid.Trajectory.")
      .def_static("multisine", &Trajectory::multisine, py::kw_only(), py::arg("amplitude"),
                  py::arg("frequency"), py::arg("phase"), py::arg("offset"), py::arg("duration"),
                  py::arg("fade") = 0.0)
      .def_static("sigmoid", &Trajectory::sigmoid, py::kw_only(), py::arg("distance"),
                  py::arg("rise"), py::arg("duration"))
      .def_static("step", &Trajectory::step, py::kw_only(), py::arg("distance"), py::arg("time"),
                  py::arg("duration"))
      .def_static("trapezoid", &Trajectory::trapezoid, py::kw_only(), py::arg("distance"),
                  py::arg("velocity"), py::arg("acceleration"), py::arg("duration"))
      .def_static("samples", &Trajectory::samples, py::kw_only(), py::arg("time"),
                  py::arg("position"))
      .def(
          "at",
          [](const Trajectory& trajectory, double time) {
            const Reference wanted = trajectory.at(time);
            return py::make_tuple(wanted.position, wanted.velocity, wanted.acceleration);
          },
          py::arg("time"), "Return position, velocity and acceleration at a time.")
      .def(
          "sample",
          [](const Trajectory& trajectory, const Eigen::VectorXd& time) {
            Eigen::MatrixXd wanted(time.size(), 3);
            for (Eigen::Index i = 0; i < time.size(); ++i) {
              const Reference one = trajectory.at(time[i]);
              wanted.row(i) << one.position, one.velocity, one.acceleration;
            }
            return wanted;
          },
          py::arg("time"), "Return position, velocity and acceleration, shape (times, 3).")
      .def_property_readonly("duration", &Trajectory::duration);
}

void bind_joint(py::module_& m) {
  using model::Joint;
  value(m, "SimulatedJoint", "A joint as the core simulates it: output side, SI units.",
        Field{"inertia", &Joint::inertia, "Inertia of the drive [kg·m²]."},
        Field{"link_inertia", &Joint::link_inertia, "Inertia behind the torque sensor [kg·m²]."},
        Field{"load", &Joint::load, "Constant torque behind the sensor [N·m]."},
        Field{"torque_offset", &Joint::torque_offset, "Constant torque in the drive [N·m]."},
        Field{"torque_limit", &Joint::torque_limit, "Torque limit of the drive [N·m]."},
        Field{"friction", &Joint::friction,
              "Basis, coefficients of positive and negative velocity, and shapes of each term."},
        Field{"load_friction", &Joint::load_friction, "Dry friction per torque of the drive [1]."},
        Field{"bristles", &Joint::bristles, "Friction behind a spring (Dahl, LuGre)."},
        Field{"bristle_stiffness", &Joint::bristle_stiffness, "[N·m/rad]"},
        Field{"bristle_damping", &Joint::bristle_damping, "[N·m·s/rad]"},
        Field{"weights", &Joint::weights, "Torque [N·m] and angle [rad] of each weight."},
        Field{"harmonics", &Joint::harmonics, "Order [1], cosine and sine part [N·m]."});
}

void bind_scenario(py::module_& m) {
  value(m, "Scenario", "Settings that all simulations of a batch share.",
        Field{"duration", &Scenario::duration, "[s]"},
        Field{"control_period", &Scenario::control_period, "Time for which a command is held [s]."},
        Field{"integration_step", &Scenario::integration_step,
              "Step of the integration [s]; the control period is a multiple of it."},
        Field{"sample_every", &Scenario::sample_every, "Control periods per recorded sample."},
        Field{"settling", &Scenario::settling,
              "Time at the start that the tracking error leaves out [s]."},
        Field{"sensors", &Scenario::sensors, "The sensors."});
  value(m, "Setup", "One simulation of a batch.",
        Field{"joint", &Setup::joint, "The simulated joint."},
        Field{"controller", &Setup::controller, "The controller, of any kind."},
        Field{"gear_ratio", &Setup::gear_ratio, "Motor angle per output angle."},
        Field{"sensor_gain", &Setup::sensor_gain, "Torque per unit of the reading."},
        Field{"sensor_offset", &Setup::sensor_offset, "[N·m]"},
        Field{"position", &Setup::position, "Position at the start [rad]."},
        Field{"velocity", &Setup::velocity, "Velocity at the start [rad/s]."},
        Field{"seed", &Setup::seed, "Seed of the noise."});
  py::class_<Outcome>(m, "Outcome", "The result of one simulation.")
      .def_property_readonly("signals", &signals_of, "Recorded and true signals by name.")
      .def_readonly("rms_error", &Outcome::rms_error, "RMS tracking error after settling [rad].")
      .def_readonly("peak_error", &Outcome::peak_error, "Peak tracking error after settling [rad].")
      .def_readonly("saturations", &Outcome::saturations,
                    "Number of control periods in which the torque limit cut the command.");
}

void bind_stepped(py::module_& m) {
  py::class_<Observation>(m, "Observation", "Values of the sensors at one instant.")
      .def_readonly("position", &Observation::position, "[rad]")
      .def_readonly("velocity", &Observation::velocity, "[rad/s]")
      .def_readonly("reading", &Observation::reading, "Reading of the torque sensor.");
  py::class_<SteppedJoint>(m, "SteppedJoint", "A simulated joint that is moved step by step.")
      .def(py::init([](const model::Joint& joint, const Sensors& sensors, double gear_ratio,
                       double sensor_gain, double sensor_offset, double period, double step,
                       double position, double velocity, std::uint64_t seed) {
             return SteppedJoint({joint, sensors, gear_ratio, sensor_gain, sensor_offset, period,
                                  step, position, velocity, seed});
           }),
           py::kw_only(), py::arg("joint"), py::arg("sensors"), py::arg("gear_ratio"),
           py::arg("sensor_gain"), py::arg("sensor_offset"), py::arg("period"), py::arg("step"),
           py::arg("position"), py::arg("velocity"), py::arg("seed"))
      .def("advance", &SteppedJoint::advance, py::arg("torque"), py::arg("duration"),
           "Hold a torque [N·m] for a time [s].")
      .def("observe", &SteppedJoint::observe,
           "Return the values of the sensors, and advance their noise.")
      .def_property_readonly("time", &SteppedJoint::time, "[s]")
      .def_property_readonly("position", &SteppedJoint::position, "[rad]")
      .def_property_readonly("velocity", &SteppedJoint::velocity, "[rad/s]")
      .def_property_readonly("link_torque", &SteppedJoint::link_torque, "[N·m]");
}

}  // namespace

void bind_simulate(py::module_& m) {
  bind_trajectory(m);
  bind_joint(m);
  bind_sensors(m);
  bind_controllers(m);
  bind_scenario(m);
  bind_stepped(m);
  bind_servo(m);
  m.def(
      "simulate_runs",
      [](const Scenario& scenario, const Trajectory& trajectory, const std::vector<Setup>& setups,
         bool signals, int threads) {
        const py::gil_scoped_release nogil;
        base::Pool pool(threads, SignalPoll{});
        return simulate::simulate(scenario, trajectory, setups, signals, pool);
      },
      py::arg("scenario"), py::arg("trajectory"), py::arg("setups"), py::kw_only(),
      py::arg("signals"), py::arg("threads") = 0,
      "Return one Outcome per setup. Raise InputError when a loop is not stable.");
}

}  // namespace jointid::bind
