#pragma once
// Desired motions: sums of sines, a sigmoid, and cubic pieces (step, trapezoidal velocity,
// samples).

#include <Eigen/Core>
#include <span>
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
  /// offset + sum of amplitude · sin(frequency · t + phase); frequencies in rad/s. The sum fades in
  /// and out over `fade` seconds, so that the motion starts and ends at rest at `offset`.
  static Trajectory multisine(Eigen::VectorXd amplitude, Eigen::VectorXd frequency,
                              Eigen::VectorXd phase, double offset, double duration,
                              double fade = 0.0);
  /// From 0 to `distance` in `rise` as half a cosine; then at rest.
  static Trajectory sigmoid(double distance, double rise, double duration);
  /// `distance` from `time` on.
  static Trajectory step(double distance, double time, double duration);
  /// From 0 to `distance` with at most `velocity` and exactly `acceleration`; then at rest.
  static Trajectory trapezoid(double distance, double velocity, double acceleration,
                              double duration);
  /// The natural cubic spline through samples: velocity and acceleration are continuous.
  static Trajectory samples(const Eigen::VectorXd& time, const Eigen::VectorXd& position);

  /// The desired motion at a time [s]; held before 0 and after the last sample.
  [[nodiscard]] Reference at(double time) const;
  /// The same at every period from 0 on, to a few units in the last place. Sums of sines take one
  /// rotation per sine and sample instead of two functions.
  void sample(double period, std::span<Reference> wanted) const;
  /// Intended duration [s].
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
  static void sample(const Multisine& form, double period, std::span<Reference> wanted);
  static Reference value(const Sigmoid& form, double time);
  static Reference value(const Pieces& form, double time);

  Form form_;
  double duration_;
};

}  // namespace jointid::simulate
