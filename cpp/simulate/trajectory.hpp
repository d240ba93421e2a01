#pragma once
// Desired motions: sums of sines, a sigmoid, and cubic pieces (step, trapezoidal velocity,
// samples).

#include <Eigen/Core>
#include <variant>
#include <vector>

namespace jointid::simulate {

struct Reference {
  double position = 0.0;
  double velocity = 0.0;
  double acceleration = 0.0;
};

class Trajectory {
 public:
  /// offset + sum of amplitude · sin(frequency · t + phase); frequencies in rad/s. With a fade the
  /// sum grows from nothing over so many seconds, and ends so: it starts and ends at rest at
  /// offset.
  static Trajectory multisine(Eigen::VectorXd amplitude, Eigen::VectorXd frequency,
                              Eigen::VectorXd phase, double offset, double duration,
                              double fade = 0.0);
  /// From 0 to `distance` in `rise`, half a cosine; then rest.
  static Trajectory sigmoid(double distance, double rise, double duration);
  /// `distance` from `time` on.
  static Trajectory step(double distance, double time, double duration);
  /// From 0 to `distance` at no more than `velocity` and exactly `acceleration`; then rest.
  static Trajectory trapezoid(double distance, double velocity, double acceleration,
                              double duration);
  /// The natural cubic spline through samples: velocity and acceleration are continuous.
  static Trajectory samples(const Eigen::VectorXd& time, const Eigen::VectorXd& position);

  /// What is wanted at a time [s]; held before 0 and after the last sample.
  [[nodiscard]] Reference at(double time) const;
  /// How long it is meant to last [s].
  [[nodiscard]] double duration() const { return duration_; }

 private:
  struct Multisine {
    Eigen::VectorXd amplitude;
    Eigen::VectorXd frequency;
    Eigen::VectorXd phase;
    double offset;
    double duration;
    double fade;
  };
  struct Sigmoid {
    double distance;
    double rise;
  };
  struct Piece {
    double start;
    double position;
    double velocity;
    double acceleration;
    double jerk;
  };
  using Pieces = std::vector<Piece>;
  using Form = std::variant<Multisine, Sigmoid, Pieces>;

  Trajectory(Form form, double duration);
  static Reference value(const Multisine& form, double time);
  static Reference value(const Sigmoid& form, double time);
  static Reference value(const Pieces& form, double time);

  Form form_;
  double duration_;
};

}  // namespace jointid::simulate
