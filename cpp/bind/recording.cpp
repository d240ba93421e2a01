#include "bind/recording.hpp"

#include <stdexcept>
#include <utility>

#include "identify/recording/windows.hpp"

namespace jointid::bind {

using identify::Hold;
using identify::MaskedRecording;
using identify::RecordingView;
using identify::WindowOptions;

namespace {

RecordingView::Signal signal(const SharedRecording::Array& array) {
  if (array.ndim() != 1) throw std::invalid_argument("a signal must have one dimension");
  return {array.data(), static_cast<Eigen::Index>(array.size())};
}

RecordingView view_of(const std::vector<SharedRecording::Array>& s, Hold hold,
                      std::vector<std::int64_t> gaps, double min_speed,
                      std::vector<std::int64_t> doubtful) {
  const RecordingView::Signal none(nullptr, 0);
  return {signal(s[0]),
          signal(s[1]),
          signal(s[2]),
          signal(s[3]),
          s.size() > 4 ? signal(s[4]) : none,
          hold,
          std::move(gaps),
          min_speed,
          std::move(doubtful)};
}

}  // namespace

SharedRecording::SharedRecording(std::vector<Array> signals, Hold hold,
                                 std::vector<std::int64_t> gaps, double min_speed,
                                 std::vector<std::int64_t> doubtful,
                                 std::vector<std::pair<std::string, Array>> own)
    : signals_(std::move(signals)),
      own_(std::move(own)),
      view_(view_of(signals_, hold, std::move(gaps), min_speed, std::move(doubtful))) {
  for (const auto& [name, series] : own_) view_.own.push_back({name, signal(series)});
  view_.validate();
}

std::shared_ptr<const MaskedRecording> SharedRecording::masked(bool mask_standstill,
                                                               base::Pool* pool) {
  const std::lock_guard lock(mutex_);
  auto& known = masked_[mask_standstill ? 1 : 0];
  if (known != nullptr) return known;
  const auto find = [&](const base::Cancel* cancel) {
    auto made = std::make_shared<const MaskedRecording>(
        view_, identify::usable_intervals(view_, mask_standstill, cancel));
    if (cancel != nullptr) {
      made->period(cancel);  // a later call cannot be interrupted
      made->noise(cancel);
    }
    known = std::move(made);
  };
  if (pool == nullptr) {
    find(nullptr);
  } else {
    pool->for_each(1, [&](std::size_t, std::size_t) { find(&pool->cancel()); });
  }
  return known;
}

void bind_recording(py::module_& m) {
  py::native_enum<Hold>(m, "Hold", "enum.Enum", "Course of the torque signal between samples.")
      .value("zero_order", Hold::zero_order)
      .value("linear", Hold::linear)
      .finalize();
  using Array = SharedRecording::Array;
  py::class_<SharedRecording, std::shared_ptr<SharedRecording>>(
      m, "Recording", "Signals of one run. Arrays of floats are kept, not copied.")
      .def(py::init([](Array time, Array position, Array velocity, Array torque,
                       std::optional<Array> sensor, Hold torque_hold,
                       std::vector<std::int64_t> gap_after, double min_speed,
                       std::vector<std::int64_t> doubtful,
                       std::vector<std::pair<std::string, Array>> own) {
             std::vector<Array> signals{std::move(time), std::move(position), std::move(velocity),
                                        std::move(torque)};
             if (sensor) signals.push_back(std::move(*sensor));
             return std::make_shared<SharedRecording>(std::move(signals), torque_hold,
                                                      std::move(gap_after), min_speed,
                                                      std::move(doubtful), std::move(own));
           }),
           py::kw_only(), py::arg("time"), py::arg("position"), py::arg("velocity"),
           py::arg("torque"), py::arg("sensor"), py::arg("torque_hold"), py::arg("gap_after"),
           py::arg("min_speed") = 0.0, py::arg("doubtful") = std::vector<std::int64_t>{},
           py::arg("own") = std::vector<std::pair<std::string, Array>>{},
           "own: key of each own term, and its integral from the first sample to each sample.")
      .def_property_readonly("samples", &SharedRecording::samples);
  m.def(
      "usable_intervals",
      [](SharedRecording& recording, bool mask_standstill) {
        const auto masked = [&] {
          const py::gil_scoped_release nogil;
          return with_pool(recording.samples(), 1, [&](base::Pool* pool) {
            return recording.masked(mask_standstill, pool);
          });
        }();
        const auto& flags = masked->usable();
        return py::array_t<std::uint8_t>(static_cast<py::ssize_t>(flags.size()), flags.data());
      },
      py::arg("recording"), py::arg("mask_standstill") = true,

      "Return one flag per sample interval: 1 where the joint moves and the recording has no gap.");
  value(m, "WindowOptions",
        "How to cut a recording into windows: by a number, by a duration, or by neither (then the "
        "noise decides).",
        Field{"count", &WindowOptions::count, "Number of windows; 0: not set."},
        Field{"duration", &WindowOptions::duration, "Length of a window [s]; 0: not set."},
        Field{"factor", &WindowOptions::factor, "Factor on the duration, however it was chosen."},
        Field{"cumulative", &WindowOptions::cumulative,
              "Compare running integrals at the windows' ends (thesis's MATLAB) instead of each "
              "window's integral."});
}

}  // namespace jointid::bind
