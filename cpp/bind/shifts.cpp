// The computations per sample of the search for delays.

#include <pybind11/eigen.h>

#include "bind/recording.hpp"
#include "signals/balance_columns.hpp"
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

/// Smooth windows, with the arrays that their stretch views.
struct WindowsOfArrays {
  Array time;
  Array position;
  Array velocity;
  Flags usable;
  bool derived;
  signals::SmoothWindows windows;

  WindowsOfArrays(Array time_, Array position_, Array velocity_, Flags usable_, bool derived_,
                  const signals::WindowRules& rules)
      : time(std::move(time_)),
        position(std::move(position_)),
        velocity(std::move(velocity_)),
        usable(std::move(usable_)),
        derived(derived_) {
    for (const auto size : {position.size(), velocity.size(), usable.size()}) {
      if (size != time.size()) throw std::invalid_argument("signals must have one length");
    }
    windows = signals::smooth_windows(stretch(), rules);
  }

  [[nodiscard]] signals::EvenStretch stretch() const {
    return {signal_of(time), signal_of(position), signal_of(velocity), usable.data(), derived};
  }
  /// A view of a signal with the same number of samples.
  [[nodiscard]] signals::Signal own(const Array& values) const {
    if (values.size() != time.size()) throw std::invalid_argument("signals must have one length");
    return signal_of(values);
  }
};

using Windows = std::vector<const WindowsOfArrays*>;

ShiftRows rows_of(const Windows& windows, const std::vector<Array>& signals,
                  const Eigen::Ref<const Eigen::MatrixXd>& columns, Eigen::Index conservative,
                  bool held) {
  ShiftRows rows{{}, columns, conservative, held};
  if (windows.empty() || windows.size() != signals.size()) {
    throw std::invalid_argument("each stretch needs one signal");
  }
  Eigen::Index used = 0;
  for (std::size_t i = 0; i < windows.size(); ++i) {
    const auto& each = *windows[i];
    rows.stretches.push_back({signal_of(each.time), each.own(signals[i]), each.windows});
    used += static_cast<Eigen::Index>(each.windows.used.size());
  }
  if (used != columns.rows() || columns.cols() < 1 || conservative > columns.cols()) {
    throw std::invalid_argument("columns need one row for each used window");
  }
  return rows;
}

}  // namespace

void bind_shifts(py::module_& m) {
  using Matrix = Eigen::Ref<const Eigen::MatrixXd>;
  py::class_<WindowsOfArrays>(m, "SmoothWindows", "Smooth windows over a stretch without a gap.")
      .def(py::init([](Array time, Array position, Array velocity, Flags usable, bool derived,
                       std::int64_t half, std::int64_t margin, std::int64_t clear,
                       bool usable_only) {
             return WindowsOfArrays(std::move(time), std::move(position), std::move(velocity),
                                    std::move(usable), derived, {half, margin, clear, usable_only});
           }),
           py::arg("time"), py::arg("position"), py::arg("velocity"), py::arg("usable"),
           py::kw_only(), py::arg("derived"), py::arg("half"), py::arg("margin"),
           py::arg("clear") = 0, py::arg("usable_only") = true)
      .def_property_readonly(
          "used",
          [](const WindowsOfArrays& of) {
            const auto& used = of.windows.used;
            return py::array_t<std::int64_t>(static_cast<py::ssize_t>(used.size()), used.data());
          },
          "Middle samples of the used windows.")
      .def(
          "rates",
          [](const WindowsOfArrays& of, const Array& values) {
            return signals::mean_rates(of.own(values), of.windows);
          },
          py::arg("signal"), "Return the mean rate of a signal in each window.")
      .def(
          "columns",
          [](const WindowsOfArrays& of, const Array& cosine, const Array& sine, bool varying,
             bool friction, const std::vector<Array>& own, const std::vector<Array>& own_friction,
             const std::optional<Array>& jumping, double answer) {
            signals::ColumnChoice choice{of.own(cosine), of.own(sine), varying, {},
                                         friction,       {},           {},      answer};
            for (const auto& each : own) choice.own.push_back(of.own(each));
            for (const auto& each : own_friction) choice.own_friction.push_back(of.own(each));
            if (jumping) choice.jumping.emplace(of.own(*jumping));
            const py::gil_scoped_release nogil;
            return signals::balance_columns(of.stretch(), of.windows, choice);
          },
          py::arg("cosine"), py::arg("sine"), py::kw_only(), py::arg("varying"),
          py::arg("friction"), py::arg("own") = std::vector<Array>{},
          py::arg("own_friction") = std::vector<Array>{}, py::arg("jumping") = py::none(),
          py::arg("answer") = 0.0,
          "Return the columns that can explain a torque or a reading, one row per window.");
  py::class_<signals::FittedShift>(m, "FittedShift", "A time shift, with its standard error [s].")
      .def_readonly("whole", &signals::FittedShift::whole)
      .def_readonly("conservative", &signals::FittedShift::conservative)
      .def_readonly("friction", &signals::FittedShift::friction)
      .def_readonly("unexplained", &signals::FittedShift::unexplained)
      .def_readonly(
          "leading", &signals::FittedShift::leading,

          "Coefficient of the first column without a shift; None if a shift was searched for.");
  m.def(
      "fit_shift",
      [](const Windows& windows, const std::vector<Array>& signals, const Matrix& columns,
         Eigen::Index conservative, bool held, double reach, bool robust, double least) {
        const auto rows = rows_of(windows, signals, columns, conservative, held);
        const py::gil_scoped_release nogil;
        return signals::fit_shift(rows, {reach, robust, least}, nullptr);
      },
      py::arg("windows"), py::arg("signals"), py::arg("columns"), py::kw_only(),
      py::arg("conservative"), py::arg("held"), py::arg("reach"), py::arg("robust"),
      py::arg("least"), "Return the time shift that a balance requires, or None.");
  m.def(
      "leading_coefficient",
      [](const Windows& windows, const std::vector<Array>& signals, const Matrix& columns,
         bool held) {
        const auto rows = rows_of(windows, signals, columns, 0, held);
        const py::gil_scoped_release nogil;
        return signals::leading_coefficient(rows);
      },
      py::arg("windows"), py::arg("signals"), py::arg("columns"), py::kw_only(), py::arg("held"),

      "Return the first column's coefficient in least squares of the unshifted signals on the "
      "columns.");
  m.def(
      "even_grid",
      [](const Array& time) {
        if (time.size() < 2) throw std::invalid_argument("two samples are needed");
        auto found = signals::even_grid(signal_of(time));
        return std::make_pair(std::move(found.time), found.apart);
      },
      py::arg("time"),
      "Return even times from the first to the last sample, and their distance from the real times "
      "[s].");
  m.def(
      "half_length",
      [](const Array& values, double period, bool position) {
        if (values.size() < 4) throw std::invalid_argument("the signal is too short");
        return signals::half_length(signal_of(values), period, position);
      },
      py::arg("signal"), py::arg("period"), py::kw_only(), py::arg("position"),
      "Return half the length of a window that averages out the acceleration's noise.");
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
        return signals::window_integrals(values.data(), width, signal_of(weights), bounds,
                                         rise ? signals::Summed::rise : signals::Summed::area);
      },
      py::arg("values"), py::arg("weights"), py::arg("windows"), py::kw_only(),
      py::arg("rise") = false,
      "Return integrals over windows, one row per window, or the rise of the values in each "
      "window.");
  m.def(
      "circle",
      [](const Array& angle) {
        auto found = signals::circle_of(signal_of(angle));
        return std::make_pair(std::move(found.cosine), std::move(found.sine));
      },
      py::arg("angle"), "Return cosine and sine.");
  m.def(
      "roughness", [](const Array& values) { return signals::roughness(signal_of(values)); },
      py::arg("signal"), "Return the standard deviation of a signal's third differences.");
  py::class_<signals::RepeatedNoise>(m, "RepeatedNoise",
                                     "Noise of a reading that the torque repeats.")
      .def_readonly("earlier", &signals::RepeatedNoise::earlier,
                    "Number of samples by which the torque has the noise earlier.")
      .def_readonly("error", &signals::RepeatedNoise::error,
                    "Standard error of `earlier` in samples.")
      .def_readonly("share", &signals::RepeatedNoise::share, "Correlation of the two noises.");
  m.def(
      "repeated_noise",
      [](const std::vector<std::pair<Array, Array>>& pairs) {
        std::vector<signals::NoisyPair> both;
        for (const auto& [reading, torque] : pairs) {
          if (reading.size() != torque.size() || reading.size() < signals::kShortestNoise) {
            throw std::invalid_argument("signals are too short");
          }
          both.push_back({signal_of(reading), signal_of(torque)});
        }
        const py::gil_scoped_release nogil;
        return signals::repeated_noise(both);
      },
      py::arg("pairs"),
      "Return the noise of the readings that the torques repeat, from pairs of both. None where "
      "there is no such noise.");
}

}  // namespace jointid::bind
