#include "bind/recording.hpp"
#include "identify/sliding_penalty.hpp"

namespace jointid::bind {

using identify::SlidingPenalty;

void bind_online(py::module_& m) {
  py::class_<SlidingPenalty>(m, "SlidingPenalty",
                             "The penalty over the last seconds of a motion that goes on.")
      .def(py::init([](std::vector<std::string> terms, identify::Residual residual,
                       double gear_ratio, double window_duration, bool mask_standstill,
                       Eigen::VectorXd lower, Eigen::VectorXd upper, double speed) {
             return SlidingPenalty(std::move(terms), residual, gear_ratio, window_duration,
                                   mask_standstill, {std::move(lower), std::move(upper)}, speed);
           }),
           py::kw_only(), py::arg("terms"), py::arg("residual"), py::arg("gear_ratio"),
           py::arg("window_duration"), py::arg("mask_standstill"), py::arg("lower"),
           py::arg("upper"), py::arg("speed"))
      .def(
          "append",
          [](SlidingPenalty& p, const std::shared_ptr<SharedRecording>& samples, Eigen::Index begin,
             Eigen::Index end) { p.append(samples->view(), begin, end); },
          py::arg("samples"), py::arg("begin"), py::arg("end"),
          py::call_guard<py::gil_scoped_release>(),
          "Digest the sample intervals begin to end - 1; the other samples are context.")
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
          py::arg("theta"), "Penalty, window residuals and derivatives, by the direct sum.")
      .def("total", &SlidingPenalty::total, py::arg("coefficient"),
           "Sum of a constant column over all windows.")
      .def_property_readonly("window_count", &SlidingPenalty::window_count)
      .def_property_readonly("usable_duration", &SlidingPenalty::usable_duration,
                             "Integrated time of all windows [s].")
      .def_property_readonly("stretches", &SlidingPenalty::stretches)
      .def_property_readonly("begin", &SlidingPenalty::begin, "[s]")
      .def_property_readonly("end", &SlidingPenalty::end, "[s]");
}

}  // namespace jointid::bind
