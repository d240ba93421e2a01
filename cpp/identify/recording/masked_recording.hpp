#pragma once
// A recording with its mask and the statistics that every cut into windows needs, computed once.

#include <cstdint>
#include <map>
#include <mutex>
#include <vector>

#include "base/cancel.hpp"
#include "identify/recording/mask.hpp"

namespace jointid::identify {

class MaskedRecording {
 public:
  /// The owner of the signals must outlive this.
  MaskedRecording(const RecordingView& recording, UsableIntervals usable,
                  const base::Cancel* cancel = nullptr);
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
  /// Median time between samples [s].
  [[nodiscard]] double period() const { return period_; }
  /// Mean square of the velocity's noise in a difference of two samples.
  [[nodiscard]] double noise() const { return noise_; }
  /// Structure function D(lag) = mean (v[k+lag] - v[k])^2 over what is usable throughout; 0 if
  /// nothing is. Remembered.
  [[nodiscard]] double structure(Eigen::Index lag, const base::Cancel* cancel = nullptr) const;

 private:
  struct Run {  ///< samples begin .. end, all intervals between them usable
    Eigen::Index begin;
    Eigen::Index end;
  };

  RecordingView recording_;
  UsableIntervals mask_;
  std::int64_t usable_count_ = 0;
  std::vector<Run> runs_;
  double period_ = 0.0;
  double noise_ = 0.0;
  mutable std::mutex mutex_;
  mutable std::map<Eigen::Index, double> structure_;
};

}  // namespace jointid::identify
