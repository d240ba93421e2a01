#include "bind/simulate.hpp"
#include "simulate/servo_loop.hpp"

namespace jointid::bind {

using simulate::ServoLog;
using simulate::ServoLoop;

namespace {

using Signal = py::array_t<double, py::array::c_style | py::array::forcecast>;

std::span<const double> numbers(const Signal& signal, py::ssize_t count) {
  if (signal.ndim() != 1 || signal.size() != count) {
    throw std::invalid_argument("the signals of a log must have one length");
  }
  return {signal.data(), static_cast<std::size_t>(count)};
}

py::array_t<double> copy_of(const std::vector<double>& values) {
  return py::array_t<double>(static_cast<py::ssize_t>(values.size()), values.data());
}

}  // namespace

void bind_servo(py::module_& m) {
  value(m, "ServoLoop", "A servo with its position loop, as the core simulates it.",
        Field{"joint", &ServoLoop::joint, "The moved joint, without friction of the load."},
        Field{"torque_per_voltage", &ServoLoop::torque_per_voltage, "k_t / R [N·m/V]."},
        Field{"back_emf", &ServoLoop::back_emf, "k_t² / R while driven [N·m·s/rad]."},
        Field{"load_friction", &ServoLoop::load_friction,
              "Dry friction per torque through the gear [1]."},
        Field{"closed", &ServoLoop::closed,
              "Whether the command is the desired position; otherwise it is the duty itself."},
        Field{"gain", &ServoLoop::gain, "Duty per error [1/rad]."},
        Field{"saturation", &ServoLoop::saturation, "Limit of the duty."},
        Field{"delay", &ServoLoop::delay, "Delay from the error to the duty [s]."},
        Field{"position", &ServoLoop::position, "Position at the start [rad]."},
        Field{"velocity", &ServoLoop::velocity, "Velocity at the start [rad/s]."});
  m.def(
      "roll_out_servos",
      [](const std::vector<ServoLoop>& loops, const std::vector<std::array<Signal, 4>>& logs,
         double step, int threads) {
        if (loops.size() != logs.size())
          throw std::invalid_argument("one log per loop is expected");
        std::vector<ServoLog> views;
        views.reserve(logs.size());
        for (const auto& [time, command, supply, driven] : logs) {
          const py::ssize_t count = time.size();
          views.push_back({numbers(time, count), numbers(command, count), numbers(supply, count),
                           numbers(driven, count)});
        }
        std::vector<simulate::ServoMotion> motions;
        {
          const py::gil_scoped_release nogil;
          base::Pool pool(threads, SignalPoll{});
          motions = simulate::roll_out(loops, views, step, pool);
        }
        std::vector<std::pair<py::array_t<double>, py::array_t<double>>> result;
        result.reserve(motions.size());
        for (const auto& motion : motions) {
          result.emplace_back(copy_of(motion.position), copy_of(motion.velocity));
        }
        return result;
      },
      py::arg("loops"), py::arg("logs"), py::kw_only(), py::arg("step"), py::arg("threads") = 0,

      "Return position and velocity at each sample of each log. A log is time, command, supply and "
      "driven.");
}

}  // namespace jointid::bind
