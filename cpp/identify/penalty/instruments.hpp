#pragma once
// The sensor's reading as far as the motion explains it: first stage of two-stage least squares.
//
// A gain found by regression is too small where the reading is the noisy side, and too large where
// friction that the model lacks is taken for noise of the reading (reverse regression). Both fail
// because the reading is correlated with what the balance leaves over. A rigid link's torque is
// m g l cos(q + q0) + I dv/dt: it needs neither reading nor friction. The reading's least-squares
// projection on these columns and on the balance's own is free of both errors; it replaces the
// reading as the gain's column (Theil 1953, Basmann 1957).

#include <Eigen/Core>
#include <vector>

namespace jointid::identify {

/// Which columns explain the reading. Those of a rigid link follow: cosine, sine and duration of
/// each run, then the velocity change of each.
struct Instruments {
  std::vector<Eigen::Index> own;    ///< free coefficients with a constant column, without the gain
  std::vector<std::size_t> shaped;  ///< free shaped terms, each summed for several decays
  std::vector<double> rates;        ///< of those decays, exp(-rate v^2)
  Eigen::Index runs = 1;            ///< recordings with a link of their own; 1: all share one

  /// Columns that belong to the balance itself.
  [[nodiscard]] Eigen::Index inner() const {
    return static_cast<Eigen::Index>(own.size() + shaped.size() * rates.size());
  }
  [[nodiscard]] Eigen::Index size() const { return inner() + kLink * runs; }

  static constexpr Eigen::Index kPosture = 3;  ///< columns of gravity and zero
  static constexpr Eigen::Index kLink = 4;     ///< with the velocity change
};

/// The rates of decays for recordings of that largest speed; none at rest.
std::vector<double> instrument_rates(double fastest);

/// The solved first stage.
struct FirstStage {
  Instruments instruments;
  Eigen::VectorXd weights;  ///< of the instruments; 0: not used, or implied by the others
  /// Whether the velocity change is among the link's columns. It is left out where gravity says
  /// enough: friction that drifts is correlated with it, and torque feedback lets the sensor's
  /// noise into it.
  bool acceleration = false;
  /// F statistic of the link's columns beyond the balance's own. Below 10 the instruments are weak
  /// (Staiger and Stock 1997).
  double strength = 0.0;
  /// Share of the reading's square without its mean that only the link's columns explain.
  double share = 0.0;

  [[nodiscard]] bool weak() const;
};

/// Solves the first stage from the triangle of a QR decomposition of (instruments, reading).
FirstStage solve_first_stage(const Instruments& instruments, const Eigen::MatrixXd& triangle,
                             Eigen::Index windows);

/// R of the QR decomposition, always square.
Eigen::MatrixXd square_triangle(Eigen::MatrixXd rows);
/// The triangle of all rows from those of parts of them; at least one.
Eigen::MatrixXd fold(const std::vector<Eigen::MatrixXd>& triangles);

}  // namespace jointid::identify
