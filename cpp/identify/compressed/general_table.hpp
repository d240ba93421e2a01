#pragma once
// The functions of a ShapeTable for the general decay: the decay at some hundred speeds, times a
// matrix. It serves wide bounds, and its derivatives are exact.

#include <array>
#include <cstddef>
#include <vector>

#include "identify/compressed/speed_moments.hpp"

namespace jointid::identify {

class GeneralTable {
 public:
  GeneralTable(const GeneralRange& range, const SpeedPieces& pieces, const SpeedMoments& moments,
               std::size_t shaped);

  [[nodiscard]] double lower(std::size_t shape) const { return lower_[shape]; }
  [[nodiscard]] double upper(std::size_t shape) const { return upper_[shape]; }

  /// All functions at a velocity and an exponent: projections of each shaped column, then inner
  /// products of the remainders.
  void values(const double* shapes, double* result) const;

  /// Rows of the columns.
  [[nodiscard]] Eigen::Index rows() const { return static_cast<Eigen::Index>(rows_ + rank_); }
  /// Projections of each shaped column, and below them what remains in as many coordinates as it
  /// takes: the columns' inner products, and those of their derivatives, are the direct ones.
  [[nodiscard]] Eigen::MatrixXd columns(const double* shapes) const;
  /// Their derivatives by the velocity (0) or the exponent (1).
  [[nodiscard]] Eigen::MatrixXd slopes(const double* shapes, int which) const;

 private:
  /// Coefficients (moments x shapes) of the decays of some shapes.
  [[nodiscard]] Eigen::MatrixXd decays_of(const Probes& shapes) const;
  /// Rows R, so that R c has the inner products of what remains of a column with the coefficients
  /// c, for every shape of the domain.
  [[nodiscard]] Eigen::MatrixXd remainders(const Eigen::MatrixXd& products) const;
  /// Projections and remainders of each shaped column, for the decay or a derivative of it.
  void combine(const double* decay, double* result) const;
  [[nodiscard]] Eigen::MatrixXd combined(const double* decay) const;

  std::array<double, 2> lower_;
  std::array<double, 2> upper_;
  std::size_t shaped_;
  std::size_t rows_;        ///< of projections
  std::size_t rank_ = 0;    ///< of remainders
  std::size_t padded_ = 0;  ///< rows and rank, rounded up to whole vectors
  SpeedPieces pieces_;
  std::vector<double> points_;  ///< log speeds
  std::vector<double> matrix_;  ///< shaped column, point, projections and remainders
};

}  // namespace jointid::identify
