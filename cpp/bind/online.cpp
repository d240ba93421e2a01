#include "bind/recording.hpp"
#include "identify/compressed/sliding_penalty.hpp"
#include "identify/recording/windows.hpp"

namespace jointid::bind {

using identify::MotionScale;
using identify::SlidingPenalty;

void bind_online(py::module_& m) {
  py::class_<MotionScale>(m, "MotionScale",
                          "Scale of a motion, with which the mask compares speeds.")
      .def(py::init([](SharedRecording& recording) {
             const py::gil_scoped_release nogil;
             return identify::motion_scale(recording.view());
           }),
           py::arg("recording"))
      .def_readonly("peak", &MotionScale::peak, "Largest speed.")
      .def_readonly("travel", &MotionScale::travel,
                    "Distance from the lowest position to the highest.")
      .def_property_readonly("moves", &MotionScale::moves)
      .def_property_readonly(
          "memory", &MotionScale::memory,
          "Time at rest that distinguishes a standing joint from a slow one [s].");
  m.def(
      "window_duration",
      [](SharedRecording& recording, std::int64_t parameters, bool mask_standstill) {
        const py::gil_scoped_release nogil;
        return identify::choose_window(*recording.masked(mask_standstill, nullptr), parameters)
            .duration;
      },
      py::arg("recording"), py::arg("parameters"), py::arg("mask_standstill"),
      "Duration of a window that the velocity's noise requires [s].");
  py::class_<SlidingPenalty>(m, "SlidingPenalty",
                             "The penalty over the last seconds of a continuing motion.")
      .def(py::init([](std::vector<std::string> terms, identify::Residual residual,
                       double gear_ratio, double window_duration, bool mask_standstill,
                       const MotionScale& scale, Eigen::VectorXd lower, Eigen::VectorXd upper,
                       double speed) {
             return SlidingPenalty(std::move(terms), residual, gear_ratio, window_duration,
                                   mask_standstill, scale, {std::move(lower), std::move(upper)},
                                   speed);
           }),
           py::kw_only(), py::arg("terms"), py::arg("residual"), py::arg("gear_ratio"),
           py::arg("window_duration"), py::arg("mask_standstill"), py::arg("scale"),
           py::arg("lower"), py::arg("upper"), py::arg("speed"))
      .def(
          "append",
          [](SlidingPenalty& p, const std::shared_ptr<SharedRecording>& samples, Eigen::Index begin,
             Eigen::Index end) { p.append(samples->view(), begin, end); },
          py::arg("samples"), py::arg("begin"), py::arg("end"),
          py::call_guard<py::gil_scoped_release>(),

          "Add the sample intervals begin to end - 1 to the digest; the other samples are context.")
      .def("forget", &SlidingPenalty::forget, py::arg("time"),
           "Drop the stretches that end no later than this time [s].")
      .def("compressed", &SlidingPenalty::compressed, py::call_guard<py::gil_scoped_release>(),

           "The penalty over all stretches; None while there is no window with motion.")
      .def(
          "linearised",
          [](const SlidingPenalty& p, const Eigen::VectorXd& theta) {
            Eigen::VectorXd residual;
            Eigen::MatrixXd jacobian;
            {
              const py::gil_scoped_release nogil;
              p.residuals(theta, residual, jacobian);
            }
            return py::make_tuple(residual.squaredNorm(), std::move(residual), std::move(jacobian));
          },
          py::arg("theta"), "Return penalty, window residuals and derivatives, by the direct sum.")
      .def("total", &SlidingPenalty::total, py::arg("coefficient"),
           "Return the sum of a constant column over all windows.")
      .def_property_readonly("window_count", &SlidingPenalty::window_count)
      .def_property_readonly("usable_duration", &SlidingPenalty::usable_duration,
                             "Integrated time of all windows [s].")
      .def_property_readonly("stretches", &SlidingPenalty::stretches)
      .def_property_readonly("begin", &SlidingPenalty::begin, "[s]")
      .def_property_readonly("end", &SlidingPenalty::end, "[s]");
}

}  // namespace jointid::bind
