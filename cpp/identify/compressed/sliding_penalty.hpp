#pragma once
// The penalty over the last seconds of a motion that goes on: stretches of samples are digested as
// they arrive and forgotten as they age, and nothing is summed twice.

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
  /// `scale` is that of the whole motion; `speed` is the largest that the shapes' table must serve
  /// [rad/s or m/s].
  SlidingPenalty(std::vector<std::string> terms, Residual residual, double gear_ratio,
                 double window_duration, bool mask_standstill, const MotionScale& scale,
                 search::Domain domain, double speed);

  /// Digests the sample intervals begin .. end - 1. What lies beyond them in `samples` only tells
  /// whether the joint stood still at their ends. Throws std::invalid_argument when the stretch
  /// does not follow the last one, or is faster than the table serves.
  void append(const RecordingView& samples, Eigen::Index begin, Eigen::Index end);
  /// Drops the stretches that end no later than this time [s].
  void forget(double time);

  [[nodiscard]] std::size_t stretches() const { return stretches_.size(); }
  [[nodiscard]] std::int64_t window_count() const;
  /// From the first stretch's begin to the last one's end [s]; both 0 without stretches.
  [[nodiscard]] double begin() const;
  [[nodiscard]] double end() const;

  /// The penalty over all stretches, compressed; nothing while there is no window with motion.
  [[nodiscard]] std::optional<CompressedPenalty> compressed() const;
  /// Its window residuals and their derivatives, by the direct sum.
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
  std::optional<ShapeNodes> nodes_;  ///< once the terms are known to have a shape
  std::deque<Piece> stretches_;
};

}  // namespace jointid::identify
