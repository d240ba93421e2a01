#include "identify/recording.hpp"

#include "bind/bind.hpp"
#include "identify/windows.hpp"

namespace jointid::bind {

using identify::Hold;
using identify::Recording;
using identify::WindowOptions;

void bind_recording(py::module_& m) {
  py::native_enum<Hold>(m, "Hold", "enum.Enum", "How the torque signal lives between samples.")
      .value("zero_order", Hold::zero_order)
      .value("linear", Hold::linear)
      .finalize();
  py::class_<Recording>(m, "Recording", "Signals of one run, as the core keeps them (copied in).")
      .def(py::init([](Eigen::VectorXd time, Eigen::VectorXd position, Eigen::VectorXd velocity,
                       Eigen::VectorXd torque, std::optional<Eigen::VectorXd> sensor,
                       Hold torque_hold, std::vector<std::int64_t> gap_after) {
             Recording recording{
                 std::move(time), std::move(position), std::move(velocity), std::move(torque), {},
                 torque_hold,     std::move(gap_after)};
             if (sensor) recording.sensor = std::move(*sensor);
             recording.validate();
             return recording;
           }),
           py::kw_only(), py::arg("time"), py::arg("position"), py::arg("velocity"),
           py::arg("torque"), py::arg("sensor"), py::arg("torque_hold"), py::arg("gap_after"))
      .def_property_readonly("samples", &Recording::samples);
  m.def(
      "usable_intervals",
      [](const Recording& recording, bool mask_standstill) {
        return identify::usable_intervals(recording, mask_standstill).usable;
      },
      py::arg("recording"), py::arg("mask_standstill") = true,
      "One flag per sample interval: 1 where the joint moves and the recording has no gap.");
  value(
      m, "WindowOptions",
      "How to cut a recording into windows: a number, a duration, or neither (chosen from the "
      "noise).",
      Field{"count", &WindowOptions::count, "Number of windows; 0: not given."},
      Field{"duration", &WindowOptions::duration, "Length of a window [s]; 0: not given."},
      Field{"factor", &WindowOptions::factor, "Multiplies the duration, however chosen."},
      Field{
          "cumulative", &WindowOptions::cumulative,
          "Compare running integrals at the windows' ends (thesis's MATLAB), not each window's."});
}

}  // namespace jointid::bind
