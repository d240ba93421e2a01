#pragma once
// A joint's recording: one contiguous array per signal.

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace jointid::identify {

/// The torque signal between samples: a command is held, a measured signal is interpolated.
enum class Hold { zero_order, linear };

struct Recording {
  Eigen::VectorXd time;      ///< [s], increasing
  Eigen::VectorXd position;  ///< output side [rad] or [m]
  Eigen::VectorXd velocity;  ///< output side [rad/s] or [m/s]
  Eigen::VectorXd torque;    ///< output side [N m] or [N]
  Eigen::VectorXd sensor;    ///< raw reading of the joint torque sensor; empty without one
  Hold torque_hold = Hold::linear;
  std::vector<std::int64_t> gap_after;  ///< last sample before each gap

  [[nodiscard]] Eigen::Index samples() const { return time.size(); }
  [[nodiscard]] bool has_sensor() const { return sensor.size() > 0; }
  /// Throws std::invalid_argument if lengths differ, a value is not finite or time does not
  /// increase.
  void validate() const;
};

/// A view of the same signals, without a copy. Their owner must outlive the view.
struct RecordingView {
  using Signal = Eigen::Map<const Eigen::VectorXd>;
  Signal time;
  Signal position;
  Signal velocity;
  Signal torque;
  Signal sensor;
  Hold torque_hold;
  std::vector<std::int64_t> gap_after;
  double min_speed = 0.0;              ///< [rad/s or m/s]; slower samples are left out
  std::vector<std::int64_t> doubtful;  ///< first sample of each interval that must not be used
  /// Integral of the own term with this name, from the first sample to each sample.
  struct OwnSeries {
    std::string name;
    Signal series;
  };
  std::vector<OwnSeries> own{};

  RecordingView(const Recording& r);  // implicit: a recording is its own view
  RecordingView(Signal time_, Signal position_, Signal velocity_, Signal torque_, Signal sensor_,
                Hold hold, std::vector<std::int64_t> gaps, double slowest = 0.0,
                std::vector<std::int64_t> unusable = {})
      : time(time_),
        position(position_),
        velocity(velocity_),
        torque(torque_),
        sensor(sensor_),
        torque_hold(hold),
        gap_after(std::move(gaps)),
        min_speed(slowest),
        doubtful(std::move(unusable)) {}
  [[nodiscard]] Eigen::Index samples() const { return time.size(); }
  [[nodiscard]] bool has_sensor() const { return sensor.size() > 0; }
  /// As `Recording::validate`.
  void validate() const;
};

}  // namespace jointid::identify
