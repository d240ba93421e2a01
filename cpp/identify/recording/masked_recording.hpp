#pragma once
// A recording with its mask and the statistics that every division into windows needs, computed
// once.

#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "base/cancel.hpp"
#include "identify/recording/mask.hpp"

namespace jointid::identify {

/// From this x on, exp(-rate x) is negligible against the 1 of samples at rest: exp(-50) = 2e-22.
inline double vanishing_at(double rate) {
  return rate > 0.0 ? 50.0 / rate : HUGE_VAL;
}

/// Decays exp(-rate v^2) at every sample; zero where the slowest decay has vanished.
struct SampleDecays {
  std::vector<double> rates;
  Eigen::VectorXd speed;   ///< |v|
  Eigen::VectorXd values;  ///< decays of one sample are adjacent
};

class MaskedRecording {
 public:
  /// The owner of the signals must outlive this.
  MaskedRecording(const RecordingView& recording, UsableIntervals usable);
  MaskedRecording(const MaskedRecording&) = delete;
  MaskedRecording& operator=(const MaskedRecording&) = delete;

  [[nodiscard]] const RecordingView& recording() const { return recording_; }
  /// One flag per sample interval.
  [[nodiscard]] const std::vector<std::uint8_t>& usable() const { return mask_.usable; }
  [[nodiscard]] std::int64_t usable_count() const { return usable_count_; }
  [[nodiscard]] std::int64_t unusable_count() const {
    return static_cast<std::int64_t>(mask_.usable.size()) - usable_count_;
  }
  [[nodiscard]] std::int64_t standing() const { return mask_.standing; }
  /// Median time between samples [s]. Stored after the first call.
  double period(const base::Cancel* cancel = nullptr) const;
  /// Mean square of the velocity's noise in a difference of two samples.
  double noise(const base::Cancel* cancel = nullptr) const;
  /// Structure function D(lag) = mean (v[k+lag] - v[k])^2 over stretches that are usable
  /// throughout; 0 if there is none. Stored after the first call.
  [[nodiscard]] double structure(Eigen::Index lag, const base::Cancel* cancel = nullptr) const;
  /// The decays of these rates. They are stored, because windows of several lengths sum the same
  /// decays. Null if the recording is so long that they would fill the memory.
  [[nodiscard]] std::shared_ptr<const SampleDecays> decays(const std::vector<double>& rates) const;

 private:
  struct Run {  ///< samples begin .. end; all intervals between them are usable
    Eigen::Index begin;
    Eigen::Index end;
  };

  RecordingView recording_;
  UsableIntervals mask_;
  std::int64_t usable_count_ = 0;
  std::vector<Run> runs_;
  mutable std::mutex mutex_;
  mutable double period_ = 0.0;
  mutable std::map<Eigen::Index, double> structure_;
  mutable std::shared_ptr<const SampleDecays> decays_;
};

}  // namespace jointid::identify
