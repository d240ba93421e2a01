#pragma once
// The part of the sensor's reading that the motion explains: first stage of two-stage least
// squares.
//
// A gain found by regression is too small if the reading is the noisy side. It is too large if
// friction that the model lacks is taken for noise of the reading (reverse regression). Both fail
// because the reading is correlated with the residual of the balance. A rigid link's torque is
// m g l cos(q + q0) + I dv/dt, which needs neither reading nor friction. The reading's
// least-squares projection on these columns and on the balance's own columns is free of both
// errors. It replaces the reading as the gain's column (Theil 1953, Basmann 1957).

#include <Eigen/Core>
#include <vector>

namespace jointid::identify {

/// Columns that explain the reading. Those of a rigid link come last: cosine, sine and duration of
/// each run, then the velocity change of each.
struct Instruments {
  std::vector<Eigen::Index> own;    ///< free coefficients with a constant column, without the gain
  std::vector<std::size_t> shaped;  ///< free shaped terms, each summed for several decays
  std::vector<double> rates;        ///< rates of those decays, exp(-rate v^2)
  Eigen::Index runs = 1;            ///< recordings with their own link; 1: all share one

  /// Number of columns of the balance.
  [[nodiscard]] Eigen::Index inner() const {
    return static_cast<Eigen::Index>(own.size() + shaped.size() * rates.size());
  }
  [[nodiscard]] Eigen::Index size() const { return inner() + kLink * runs; }

  static constexpr Eigen::Index kPosture = 3;  ///< with columns of gravity and offset
  static constexpr Eigen::Index kLink = 4;     ///< with the velocity change
};

/// The rates of decays for recordings with that largest speed; none at rest.
std::vector<double> instrument_rates(double fastest);

/// The solved first stage.
struct FirstStage {
  Instruments instruments;
  Eigen::VectorXd weights;  ///< weights of the instruments; 0: not used, or implied by the others
  /// Whether the velocity change is among the link's columns. It is left out if gravity suffices:
  /// friction that drifts is correlated with it, and torque feedback brings the sensor's noise into
  /// it.
  bool acceleration = false;
  /// F statistic of the link's columns in addition to those of the balance. Below 10 the
  /// instruments are weak (Staiger and Stock 1997).
  double strength = 0.0;
  /// Share of the reading's variance that only the link's columns explain.
  double share = 0.0;

  [[nodiscard]] bool weak() const;
};

/// Solves the first stage from the triangle of a QR decomposition of (instruments, reading).
FirstStage solve_first_stage(const Instruments& instruments, const Eigen::MatrixXd& triangle,
                             Eigen::Index windows);

/// R of the QR decomposition, always square.
Eigen::MatrixXd square_triangle(Eigen::MatrixXd rows);
/// The triangle of all rows from the triangles of parts; at least one.
Eigen::MatrixXd fold(const std::vector<Eigen::MatrixXd>& triangles);

}  // namespace jointid::identify
