#include <cmath>
#include <utility>

#include "bind/recordings.hpp"
#include "diagnose/inspection.hpp"
#include "diagnose/ripple.hpp"
#include "identify/penalty/penalty_parts.hpp"

namespace jointid::bind {

using diagnose::Inspection;
using diagnose::Limit;
using diagnose::SignalFacts;
using diagnose::Spike;
using diagnose::SpikeRule;

namespace {

using Array = SharedRecording::Array;

}  // namespace

void bind_diagnose(py::module_& m) {
  py::native_enum<SpikeRule>(m, "SpikeRule", "enum.Enum",
                             "Reference that a signal's spikes are compared with.")
      .value("position", SpikeRule::position)
      .value("command", SpikeRule::command)
      .value("other", SpikeRule::other)
      .finalize();
  py::class_<Limit>(m, "Limit", "Samples at one of a signal's extremes.")
      .def_readonly("there", &Limit::there, "Samples at the extreme.")
      .def_readonly("moving", &Limit::moving, "Samples at the extreme while the joint moves.")
      .def_readonly("near", &Limit::near,
                    "Samples within 1 % of the range, including those at the extreme.");
  py::class_<SignalFacts>(m, "SignalFacts", "Facts about a single signal, without a model.")
      .def_property_readonly("lowest", [](const SignalFacts& f) { return f.range.lowest; })
      .def_property_readonly("highest", [](const SignalFacts& f) { return f.range.highest; })
      .def_readonly("fine", &SignalFacts::fine,
                    "Whether the usual step is at least 30 times the smallest one.")
      .def_readonly("changes", &SignalFacts::changes, "Number of steps that are not zero.")
      .def_readonly("smallest", &SignalFacts::smallest,
                    "Smallest step that is not zero; infinite if there is none.")
      .def_readonly("lower", &SignalFacts::lower)
      .def_readonly("upper", &SignalFacts::upper)
      .def_readonly("moving", &SignalFacts::moving, "Intervals at a fair speed.")
      .def_readonly("stale", &SignalFacts::stale,
                    "Intervals among `moving` without a step and not at an extreme.")
      .def_readonly("frozen", &SignalFacts::frozen,
                    "Intervals among `moving` in long runs without a step.");
  py::class_<Spike>(m, "Spike", "The largest spike of a signal.")
      .def_readonly("height", &Spike::height)
      .def_readonly("index", &Spike::index)
      .def_readonly("count", &Spike::count, "Number of spikes; 0: none.");
  py::class_<diagnose::Agreement>(
      m, "Agreement", "position change = scale * integrated velocity + lag * velocity change.")
      .def_readonly("scale", &diagnose::Agreement::scale)
      .def_readonly("lag", &diagnose::Agreement::lag, "[s]")
      .def_readonly("lag_error", &diagnose::Agreement::lag_error, "[s]");
  py::class_<Inspection>(m, "Inspection", "Facts about a recording, without a model.")
      .def_readonly("peak_speed", &Inspection::peak_speed)
      .def_readonly("facts", &Inspection::facts, "Facts of each channel.")
      .def_readonly("spikes", &Inspection::spikes, "Largest spike of each channel.")
      .def_readonly("jump", &Inspection::jump,
                    "Index of the sample before a jump of the position; -1: none.")
      .def_readonly("agreement", &Inspection::agreement)
      .def_property_readonly(
          "swing", [](const Inspection& i) { return i.position.highest - i.position.lowest; })
      .def_property_readonly(
          "timing_errors",
          [](const Inspection& i) {
            return std::make_pair(i.timing.as_stamped, i.timing.as_uniform);
          },

          "Scatter of the sampling times about the time stamps and about an even grid [s].");
  m.def(
      "inspect",
      [](const Array& time, const Array& position, const Array& velocity, bool velocity_derived,
         double period, const std::vector<std::tuple<Array, SpikeRule, bool>>& channels,
         int threads) {
        diagnose::Subject subject{signal_of(time),
                                  signal_of(position),
                                  signal_of(velocity),
                                  velocity_derived,
                                  period,
                                  {}};
        for (const auto& [values, rule, spikes] : channels) {
          subject.channels.push_back({signal_of(values), rule, spikes});
        }
        const py::gil_scoped_release nogil;
        return with_pool(time.size(), threads,
                         [&](base::Pool* pool) { return diagnose::inspect(subject, pool); });
      },
      py::kw_only(), py::arg("time"), py::arg("position"), py::arg("velocity"),
      py::arg("velocity_derived"), py::arg("period"), py::arg("channels"), py::arg("threads") = 0,

      "Examine a recording's signals. Each channel has a signal, its rule, and whether to look for "
      "spikes.");
  m.def(
      "ripple",
      [](const Recordings& recordings, const std::vector<std::string>& terms,
         const identify::WindowOptions& windows, identify::Residual residual, bool mask_standstill,
         double gear_ratio, const std::vector<std::string>& per_recording,
         const Eigen::VectorXd& theta, int halves, int threads) {
        const py::gil_scoped_release nogil;
        return with_pool(samples_of(recordings), threads, [&](base::Pool* pool) {
          const identify::PenaltyParts parts(all_masked(recordings, mask_standstill, pool), terms,
                                             windows, residual, gear_ratio, per_recording);
          auto found = diagnose::ripple_spectrum(parts, theta, std::abs(gear_ratio), halves, pool);
          return std::make_tuple(found.windows, found.power, std::move(found.multiple));
        });
      },
      py::kw_only(), py::arg("recordings"), py::arg("terms"), py::arg("windows"),
      py::arg("residual"), py::arg("mask_standstill"), py::arg("gear_ratio"),
      py::arg("per_recording"), py::arg("theta"), py::arg("halves"), py::arg("threads") = 0,
      "Return the number of short windows, the sum of their squared mean residuals, and the "
      "magnitude of their sum at each half multiple of the motor's angle.");
}

}  // namespace jointid::bind
