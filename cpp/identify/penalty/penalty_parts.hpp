#pragma once
// A penalty in parts of some thousand samples each. Quantities that are summed over all windows
// once or twice then need no columns of all windows in memory. The parts are distributed over the
// threads.

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/pool.hpp"
#include "identify/penalty/penalty.hpp"

namespace jointid::identify {

/// Known windows, and the recording of each.
struct CutWindows {
  std::vector<Window> windows;
  std::vector<int> recording_of;
};

class PenaltyParts {
 public:
  /// Over known windows. A part ends only where one of `ends` begins; without any, anywhere.
  PenaltyParts(const Penalty::Masked& recordings, const std::vector<std::string>& terms,
               CutWindows windows, const std::vector<std::size_t>& ends, Residual residual,
               double gear_ratio, const std::vector<std::string>& per_recording);
  /// As for `Penalty`. Cumulative windows stay one part.
  PenaltyParts(const Penalty::Masked& recordings, const std::vector<std::string>& terms,
               const WindowOptions& windows, Residual residual, double gear_ratio,
               const std::vector<std::string>& per_recording);

  [[nodiscard]] std::size_t count() const { return first_.size() - 1; }
  [[nodiscard]] Eigen::Index window_count() const {
    return static_cast<Eigen::Index>(windows_.size());
  }
  /// The first window of a part. For the index `count()`, the number of windows.
  [[nodiscard]] std::size_t first(std::size_t part) const { return first_[part]; }
  [[nodiscard]] Eigen::Index parameters() const { return names_; }
  [[nodiscard]] std::int64_t samples() const { return frame_.total_samples(); }
  /// Whether the residuals are not linear in this parameter: a shape, or a gain that divides them.
  [[nodiscard]] bool is_nonlinear(Eigen::Index parameter) const {
    return parameter >= coefficients_ || parameter == divisor_;
  }
  /// The penalty over the windows of one part.
  [[nodiscard]] Penalty part(std::size_t index) const;
  /// Some windows, and the residual of the torque over each at one parameter vector.
  struct Residuals {
    std::span<const Window> windows;
    std::span<const int> recording_of;
    Eigen::VectorXd torque;
    Eigen::VectorXd duration;  ///< usable time [s]
  };
  /// Residuals of the windows of one part. Columns are computed only if the balance needs them.
  [[nodiscard]] Residuals residuals(std::size_t index, const Eigen::VectorXd& theta) const;
  /// The first stage over all windows, if the residual is 'instruments', for
  /// `part(i).project_reading`. `free` are the free parameters.
  /// Existing parts of the caller are used instead of new ones.
  [[nodiscard]] std::optional<FirstStage> first_stage(
      const std::vector<Eigen::Index>& free, const std::vector<std::unique_ptr<Penalty>>& made,
      base::Pool* pool) const;
  [[nodiscard]] const RecordingView& recording(int index) const {
    return recordings_[static_cast<std::size_t>(index)]->recording();
  }

 private:
  void divide(const std::vector<std::size_t>& ends);

  Penalty::Masked recordings_;
  double gear_ratio_;
  std::vector<std::string> per_recording_;
  Penalty frame_;  ///< only the terms, without windows
  std::vector<Window> windows_;
  std::vector<int> recording_of_;
  Eigen::Index names_ = 0;
  Eigen::Index coefficients_ = 0;
  Eigen::Index divisor_ = -1;
  std::vector<std::size_t> first_;  ///< windows first_[i] .. first_[i + 1] - 1 are part i
};

/// Calls work(i) for each i < count, on the pool's workers, or one after the other without a pool.
void for_each(std::size_t count, base::Pool* pool, const std::function<void(std::size_t)>& work);

}  // namespace jointid::identify
