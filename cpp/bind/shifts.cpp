// What the search for delays computes sample by sample.

#include <pybind11/eigen.h>

#include "bind/recording.hpp"
#include "signals/repeated_noise.hpp"
#include "signals/shift_fit.hpp"
#include "signals/window_integrals.hpp"
#include "signals/window_means.hpp"

namespace jointid::bind {

using signals::ShiftRows;

namespace {

using Array = SharedRecording::Array;
using Indices = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;
using Flags = py::array_t<bool, py::array::c_style | py::array::forcecast>;

signals::Signal signal(const Array& array) {
  return {array.data(), static_cast<Eigen::Index>(array.size())};
}

/// The middles; an error where a window reaches beyond the signal.
signals::Middles middles_of(const Indices& middles, const Array& signal, const Array& weight) {
  signals::Middles result(middles.data(), middles.data() + middles.size());
  const auto half = static_cast<std::int64_t>(weight.size()) / 2;
  const auto last = static_cast<std::int64_t>(signal.size()) - 1 - half;
  for (const auto middle : result) {
    if (middle < half || middle > last) {
      throw std::invalid_argument("a window reaches beyond the signal");
    }
  }
  return result;
}

/// One stretch's windows and signal, with the arrays that they are views of.
struct StretchArrays {
  Array time;
  Array signal;
  Array weight;
  Indices middles;
  Flags kept;
  std::int64_t stride;
};

ShiftRows rows_of(const std::vector<StretchArrays>& stretches,
                  const Eigen::Ref<const Eigen::MatrixXd>& columns, Eigen::Index conservative,
                  bool held) {
  ShiftRows rows{{}, columns, conservative, held};
  Eigen::Index used = 0;
  for (const auto& each : stretches) {
    if (each.kept.size() != each.middles.size() || each.signal.size() != each.time.size() ||
        each.signal.size() < 4) {
      throw std::invalid_argument("signal, windows and time must match");
    }
    const double duration = each.time.data()[each.time.size() - 1] - each.time.data()[0];
    rows.stretches.push_back(
        {signal(each.time), signal(each.signal), signal(each.weight),
         middles_of(each.middles, each.signal, each.weight),
         std::vector<bool>(each.kept.data(), each.kept.data() + each.kept.size()), each.stride,
         duration / static_cast<double>(each.time.size() - 1)});
    for (const bool kept : rows.stretches.back().kept) used += kept ? 1 : 0;
  }
  if (used != columns.rows() || stretches.empty() || conservative > columns.cols()) {
    throw std::invalid_argument("columns need a row for each window that is used");
  }
  return rows;
}

}  // namespace

void bind_shifts(py::module_& m) {
  using Matrix = Eigen::Ref<const Eigen::MatrixXd>;
  py::class_<StretchArrays>(m, "SmoothStretch", "A signal and the smooth windows over it.")
      .def(py::init([](Array time, Array signal, Array weight, Indices middles, Flags kept,
                       std::int64_t stride) {
             return StretchArrays{std::move(time),    std::move(signal), std::move(weight),
                                  std::move(middles), std::move(kept),   stride};
           }),
           py::kw_only(), py::arg("time"), py::arg("signal"), py::arg("weight"), py::arg("middles"),
           py::arg("kept"), py::arg("stride"));
  py::class_<signals::FittedShift>(m, "FittedShift", "A shift, with its standard error [s].")
      .def_readonly("whole", &signals::FittedShift::whole)
      .def_readonly("conservative", &signals::FittedShift::conservative)
      .def_readonly("friction", &signals::FittedShift::friction)
      .def_readonly("unexplained", &signals::FittedShift::unexplained)
      .def_readonly("unshifted", &signals::FittedShift::unshifted,
                    "Coefficients of the columns without a shift; empty where one was searched.");
  m.def(
      "fit_shift",
      [](const std::vector<StretchArrays>& stretches, const Matrix& columns,
         Eigen::Index conservative, bool held, double reach, bool robust, double least) {
        const py::gil_scoped_release nogil;
        return signals::fit_shift(rows_of(stretches, columns, conservative, held),
                                  {reach, robust, least}, nullptr);
      },
      py::arg("stretches"), py::arg("columns"), py::kw_only(), py::arg("conservative"),
      py::arg("held"), py::arg("reach"), py::arg("robust"), py::arg("least"),
      "The shift that a balance asks for, or None.");
  m.def(
      "shift_coefficients",
      [](const std::vector<StretchArrays>& stretches, const Matrix& columns, bool held) {
        const py::gil_scoped_release nogil;
        return signals::shift_coefficients(rows_of(stretches, columns, 0, held));
      },
      py::arg("stretches"), py::arg("columns"), py::kw_only(), py::arg("held"),
      "Least squares of the signals, not shifted, on the columns.");
  m.def(
      "window_means",
      [](const Array& values, const Array& weight, const Indices& middles) {
        return signals::window_means(signal(values), signal(weight),
                                     middles_of(middles, values, weight));
      },
      py::arg("signal"), py::arg("weight"), py::arg("middles"),
      "Weighted sums of a signal over windows.");
  m.def(
      "window_integrals",
      [](const Array& values, const Array& weights, const Indices& windows, bool rise) {
        const bool fits = windows.ndim() == 2 && windows.shape(1) == 2 && values.ndim() >= 1 &&
                          values.ndim() <= 2 && values.shape(0) == weights.size() + 1;
        const signals::Bounds bounds(windows.data(), fits ? windows.shape(0) : 0, 2);
        if (!fits ||
            (bounds.size() > 0 && (bounds.minCoeff() < 0 || bounds.maxCoeff() > weights.size()))) {
          throw std::invalid_argument("windows and weights must fit the samples");
        }
        const auto width = static_cast<std::size_t>(values.ndim() == 2 ? values.shape(1) : 1);
        return signals::window_integrals(values.data(), width, signal(weights), bounds,
                                         rise ? signals::Summed::rise : signals::Summed::area);
      },
      py::arg("values"), py::arg("weights"), py::arg("windows"), py::kw_only(),
      py::arg("rise") = false,
      "Integrals over windows, one row a window, or how far the values rise there.");
  m.def(
      "smoothed",
      [](const Array& values, const Array& weight) {
        return signals::smoothed(signal(values), signal(weight));
      },
      py::arg("signal"), py::arg("weight"), "Weighted sums around each sample.");
  m.def(
      "circle",
      [](const Array& angle) {
        auto found = signals::circle_of(signal(angle));
        return std::make_pair(std::move(found.cosine), std::move(found.sine));
      },
      py::arg("angle"), "Cosine and sine.");
  m.def(
      "friction_means",
      [](const Array& velocity, const Array& smooth, const Array& cosine, const Array& sine,
         double longest, const Array& weight, const Indices& middles) {
        if (smooth.size() != velocity.size() || cosine.size() != velocity.size() ||
            sine.size() != velocity.size()) {
          throw std::invalid_argument("signals must have one length");
        }
        return signals::friction_means(
            {signal(velocity), signal(smooth), signal(cosine), signal(sine)}, longest,
            signal(weight), middles_of(middles, velocity, weight));
      },
      py::arg("velocity"), py::arg("smooth"), py::arg("cosine"), py::arg("sine"), py::kw_only(),
      py::arg("longest"), py::arg("weight"), py::arg("middles"),
      "Window means of friction as any smooth function of the speed.");
  m.def(
      "roughness", [](const Array& values) { return signals::roughness(signal(values)); },
      py::arg("signal"), "Standard deviation of a signal's third differences.");
  m.def(
      "noise_products",
      [](const Array& reading, const Array& torque, Eigen::Index blocks, Eigen::Index longest,
         double clipped) {
        if (reading.size() != torque.size() || blocks < 1 ||
            static_cast<Eigen::Index>(reading.size()) < 3 + 2 * longest + blocks) {
          throw std::invalid_argument("signals are too short");
        }
        return signals::noise_products(signal(reading), signal(torque), blocks, longest, clipped);
      },
      py::arg("reading"), py::arg("torque"), py::kw_only(), py::arg("blocks"), py::arg("longest"),
      py::arg("clipped"), "Products of two signals' third differences, block by block.");
}

}  // namespace jointid::bind
