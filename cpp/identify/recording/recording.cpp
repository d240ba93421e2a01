#include "identify/recording/recording.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

#include "base/input_error.hpp"
#include "base/scans.hpp"

namespace jointid::identify {

namespace {

void check_signal(const RecordingView::Signal& signal, const char* name, Eigen::Index samples) {
  if (signal.size() != samples) {
    throw std::invalid_argument(std::string(name) + " has " + std::to_string(signal.size()) +
                                " samples, time has " + std::to_string(samples));
  }
  if (base::all_finite(signal.data(), static_cast<std::size_t>(samples))) return;
  for (Eigen::Index k = 0; k < samples; ++k) {
    if (!std::isfinite(signal[k])) {
      throw std::invalid_argument(std::string(name) + " is not finite at sample " +
                                  std::to_string(k));
    }
  }
}

}  // namespace

RecordingView::RecordingView(const Recording& r)
    : time(r.time.data(), r.time.size()),
      position(r.position.data(), r.position.size()),
      velocity(r.velocity.data(), r.velocity.size()),
      torque(r.torque.data(), r.torque.size()),
      sensor(r.sensor.data(), r.sensor.size()),
      torque_hold(r.torque_hold),
      gap_after(r.gap_after) {}

void Recording::validate() const {
  RecordingView(*this).validate();
}

void RecordingView::validate() const {
  const Eigen::Index n = samples();
  if (n < 8)
    throw base::InputError("a recording needs at least 8 samples, got " + std::to_string(n));
  check_signal(time, "time", n);
  check_signal(position, "position", n);
  check_signal(velocity, "velocity", n);
  check_signal(torque, "torque", n);
  if (has_sensor()) check_signal(sensor, "sensor", n);
  for (const auto& each : own) check_signal(each.series, each.name.c_str(), n);
  const bool rises = base::increases(time.data(), static_cast<std::size_t>(n - 1));
  for (Eigen::Index k = 1; !rises && k < n; ++k) {
    if (!(time[k] > time[k - 1])) {
      throw std::invalid_argument("time must increase, it does not at sample " + std::to_string(k));
    }
  }
  for (const auto gap : gap_after) {
    if (gap < 0 || gap >= n - 1)
      throw std::invalid_argument("gap_after must lie inside the recording");
  }
  for (const auto interval : doubtful) {
    if (interval < 0 || interval >= n - 1)
      throw std::invalid_argument("doubtful must lie inside the recording");
  }
}

}  // namespace jointid::identify
