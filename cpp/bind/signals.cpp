#include "bind/recording.hpp"
#include "identify/penalty/penalty_parts.hpp"
#include "signals/local_velocity.hpp"
#include "signals/timing.hpp"

namespace jointid::bind {

using signals::LocalVelocity;
using signals::PositionNoise;

namespace {

using Array = SharedRecording::Array;

PositionNoise noise_of(const Array& time, const Array& position,
                       const std::vector<signals::Stretch>& stretches, double period,
                       base::Pool* pool) {
  return signals::position_noise(signal_of(time), signal_of(position), stretches, period,
                                 pool != nullptr ? &pool->cancel() : nullptr);
}

}  // namespace

void bind_signals(py::module_& m) {
  py::class_<PositionNoise>(m, "PositionNoise", "Noise of a position signal.")
      .def_readonly("quantum", &PositionNoise::quantum,
                    "Resolution of the encoder [rad or m]; 0: positions lie on no grid.")
      .def_readonly("sigma", &PositionNoise::sigma,
                    "Standard deviation of a sample, without errors of the time stamps [rad or m].")
      .def_readonly("timing", &PositionNoise::timing, "Scatter of the time stamps [s].");
  py::class_<LocalVelocity>(m, "LocalVelocity", "Velocity derived from position.")
      .def_readonly("velocity", &LocalVelocity::velocity)
      .def_readonly("noise", &LocalVelocity::noise,
                    "Standard deviation of the velocity at each sample.")
      .def_readonly(
          "refined", &LocalVelocity::refined,
          "False if the noise is harmless; then every velocity is the difference quotient.");
  m.def(
      "position_noise",
      [](const Array& time, const Array& position, const std::vector<std::int64_t>& gap_after,
         double period) {
        const py::gil_scoped_release nogil;
        const auto stretches = signals::stretches_between(time.size(), gap_after);
        return with_pool(time.size(), 1, [&](base::Pool* pool) {
          PositionNoise noise;
          identify::for_each(1, pool, [&](std::size_t) {
            noise = noise_of(time, position, stretches, period, pool);
          });
          return noise;
        });
      },
      py::arg("time"), py::arg("position"), py::arg("gap_after"), py::arg("period"),
      "Return the noise of a position: the encoder's resolution, white noise, errors of the time "
      "stamps.");
  m.def(
      "timing_errors",
      [](const Array& time, const Array& position, double period) {
        const py::gil_scoped_release nogil;
        const auto errors =
            signals::timing_errors(signal_of(time), signal_of(position), period, nullptr);
        return std::make_pair(errors.as_stamped, errors.as_uniform);
      },
      py::arg("time"), py::arg("position"), py::arg("period"),
      "Return the scatter of the sampling times about the time stamps and about an even grid [s].");
  m.def(
      "local_velocity",
      [](const Array& time, const Array& position, const Array& difference,
         const std::vector<std::int64_t>& gap_after, const PositionNoise& noise, int threads) {
        const py::gil_scoped_release nogil;
        const auto stretches = signals::stretches_between(time.size(), gap_after);
        return with_pool(time.size(), threads, [&](base::Pool* pool) {
          return signals::local_velocity(signal_of(time), signal_of(position),
                                         signal_of(difference), stretches, noise, pool);
        });
      },
      py::arg("time"), py::arg("position"), py::arg("difference"), py::arg("gap_after"),
      py::arg("noise"), py::arg("threads") = 0,

      "Return the velocity by local cubics with a length that follows the noise, or by differences "
      "where they are accurate.");
}

}  // namespace jointid::bind
