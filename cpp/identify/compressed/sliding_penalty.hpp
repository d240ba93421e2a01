#pragma once
// The penalty over the last seconds of a continuing motion. Stretches of samples are digested when
// they arrive and forgotten when they are old. Nothing is summed twice.

#include <Eigen/Core>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "identify/compressed/compressed_penalty.hpp"
#include "identify/compressed/compression.hpp"
#include "identify/penalty/penalty.hpp"
#include "search/domain.hpp"

namespace jointid::identify {

class SlidingPenalty {
 public:
  /// `scale` is the scale of the whole motion. `speed` is the largest speed that the shapes' table
  /// must serve [rad/s or m/s].
  SlidingPenalty(std::vector<std::string> terms, Residual residual, double gear_ratio,
                 double window_duration, bool mask_standstill, const MotionScale& scale,
                 search::Domain domain, double speed);

  /// Digests the sample intervals begin .. end - 1. The other samples in `samples` only show
  /// whether the joint stood still at the ends. Throws std::invalid_argument if the stretch does
  /// not follow the last one, or is faster than the table serves.
  void append(const RecordingView& samples, Eigen::Index begin, Eigen::Index end);
  /// Drops the stretches that end no later than this time [s].
  void forget(double time);

  [[nodiscard]] std::size_t stretches() const { return stretches_.size(); }
  [[nodiscard]] std::int64_t window_count() const;
  /// Start of the first stretch and end of the last one [s]; both 0 without stretches.
  [[nodiscard]] double begin() const;
  [[nodiscard]] double end() const;

  /// The compressed penalty over all stretches; nothing while there is no window with motion.
  [[nodiscard]] std::optional<CompressedPenalty> compressed() const;
  /// Window residuals and their derivatives, by the direct sum.
  void residuals(const Eigen::VectorXd& theta, Eigen::VectorXd& residual,
                 Eigen::MatrixXd& jacobian) const;
  /// Window integrals of a constant column, and the windows' integrated time [s].
  [[nodiscard]] double total(Eigen::Index coefficient) const;
  [[nodiscard]] double usable_duration() const;

 private:
  struct Piece {
    Penalty penalty;
    Digest digest;
    double begin;
    double end;
  };

  std::vector<std::string> terms_;
  Residual residual_;
  double gear_ratio_;
  double window_duration_;
  bool mask_standstill_;
  MotionScale scale_;
  search::Domain domain_;
  double speed_;
  std::optional<ShapeNodes> nodes_;  ///< when the terms are known to have a shape
  std::deque<Piece> stretches_;
};

}  // namespace jointid::identify
